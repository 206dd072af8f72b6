"""Layer `jacobian`: J of Eqs. (2)-(3) at given contact points of a mechanism."""

import numpy as np

from quasistatic_ref.lab.program import mechanism as program
from quasistatic_ref.lab.vectors.exact.entered import exact_case
from quasistatic_ref.lab.vectors.exact.precision import rounded_results
from quasistatic_ref.lab.vectors.expected import Expected, Json, Tolerance

EPS = 2.0**-52
PER_BODY = 8.0
"""Roundings that one joint of a chain adds: its rotation has 3 products an entry, its origin too,
and an axis may be turned by 2 units; the package's own answers stay below 2."""


def expected(case_input: Json) -> Expected:
    """J, shape (n_c, 4, n_v): rows 0-2 nu_beta - nu_alpha, row 3 n'(omega_beta - omega_alpha)."""
    case = exact_case(case_input)
    output, digits = rounded_results(lambda: program.jacobian(case))
    return Expected(output, digits, tolerance={"J": _tolerance(case, case_input["contacts"])})


def _tolerance(case: Json, contacts: Json) -> Tolerance:
    """Levers are differences of world coordinates: each keeps the rounding of the largest."""
    bodies = case["mechanism"]["bodies"]
    depth = {None: 0}
    for body in bodies:
        depth[body["name"]] = depth[body["parent"]] + 1
    joints = max(depth.values())
    at, _ = rounded_results(lambda: program.kinematics(case["mechanism"], np.array(case["q"])))
    points = [at[body["name"]][1] for body in bodies]
    points += [contact[side] for contact in contacts for side in ("alpha", "beta")]
    size = max([1.0, *(abs(x) for point in points for x in point)])
    absolute = EPS * PER_BODY * (2 + joints) * size
    return Tolerance(
        absolute,
        f"{PER_BODY:g} units of rounding a joint, {joints} joints in a chain, world "
        f"coordinates (or unit vectors) up to {size:.3g}",
    )


def own(case_input: Json) -> Json:
    """The package's J."""
    from quasistatic_ref.lab.scenes.link_jacobian import contact_jacobian
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
