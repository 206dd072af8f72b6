"""Derivatives of the plain program's step by differences in float64: no code of the package."""

import copy
from unittest import mock

import numpy as np

from quasistatic_ref.lab.program import step
from quasistatic_ref.lab.program.integration import moved, way
from quasistatic_ref.lab.program.mechanism import kinematics, slices

EPS = 1e-5
"""Rounding of q+, 1e-16, is 1e-11 of a quotient, and eps^4 next to nothing."""
WEIGHTS = ((1, 8 / 12), (2, -1 / 12))
"""Of the differences over one and over two eps, so that terms of eps^3 cancel."""


def parts(case):
    """Body, entries of q and entries of delta_q of each joint that has any."""
    at, _, n_v = slices(case["mechanism"])
    bodies = [body for body in case["mechanism"]["bodies"] if body["name"] in at]
    found = [(body, *at[body["name"]]) for body in bodies]
    return [one for one in found if one[2].stop > one[2].start], n_v


def plus(case, q, way):
    """The configuration q (+) way of the first joints, as many as q has entries of."""
    after = np.array(q, dtype=float)
    for body, entries, columns in parts(case)[0]:
        if entries.stop <= len(after):
            after[entries] = moved(body, after[entries], way[columns])
    return after


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


def by_q(case, j, by):
    way = np.zeros(parts(case)[1])
    way[j] = by
    return {**case, "q": plus(case, case["q"], way).tolist()}


def by_force(case, j, by):
    return {**case, "tau": case["tau"] + by * np.eye(len(case["tau"]))[j]}


def by_target(case, j, by):
    way = np.zeros(parts(case)[1])
    way[j] = by
    return {**case, "q_bar_a": plus(case, case["q_bar_a"], way).tolist()}


def by_pair(name):
    def moved(case, j, by):
        case = copy.deepcopy(case)
        case["pairs"][j][name] += by
        return case

    return moved


def by_time(case, j, by):
    return {**case, "h": case["h"] + by}


def by_mass(case, j, by):
    case = copy.deepcopy(case)
    [body for body in case["mechanism"]["bodies"] if "mass" in body][j]["mass"] += by
    return case


def by_stiffness(case, j, by):
    case = copy.deepcopy(case)
    case["K_q"][j][j] += by
    return case


MOVES = {
    "dq_dq": by_q,
    "dq_dq_bar_a": by_target,
    "dq_dtau": by_force,
    "dq_dmu_v": by_pair("mu_v"),
    "dq_dmu_omega": by_pair("mu_omega"),
    "dq_dK_q": by_stiffness,
    "dq_dh": by_time,
    "dq_dm": by_mass,
}
SCALES = {"dq_dtau": 1e2, "dq_dmu_omega": 1e-1, "dq_dh": 1e-1, "dq_dK_q": 1e2}
"""Of eps: what changes is small, or large, itself."""


def rate(function, step=EPS):
    """Derivative of a function of one number at 0."""
    return sum(
        weight * (function(times * step) - function(-times * step)) / step
        for times, weight in WEIGHTS
    )


def slope(case, field, j):
    """Column j of a derivative."""
    case = held(case)
    start = q_next(case)
    step = EPS * SCALES.get(field, 1.0)
    return rate(lambda by: minus(case, q_next(MOVES[field](case, j, by)), start), step)


def slopes(case, field="dq_dq", columns=None):
    """A derivative, shape (n_v, columns)."""
    count = parts(case)[1] if columns is None else columns
    return np.column_stack([slope(case, field, j) for j in range(count)])
