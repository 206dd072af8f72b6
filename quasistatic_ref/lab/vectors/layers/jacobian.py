"""Layer `jacobian`: J of Eqs. (2)-(3) at given contact points of a mechanism."""

from typing import Any, Final

from flint import fmpq

from quasistatic_ref.lab.vectors.exact.algebra import dot
from quasistatic_ref.lab.vectors.exact.mechanism import Mechanism, mechanism, poses
from quasistatic_ref.lab.vectors.exact.precision import numbers, rounded
from quasistatic_ref.lab.vectors.expected import Expected, Json, Tolerance

EPS: Final = 2.0**-52
PER_BODY: Final = 8.0
"""Roundings that one joint of a chain adds: its rotation has 3 products an entry, its origin too,
and an axis may be turned by 2 units; the package's own answers stay below 2."""


def expected(case_input: Json) -> Expected:
    """J, shape (n_c, 4, n_v): rows 0-2 nu_beta - nu_alpha, row 3 n'(omega_beta - omega_alpha)."""
    tree = mechanism(case_input["mechanism"])
    output, digits = rounded(lambda: {"J": _jacobians(tree, case_input)})
    return Expected(output, digits, tolerance={"J": _tolerance(tree, case_input)})


def _jacobians(tree: Mechanism, case: dict[str, Any]) -> list[list[list[Any]]]:
    at = poses(tree, case["q"])
    J = []
    for contact in case["contacts"]:
        n, rows = numbers(contact["n"]), [[fmpq(0)] * tree.n_v for _ in range(4)]
        for side, factor in (("beta", 1), ("alpha", -1)):
            body, point = tree.number(contact[f"{side}_body"]), numbers(contact[side])
            for v, (nu, omega) in at.point_columns(body, point).items():
                for i, x in enumerate([*nu, dot(n, omega)]):
                    rows[i][v] += factor * x
        J.append(rows)
    return J


def _tolerance(tree: Mechanism, case: dict[str, Any]) -> Tolerance:
    """Levers are differences of world coordinates: each keeps the rounding of the largest."""
    origins, _ = rounded(lambda: poses(tree, case["q"]).t)
    points = [contact[side] for contact in case["contacts"] for side in ("alpha", "beta")]
    size = max([1.0, *(abs(x) for point in origins + points for x in point)])
    absolute = EPS * PER_BODY * (2 + _depth(tree)) * size
    return Tolerance(
        absolute,
        f"{PER_BODY:g} units of rounding a joint, {_depth(tree)} joints in a chain, world "
        f"coordinates (or unit vectors) up to {size:.3g}",
    )


def _depth(tree: Mechanism) -> int:
    depths: list[int] = []
    for body in tree.bodies:
        depths.append(1 + (0 if body.parent is None else depths[body.parent]))
    return max(depths, default=0)


def own(case_input: Json) -> Json:
    """The package's J."""
    import numpy as np

    from quasistatic_ref.contact.jacobian import contact_jacobian
    from quasistatic_ref.lab.vectors.own.system import own_system

    contacts = case_input["contacts"]
    if not contacts:
        return {"J": []}
    mine = own_system(case_input["mechanism"])
    J = contact_jacobian(
        mine.system.kinematics(mine.model_q(case_input["q"])),
        np.array([mine.links[contact["alpha_body"]] for contact in contacts]),
        np.array([mine.links[contact["beta_body"]] for contact in contacts]),
        *(np.array([contact[key] for contact in contacts]) for key in ("alpha", "beta", "n")),
    )
    return {"J": (J[:, :, mine.v] + 0.0).tolist()}
