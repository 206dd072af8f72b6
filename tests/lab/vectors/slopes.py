"""Derivatives of the plain program's step by differences in float64: no code of the package."""

from unittest import mock

import numpy as np

from quasistatic_ref.lab.program import step
from quasistatic_ref.lab.program.integration import integrate, way
from quasistatic_ref.lab.program.mechanism import kinematics, slices

EPS = 1e-5
"""Rounding of q+, 1e-16, is 1e-11 of a quotient, and eps^4 next to nothing."""
WEIGHTS = ((1, 8 / 12), (2, -1 / 12))
"""Of the differences over one and over two eps, so that terms of eps^3 cancel."""


def minus(case, q, other):
    """The difference q (-) other."""
    return way(case["mechanism"], other, q)


def q_next(case):
    """Configuration after the program's step, with a further generalised force in ``tau``."""
    right = step.loads

    def loaded(case, at):
        M, tau = right(case, at)
        return M, tau + case.get("tau", 0.0)

    with mock.patch.object(step, "loads", loaded):
        return np.array(step.step(case)["q_next"])


def held(case):
    """The case with its wrenches as the generalised force that they are at q."""
    at = kinematics(case["mechanism"], np.array(case["q"]))
    tau = step.loads({**case, "gravity": np.zeros(3)}, at)[1]
    return {**case, "wrenches": [], "tau": tau}


def coordinates(case):
    """Count of delta_q's entries."""
    return slices(case["mechanism"])[2]


def by_q(case, j, by):
    """The case with q moved along one coordinate."""
    delta_q = by * np.eye(coordinates(case))[j]
    return {**case, "q": integrate({**case, "delta_q": delta_q})["q"]}


def rate(function):
    """Derivative of a function of one number at 0."""
    return sum(
        weight * (function(times * EPS) - function(-times * EPS)) / EPS for times, weight in WEIGHTS
    )


def slopes(case):
    """The derivative of the next configuration by q, shape (n_v, n_v)."""
    case = held(case)
    start = q_next(case)
    columns = range(coordinates(case))
    return np.column_stack(
        [rate(lambda by, j=j: minus(case, q_next(by_q(case, j, by)), start)) for j in columns]
    )
