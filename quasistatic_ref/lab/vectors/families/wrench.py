"""Inputs of the layer `wrench`: multipliers in every cone, on bodies that share contacts."""

from collections.abc import Iterator
from typing import Any

import numpy as np

from quasistatic_ref.lab.scenes.at_random import random_contacts
from quasistatic_ref.lab.vectors.expected import Json
from quasistatic_ref.lab.vectors.families.by_hand import Case
from quasistatic_ref.lab.vectors.families.steps import contact_entries
from quasistatic_ref.lab.vectors.layers.rows import by_contact
from quasistatic_ref.step.cones import cone as cone_of
from quasistatic_ref.step.data import Array, Contacts

CONES = ("pyramid", "product", "facets-8", "frictionless", "ellipsoid")
KEYS = ("n", "d1", "d2", "mu_v", "mu_omega", "rows")
PLACE = ("alpha_body", "beta_body", "alpha", "beta")


def wrench_cases() -> Iterator[Case]:
    """Id, provenance and input of each case."""
    rng = np.random.default_rng(61)
    for cone in CONES:
        for rows in (4, 6):
            why = f"random multipliers with rows = {rows} in the cone {cone}"
            yield f"wrench/cone/{cone}_{rows}", why, random_loads(rng, 3, cone, rows=rows)
    for i in range(14):
        why = "random multipliers of random contacts between three bodies and the world"
        yield f"wrench/random/{i}", why, random_loads(rng, int(rng.integers(1, 9)), "pyramid")
    for k, name in enumerate(("+d1", "+d2", "-d1", "-d2", "+spin", "-spin")):
        case = random_loads(rng, 1, "pyramid", rows=6)
        case["contacts"][0]["lam"] = np.eye(6)[k].tolist()
        yield f"wrench/single/{k}", f"1 N s on the row {name} alone", case
    for name, fixed, why in (
        ("mu_zero", {"mu_v": 0.0, "mu_omega": 0.0, "rows": 6}, "no friction: f_n alone"),
        ("unused_mu_omega", {"mu_omega": 0.5, "rows": 4}, "rows = 4: no torque about n"),
    ):
        yield f"wrench/corner/{name}", why, random_loads(rng, 2, "pyramid", **fixed)
    opposite = random_loads(rng, 1, "pyramid", rows=6)
    opposite["contacts"][0]["lam"] = [0.5, 0.25, 0.5, 0.25, 0.125, 0.125]
    why = "opposite rows cancel: no tangential force, no torque, f_n alone"
    yield "wrench/corner/cancelling", why, opposite
    same = random_loads(rng, 2, "pyramid")
    for contact in same["contacts"]:
        contact |= {"alpha_body": "a", "beta_body": "b"}
    yield "wrench/corner/action_and_reaction", "both contacts between the same two bodies", same
    long = random_loads(rng, 2, "pyramid") | {"h": 0.5}
    yield "wrench/corner/long_step", "h = 0.5 s: lam is not the force", long
    nothing: Json = {"h": 0.01, "cone": "pyramid", "contacts": [], "bodies": {}}
    yield "wrench/corner/no_contacts", "no contacts, no bodies", nothing
    idle: Json = nothing | {"bodies": {"a": {"point": [0.0, 0.0, 1.0]}}}
    yield "wrench/corner/untouched", "a body that nothing touches: zero", idle


def wrench_input(at: Contacts, cone: str, h: float, lam: Array, points: Json, bodies: Json) -> Json:
    """The input of a case.

    Parameters
    ----------
    at : Contacts
    cone : str
    h : float
        [s].
    lam : ndarray, shape (m,)
        Contact-major [N s].
    points : list of dict
        The fields of PLACE, for each contact.
    bodies : dict
        Point of each body about which torques are taken.
    """
    entries = contact_entries(at, KEYS)
    parts = by_contact(lam.tolist(), cone, entries)
    for entry, point, part in zip(entries, points, parts, strict=True):
        entry |= {**point, "lam": part}
    return {"h": h, "cone": cone, "contacts": entries, "bodies": bodies}


def random_loads(rng: np.random.Generator, n_c: int, cone: str, **fixed: Any) -> Json:
    """The input with multipliers at random, on contacts between three bodies and the world."""
    at = random_contacts(rng, n_c, 1, **fixed)
    names = [None, "a", "b", "c"]
    points = []
    for n, phi in zip(at.n, at.phi, strict=True):
        one, two = rng.choice(4, 2, replace=False)
        alpha = 0.2 * rng.standard_normal(3)
        place = (names[one], names[two], alpha.tolist(), (alpha + phi * n).tolist())
        points.append(dict(zip(PLACE, place, strict=True)))
    touched = {point[body] for point in points for body in PLACE[:2]} - {None}
    bodies = {body: {"point": rng.uniform(-1, 1, 3).tolist()} for body in sorted(touched)}
    count = int(cone_of(cone).counts(at.rows).sum())
    lam = rng.random(count) * (rng.random(count) < 0.6)
    if cone == "ellipsoid":
        lam = lam.reshape(-1, 4) * [4, 0.1, -0.1, 0.001]
    return wrench_input(at, cone, 0.01, lam.ravel() + 0.0, points, bodies)
