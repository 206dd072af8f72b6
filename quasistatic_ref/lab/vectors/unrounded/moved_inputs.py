"""Inputs of a step that are moved along one of its coordinates or parameters, without rounding."""

import copy
from collections.abc import Sequence

import numpy as np
from flint import fmpq

from quasistatic_ref.lab.program.integration import joint_parts, moved
from quasistatic_ref.lab.vectors.exact.precision import Real, Vector, number, vector
from quasistatic_ref.lab.vectors.expected import Json
from quasistatic_ref.lab.vectors.unrounded.grid import on_grid, working_precision
from quasistatic_ref.lab.vectors.unrounded.world import world


def along(mechanism: Json, q: Sequence[Real], way: Vector) -> Vector:
    """Configuration q (+) way, on the grid, of all joints or of the actuated ones."""
    with working_precision():
        at = np.array(q)
        found = joint_parts(mechanism, lambda body, i, k: moved(body, at[i], way[k]), len(at))
        return on_grid(found)


def with_q(way: Vector, case: Json, by: fmpq) -> Json:
    """The case at q (+) by times way."""
    return {**case, "q": along(case["mechanism"], case["q"], by * way)}


def with_target(way: Vector, case: Json, by: fmpq) -> Json:
    """The same of q_bar_a, with one number for each actuated coordinate."""
    return {**case, "q_bar_a": along(case["mechanism"], case["q_bar_a"], by * way)}


def with_force(way: Vector, case: Json, by: fmpq) -> Json:
    """The case with an additional generalised force, by times way [N, N m]."""
    more = by * way
    return {**case, "tau": case["tau"] + more if "tau" in case else more}


def with_held_wrenches(case: Json) -> Json:
    """The case with its wrenches as the generalised force ``tau`` that they are at its q."""
    at = world({**case, "gravity": [0.0, 0.0, 0.0]})
    tau = on_grid(at.loads[1])
    return {**at.case, "gravity": list(vector(case["gravity"])), "wrenches": [], "tau": tau}


def with_number(place: tuple[str | int, ...], case: Json, by: Real) -> Json:
    """The case with another number in one place: a coefficient, K_q[j][j], h or a mass."""
    key, *rest = place
    moved = copy.copy(case)
    moved[key] = with_number(tuple(rest), case[key], by) if rest else number(case[key]) + by
    return moved
