"""Layer 9 to some six digits: dq+/dq by differences of whole steps.

Where q+ has a kink these numbers say nothing, and nothing here sees it.
"""

import numpy as np

from .integration import integrate, way
from .mechanism import kinematics, slices
from .rotation import NONE
from .step import contacts_of, loads, step_at

EPS = 1e-5
"""Rounding of q+, 1e-16, is 1e-11 of a quotient; its error is EPS^2 times a third derivative."""


def case_with_tau(case):
    """The case, its wrenches replaced by their generalised force at q."""
    at = kinematics(case["mechanism"], np.array(case["q"]))
    _, tau = loads({**case, "gravity": NONE}, at)
    return {**case, "wrenches": [], "tau": tau}


def derivative(case):
    """Layer 9: the derivative of the next configuration by q alone."""
    case = case_with_tau(case)
    mechanism = case["mechanism"]
    q = np.array(case["q"])
    before = kinematics(mechanism, q)
    contacts = contacts_of(case, before)
    start = step_at(case, before, contacts)

    def end_change(shift):
        """The change of q+ that a change of q makes."""
        q = integrate({**case, "delta_q": shift})["q"]
        at = kinematics(mechanism, q)
        case_nearby = {**case, "q": q}
        contacts_there = contacts_of(case_nearby, at)
        after = step_at(case_nearby, at, contacts_there)
        return way(mechanism, start["q_next"], after["q_next"])

    steps = EPS * np.eye(slices(mechanism)[2])
    columns = [(end_change(shift) - end_change(-shift)) / (2 * EPS) for shift in steps]
    return {"differentiable": True, "dq_dq": np.column_stack(columns)}
