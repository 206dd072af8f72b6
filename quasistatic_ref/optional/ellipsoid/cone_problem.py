"""The CVXPY problem of a step in whatever cone it says."""

import cvxpy as cp
import numpy as np

from quasistatic_ref.step.cones import ELLIPSOID, PYRAMID
from quasistatic_ref.step.data import Array, StepData
from quasistatic_ref.step.extension import Own, none
from quasistatic_ref.step.friction import cone_function
from quasistatic_ref.step.problem import StepProblem


def cone_problem(like: StepData, constraints: Own = none, costs: Own = none) -> StepProblem:
    """The problem of steps like this one, in their cone.

    Parameters
    ----------
    like : StepData
    constraints, costs : callable, optional
        As of :class:`~quasistatic_ref.step.problem.StepProblem`.
    """
    if like.cone == ELLIPSOID:
        return EllipsoidProblem(like, constraints, costs)
    friction = None if like.cone == PYRAMID else cone_function(like.cone)
    return StepProblem(like, friction, constraints, costs)


class EllipsoidProblem(StepProblem):
    """A step in the ellipsoid: gap >= ||(slip_1, slip_2, spin)|| in place of rows.

    Parameters
    ----------
    like : StepData
    constraints, costs : callable, optional
        As of :class:`~quasistatic_ref.step.problem.StepProblem`.
    """

    def __init__(self, like: StepData, constraints: Own = none, costs: Own = none) -> None:
        def with_cone(problem: StepProblem) -> list[cp.Constraint]:
            gap, *slips = problem.motion
            self.cone = [cp.SOC(gap, cp.vstack(slips))] if like.contacts.n_c else []
            return [*self.cone, *constraints(problem)]

        super().__init__(like, lambda *motion: (), with_cone, costs)

    def dual(self) -> Array:
        """Impulses (n, d1, d2, spin) of the last solve, the user's own rows last; shape (m,)."""
        own = [row.dual_value for row in self.extra]
        for cone in self.cone:
            f_n, scaled = cone.dual_value
            own.insert(0, np.column_stack([f_n, self.like.contacts.mu * scaled.T]).ravel())
        return np.concatenate([np.zeros(0), *own])
