"""The program (13) of any step: the page of ``step/problem.py``, with any cone and own rows."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import cvxpy as cp
import numpy as np

from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.step.cones import PYRAMID, cone
from quasistatic_ref.step.data import StepData
from quasistatic_ref.step.problem import StepProblem

Additions = Callable[["CvxpyProblem"], Sequence[cp.Constraint | cp.Expression]]
"""A user's constraints and scalar costs."""


class CvxpyProblem(StepProblem):
    """The paper's program (13), with what a step has that is not in the paper.

    Parameters
    ----------
    template : StepData
        A step of the same kind: its h, mu_v, mu_omega, cone and sizes are constants of the problem.
    additions : callable, optional
        A function of this problem that returns additional constraints and scalar costs. Where a
        cost replaces the springs, set K_q and tau_k to zero after each :meth:`fill`.

    Attributes
    ----------
    extra : list of cvxpy.Constraint
        The rows of the step's own ``extra``: one constraint, or none.
    """

    def __init__(self, template: StepData, additions: Additions | None = None) -> None:
        super().__init__(template)
        if template.cone != PYRAMID:
            self.contact_rows = cone(template.cone).constraints(self.contact_motion, template.mask)
        A_extra = cp.Parameter(template.extra.A.shape, "A_extra")
        b_extra = cp.Parameter(template.extra.b.shape, "b_extra")
        self.parameters |= {"A_extra": A_extra, "b_extra": b_extra}
        self.extra = [A_extra @ self.delta_q >= b_extra] if template.extra.names else []
        objective = self.problem.objective
        if template.extra.cost is not None:
            H_extra = cp.Parameter((template.n_v, template.n_v), "H_extra", PSD=True)
            g_extra = cp.Parameter(template.n_v, "g_extra")
            self.parameters |= {"H_extra": H_extra, "g_extra": g_extra}
            quadratic = cp.quad_form(self.delta_q, H_extra) / 2
            objective += cp.Minimize(quadratic - g_extra @ self.delta_q)
        constraints = [*self.contact_rows, *self.extra]
        for term in [] if additions is None else additions(self):
            if isinstance(term, cp.Constraint):
                constraints.append(term)
            else:
                objective += cp.Minimize(term)
        self.problem = cp.Problem(objective, constraints)

    def check_kind(self) -> None:
        """Accept every cone, rows and costs of a user's own: this problem states them all."""

    def set_parameters(self, step: StepData) -> None:
        """Those of the base, and those of a user's own rows, from a step of its kind."""
        super().set_parameters(step)
        self.parameters["A_extra"].save_value(step.extra.A)
        self.parameters["b_extra"].save_value(step.extra.b)
        if step.extra.cost is not None:
            self.parameters["H_extra"].save_value(step.extra.cost[0])
            self.parameters["g_extra"].save_value(step.extra.cost[1])

    def primal(self) -> Array:
        """delta_q of the last solve, shape (n_v,)."""
        return np.concatenate([x.value for x in (self.delta_q_a, self.delta_q_u) if x.size])

    def dual(self) -> Array:
        """Multipliers of the last solve, contact-major, the user's own rows last; shape (m,)."""
        template = self.template
        lam = cone(template.cone).multipliers(
            self.contact_rows, template.mask, template.contacts.mu
        )
        return np.concatenate([lam, *(row.dual_value for row in self.extra)])
