"""The CVXPY problem of a step in the ellipsoid."""

import cvxpy as cp
import numpy as np

from quasistatic_ref.solve.cvxpy_problem import CvxpyProblem
from quasistatic_ref.step.data import Array


class EllipsoidProblem(CvxpyProblem):
    """A step in the ellipsoid: gap >= ||(slip_1, slip_2, spin)|| in place of rows.

    Parameters
    ----------
    like, constraints, costs
        As of :class:`~quasistatic_ref.solve.cvxpy_problem.CvxpyProblem`.
    """

    def rows_of_cone(self) -> list[cp.Constraint]:
        """One second-order cone for each contact, in one constraint."""
        gap, *slips = self.motion
        return [cp.SOC(gap, cp.vstack(slips))] if self.like.contacts.n_c else []

    def dual(self) -> Array:
        """Impulses (n, d1, d2, spin) of the last solve, the user's own rows last; shape (m,)."""
        own = [row.dual_value for row in self.extra]
        for cone in self.contact_rows:
            f_n, scaled = cone.dual_value
            own.insert(0, np.column_stack([f_n, self.like.contacts.mu * scaled.T]).ravel())
        return np.concatenate([np.zeros(0), *own])
