"""Layer 6: multipliers to contact wrenches, and to the net wrench of each body.

On beta's body the force acts at beta, on alpha's body its reaction at alpha; the torque about n
is free of a point. lam is an impulse: forces are divided by h.
"""

from typing import Any

import numpy as np

from quasistatic_ref.lab.vectors.exact.rational import (
    UNIT,
    Exact,
    digits,
    exact,
    largest,
    rounded,
    tolerance,
)
from quasistatic_ref.lab.vectors.expected import Expected, Json
from quasistatic_ref.lab.vectors.layers.rows import row_coefficients
from quasistatic_ref.step.cones import ELLIPSOID, cone_matrix

ROUNDINGS = 16
"""Of a force: a product, a sum over up to eight rows and a quotient, each counted twice."""


def expected(case_input: Json) -> Expected:
    """The wrench of each contact (f_d1, f_d2, f_n, tau_n), and the net wrench of each body."""
    h, name, contacts = exact(case_input["h"]).item(), case_input["cone"], case_input["contacts"]
    found = [_wrench(contact, name) for contact in contacts]
    wrench = np.array([w for w, _ in found], dtype=object).reshape(-1, 4) / h
    size = np.array([s for _, s in found], dtype=object).reshape(-1, 4) / h
    points = {body: exact(entry["point"]) for body, entry in case_input["bodies"].items()}
    net = {body: _net(body, point, contacts, wrench, _cross) for body, point in points.items()}
    reach = [
        _net(body, abs(point), _absolute(contacts), size, _cross_size)
        for body, point in points.items()
    ]
    rows = max([len(contact["lam"]) for contact in contacts], default=0)
    roundings = (ROUNDINGS + 2 * rows) * UNIT
    return Expected(
        output={
            "wrench": rounded(wrench),
            "net": {body: rounded(value) for body, value in net.items()},
        },
        digits=digits(wrench=wrench)
        | ({"net": {body: digits(v=value)["v"] for body, value in net.items()}} if net else {}),
        tolerance={
            "wrench": tolerance(roundings * largest(size), "rounding of the sum over the rows"),
            "net": tolerance(
                (roundings + 2 * (len(contacts) + 4) * UNIT) * largest(np.array(reach)),
                "rounding of the sum over the contacts, each force times its arm",
            ),
        },
    )


def own(case_input: Json) -> Json:
    """The package's answer, its forces from :mod:`quasistatic_ref.step.friction`."""
    from quasistatic_ref.lab.vectors.layers.rows import contacts_of
    from quasistatic_ref.step.friction import contact_wrenches

    entries = case_input["contacts"]
    if not entries:
        return {"wrench": [], "net": {body: [0.0] * 6 for body in case_input["bodies"]}}
    still = {"phi": 0.0, "J": [[0.0]] * 4}
    contacts = contacts_of([{**still, **entry} for entry in entries])
    lam = np.concatenate([entry["lam"] for entry in entries])
    wrench = contact_wrenches(contacts, lam, case_input["h"], case_input["cone"])
    force = wrench[:, :1] * contacts.d1 + wrench[:, 1:2] * contacts.d2 + wrench[:, 2:3] * contacts.n
    spin = wrench[:, 3:] * contacts.n
    net = {}
    for body, entry in case_input["bodies"].items():
        net[body] = np.zeros(6)
        for side, sign in (("beta", 1.0), ("alpha", -1.0)):
            on = np.array([e[f"{side}_body"] == body for e in entries])
            arm = np.array([e[side] for e in entries]) - entry["point"]
            torque = np.cross(arm, force) + spin
            net[body] += sign * np.concatenate([force[on].sum(axis=0), torque[on].sum(axis=0)])
    return {"wrench": wrench.tolist(), "net": {body: v.tolist() for body, v in net.items()}}


def _wrench(contact: Json, name: str) -> tuple[Exact, Exact]:
    """The wrench (f_d1, f_d2, f_n, tau_n) times h, and the sum of the sizes of its terms."""
    lam = exact(contact["lam"])
    if name == ELLIPSOID:
        return lam[[1, 2, 0, 3]], abs(lam[[1, 2, 0, 3]])
    rows = row_coefficients(contact, name, exact(cone_matrix(name)[:, 1:]))
    sums = [np.insert(c.T @ v, 2, v.sum()) for c, v in ((rows, lam), (abs(rows), abs(lam)))]
    return sums[0], sums[1]


def _net(body: str, point: Exact, contacts: Json, wrench: Exact, cross: Any) -> Exact:
    """Force and torque about a point, world axes, of all contacts on a body."""
    total = exact([0.0] * 6)
    for contact, (f_d1, f_d2, f_n, tau_n) in zip(contacts, wrench, strict=True):
        n, d1, d2 = (exact(contact[key]) for key in ("n", "d1", "d2"))
        force = f_d1 * d1 + f_d2 * d2 + f_n * n
        for side, sign in (("beta", 1), ("alpha", contact.get("reaction", -1))):
            if contact[f"{side}_body"] == body:
                torque = cross(exact(contact[side]), point, force) + tau_n * n
                total = total + sign * np.concatenate([force, torque])
    return total


def _cross(at: Exact, point: Exact, force: Exact) -> Exact:
    (x, y, z), (u, v, w) = at - point, force
    return np.array([y * w - z * v, z * u - x * w, x * v - y * u], dtype=object)


def _cross_size(at: Exact, point: Exact, force: Exact) -> Exact:
    """Sum of the sizes of its terms, of vectors of sizes."""
    (x, y, z), (u, v, w) = at + point, force
    return np.array([y * w + z * v, z * u + x * w, x * v + y * u], dtype=object)


def _absolute(contacts: Json) -> Json:
    keys = ("n", "d1", "d2", "alpha", "beta")
    return [{**c, **{k: [abs(v) for v in c[k]] for k in keys}, "reaction": 1} for c in contacts]
