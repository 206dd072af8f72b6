"""The page's problem of any step: its cone, rows of a user's own, multipliers in the order of A."""

import cvxpy as cp
import numpy as np

from quasistatic_ref.solve.scaled import out_of_range
from quasistatic_ref.solve.units import Units
from quasistatic_ref.step.cones import PYRAMID, cone
from quasistatic_ref.step.data import Array, StepData
from quasistatic_ref.step.extension import Own, none
from quasistatic_ref.step.friction import frame_jacobian
from quasistatic_ref.step.problem import StepProblem


class CvxpyProblem(StepProblem):
    """The paper's page, with what a step has that is not in the paper.

    Parameters
    ----------
    like : StepData
        A step of the same kind: its h, mu_v, mu_omega, cone and sizes are constants of the problem.
    constraints, costs : callable, optional
        Functions of this problem that return a list of additional constraints, or costs. Where
        a cost replaces the springs, set K_q and tau_k to zero after each :meth:`fill`.

    Attributes
    ----------
    extra : list of cvxpy.Constraint
        The rows of the step's own ``extra``: one constraint, or none.
    """

    def __init__(self, like: StepData, constraints: Own = none, costs: Own = none) -> None:
        super().__init__(like)
        if like.cone != PYRAMID:
            self.contact_rows = cone(like.cone).constraints(self.motion, like.mask)
        A_x = cp.Parameter(like.extra.A.shape, "A_x")
        b_x = cp.Parameter(like.extra.b.shape, "b_x")
        self.parameters |= {"A_x": A_x, "b_x": b_x}
        self.extra = [A_x @ self.delta_q >= b_x] if like.extra.names else []
        objective = self.problem.objective
        for cost in costs(self):
            objective += cp.Minimize(cost)
        self.problem = cp.Problem(objective, [*self.contact_rows, *self.extra, *constraints(self)])

    def check_kind(self) -> None:
        """Refuse nothing: each cone, and rows of a user's own, have their problem here."""

    def fill(self, step: StepData) -> None:
        """Set every parameter from one step.

        Raises
        ------
        StepDataError
            If this is not the step's problem, naming what differs.
        """
        super().fill(step)
        self.parameters["A_x"].value = step.extra.A
        self.parameters["b_x"].value = step.extra.b

    def fill_natural(self, step: StepData, units: Units, phi: Array) -> None:
        """Set every parameter from one step in natural units.

        Parameters
        ----------
        step : StepData
            Of this problem's kind, which is not looked at again; SI units.
        units : Units
        phi : ndarray, shape (n_c,)
            Its signed distances in natural units, perhaps moved nearer [-].

        Raises
        ------
        StepDataError
            If a number leaves the range of float64.
        """
        n_a = step.n_a
        S, ell, rho = units
        J = frame_jacobian(step.contacts, step.contacts.J * (S / ell))
        K_q = step.K_q * np.outer(S[:n_a], S[:n_a])
        values = {
            "K_q": K_q,
            "M_u": step.M_u * np.outer(S[n_a:], S[n_a:]),
            "tau_k": K_q @ (step.delta_q_bar_a / (rho * S[:n_a])),  # Eq. (1)
            "tau_a": step.tau_a * S[:n_a] / rho,
            "tau_u": step.tau_u * S[n_a:] / rho,
            "phi": phi,
            **dict(zip(("J_n", "J_1", "J_2", "J_w"), J, strict=True)),
            "A_x": step.extra.A * (S / ell),
            "b_x": step.extra.b / (rho * ell),
        }
        if not all(np.isfinite(value).all() for value in values.values()):
            raise out_of_range(step)
        for name, value in values.items():
            self.parameters[name].value = value

    def primal(self) -> Array:
        """delta_q of the last solve, shape (n_v,)."""
        return np.concatenate([x.value for x in (self.delta_q_a, self.delta_q_u) if x.size])

    def dual(self) -> Array:
        """Multipliers of the last solve, contact-major, the user's own rows last; shape (m,)."""
        like = self.like
        lam = cone(like.cone).multipliers(self.contact_rows, like.mask, like.contacts.mu)
        return np.concatenate([lam, *(row.dual_value for row in self.extra)])
