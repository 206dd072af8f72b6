"""Inputs of the layer `rows`: every polyhedral cone, and contacts of every kind."""

from collections.abc import Iterator
from functools import partial

import numpy as np

from quasistatic_ref.lab.scenes.at_random import random_contacts
from quasistatic_ref.lab.scenes.contacts import NUMBERS, repeated
from quasistatic_ref.lab.vectors.expected import Json
from quasistatic_ref.lab.vectors.families.by_hand import Case
from quasistatic_ref.lab.vectors.families.steps import contact_entries
from quasistatic_ref.step.data import Contacts

CONES = ("pyramid", "product", "facets-4", "facets-6", "facets-8", "facets-16", "frictionless")


def rows_cases() -> Iterator[Case]:
    """Id, provenance and input of each case."""
    rng = np.random.default_rng(41)
    for cone in CONES:
        for rows in (4, 6):
            at = random_contacts(rng, 2, 5, rows=rows)
            why = f"two random contacts with rows = {rows} in the cone {cone}"
            yield f"rows/cone/{cone}_{rows}", why, rows_input(at, cone)
    for name, (at, why) in _corners(rng).items():
        yield f"rows/corner/{name}", why, rows_input(at)
    for i in range(12):
        n_c, n_v = int(rng.integers(1, 6)), int(rng.integers(1, 14))
        at = random_contacts(rng, n_c, n_v)
        yield f"rows/random/{i}", "random contacts, 4 and 6 rows mixed", rows_input(at)
    empty: Json = {"cone": "pyramid", "contacts": []}
    yield "rows/corner/no_contacts", "no contacts: no rows", empty


def rows_input(at: Contacts, cone: str = "pyramid") -> Json:
    """The input of a case."""
    return {"cone": cone, "contacts": contact_entries(at, NUMBERS)}


def _corners(rng: np.random.Generator) -> dict[str, tuple[Contacts, str]]:
    contacts = partial(random_contacts, rng)
    one, upright = contacts(1, 6, rows=6), np.eye(3)
    floor = {"n": upright[2], "d1": upright[0], "d2": upright[1]}
    return {
        "mu_v_zero": (
            contacts(2, 6, mu_v=0.0),
            "mu_v = 0: the tangential rows are equal",
        ),
        "mu_omega_zero": (
            contacts(2, 6, mu_omega=0.0, rows=6),
            "mu_omega = 0 in six rows",
        ),
        "both_zero": (contacts(1, 6, mu_v=0.0, mu_omega=0.0, rows=6), "six equal rows"),
        "unused_mu_omega": (contacts(1, 6, mu_omega=0.5, rows=4), "rows = 4: not used"),
        "duplicated": (repeated(one, [0, 0, 0]), "one contact three times"),
        "touching": (contacts(2, 6, phi=0.0), "phi = 0: b is 0.0, not -0.0"),
        "penetrating": (contacts(2, 6, phi=-1e-3), "phi < 0: b is positive"),
        "far": (contacts(1, 6, phi=1e6), "a contact a thousand kilometres away"),
        "huge_mu": (contacts(1, 6, mu_v=1e6, mu_omega=1e3, rows=6), "mu of 1e6"),
        "tiny_mu": (contacts(1, 6, mu_v=1e-12, mu_omega=1e-15, rows=6), "mu of 1e-12"),
        "one_coordinate": (contacts(2, 1), "n_v = 1"),
        "still": (contacts(1, 4, J=0.0), "a contact that nothing moves: rows of zeros"),
        "upright": (contacts(2, 6, **floor), "a floor: n along z, d1 along x"),
        "cancelling": (
            contacts(1, 2, J=np.array([[1.0, 0], [-1, 0], [0, 1], [0, 0]]), mu_v=1.0),
            "entries that are differences of nearly equal terms",
        ),
        "light_and_heavy": (
            contacts(2, 4, J=np.array([1e-9, 1.0, 1e9, 0.0])),
            "columns 1e18 apart, as with centimetres beside gigametres",
        ),
    }
