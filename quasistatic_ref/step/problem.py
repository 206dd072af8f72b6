"""The step as a CVXPY problem that reads like the paper: Eqs. (1), (4), (10), (13).

In this file a bare symbol is a CVXPY object. The problem is compiled once for a given number
of coordinates and contacts; each step only fills in its parameters. ``StepProblem.problem`` is
an ordinary :class:`cvxpy.Problem`: print it, inspect it, extend it.
"""

from __future__ import annotations

import cvxpy as cp
import numpy as np

from quasistatic_ref.errors import StepDataError
from quasistatic_ref.step.data import Array, StepData
from quasistatic_ref.step.friction import friction_rows


class StepProblem:
    """Eq. (13) with everything that changes between steps as a parameter.

    Parameters
    ----------
    like : StepData
        A step of the same kind: its h, its numbers of coordinates and extra rows, and the
        number of rows of each contact are fixed; everything else is a parameter.

    Attributes
    ----------
    problem : cvxpy.Problem
    delta_q_a, delta_q_u : cvxpy.Variable
        Shapes (n_a,) and (n_u,) [m, rad].
    delta_q : cvxpy.Expression
        [delta_q_a; delta_q_u].
    """

    def __init__(self, like: StepData) -> None:
        h, n_a, n_u, n_v = like.h, like.n_a, like.n_u, like.n_v
        n_c, torsional = like.contacts.n_c, np.flatnonzero(like.contacts.rows == 6)
        self.h, self.rows, self.n_a, self.n_u = h, like.contacts.rows, n_a, n_u
        self.mask, self.torsional = like.contacts.mask, torsional

        delta_q_a, delta_q_u = cp.Variable(n_a, "delta_q_a"), cp.Variable(n_u, "delta_q_u")
        delta_q = cp.hstack([delta_q_a, delta_q_u])
        K_q = cp.Parameter((n_a, n_a), "K_q", PSD=True)
        M_u = cp.Parameter((n_u, n_u), "M_u", PSD=True)
        tau_k = cp.Parameter(n_a, "tau_k")  # K_q delta_q_bar_a, Eq. (1)
        tau_a, tau_u = cp.Parameter(n_a, "tau_a"), cp.Parameter(n_u, "tau_u")
        phi = cp.Parameter(n_c, "phi")
        A_v = [cp.Parameter((n_c, n_v), f"A_v{i}") for i in range(4)]
        A_w = [cp.Parameter((len(torsional), n_v), f"A_w{i}") for i in range(2)]
        A_x = cp.Parameter(like.extra.A.shape, "A_x")
        b_x = cp.Parameter(like.extra.b.shape, "b_x")

        # Eqs. (4) and (10): the tangential pyramid (5)-(6), the torsional rows (7), the user's.
        pyramid = [phi + A_v[i] @ delta_q >= 0 for i in range(4)] if n_c else []
        torsion = [phi[torsional] + A_w[i] @ delta_q >= 0 for i in range(2)]
        torsion = torsion if len(torsional) else []
        extra = [A_x @ delta_q >= b_x] if like.extra.names else []

        # Eq. (13); a term without coordinates is left out.
        stiffness = h / 2 * cp.quad_form(delta_q_a, K_q) if n_a else 0
        inertia = 1 / (2 * h) * cp.quad_form(delta_q_u, M_u) if n_u else 0
        work_a = h * (tau_k + tau_a) @ delta_q_a if n_a else 0
        work_u = h * tau_u @ delta_q_u if n_u else 0
        self.problem = cp.Problem(
            cp.Minimize(stiffness + inertia - work_a - work_u), pyramid + torsion + extra
        )

        self.delta_q_a, self.delta_q_u, self.delta_q = delta_q_a, delta_q_u, delta_q
        self.K_q, self.M_u, self.tau_k, self.tau_a, self.tau_u = K_q, M_u, tau_k, tau_a, tau_u
        self.phi, self.A_v, self.A_w, self.A_x, self.b_x = phi, A_v, A_w, A_x, b_x
        self.pyramid, self.torsion, self.extra = pyramid, torsion, extra

    def fits(self, step: StepData) -> bool:
        """Tell whether a step can be filled in without building another problem."""
        return (
            step.h == self.h
            and (step.n_a, step.n_u) == (self.n_a, self.n_u)
            and np.array_equal(step.contacts.rows, self.rows)
            and step.extra.A.shape == self.A_x.shape
        )

    def fill(self, step: StepData) -> None:
        """Set every parameter from one step.

        Raises
        ------
        StepDataError
            If the step is of another kind than the problem was built for.
        """
        if not self.fits(step):
            raise StepDataError("the step has another h, or other numbers of coordinates or rows")
        A = friction_rows(step.contacts)
        _set(self.K_q, step.K_q)
        _set(self.M_u, step.M_u)
        self.tau_k.value = step.K_q @ step.delta_q_bar_a  # Eq. (1)
        self.tau_a.value, self.tau_u.value = step.tau_a, step.tau_u
        self.phi.value = step.contacts.phi
        for i, A_i in enumerate(self.A_v):
            A_i.value = A[:, i]
        for i, A_i in enumerate(self.A_w):
            A_i.value = A[self.torsional, 4 + i]
        self.A_x.value, self.b_x.value = step.extra.A, step.extra.b

    def primal(self) -> Array:
        """delta_q of the last solve, shape (n_v,)."""
        blocks = [x.value for x in (self.delta_q_a, self.delta_q_u) if x.size]
        return np.concatenate([np.zeros(0), *blocks])

    def dual(self) -> Array:
        """Multipliers of the last solve, contact-major, the user's own rows last; shape (m,)."""
        lam = np.zeros((len(self.rows), 6))
        for i, constraint in enumerate(self.pyramid):
            lam[:, i] = constraint.dual_value
        for i, constraint in enumerate(self.torsion):
            lam[self.torsional, 4 + i] = constraint.dual_value
        own = [constraint.dual_value for constraint in self.extra]
        return np.concatenate([lam[self.mask], *own])


def _set(parameter: cp.Parameter, value: Array) -> None:
    """Set a matrix parameter only when it changed: CVXPY checks its definiteness each time."""
    if parameter.value is None or not np.array_equal(parameter.value, value):
        parameter.value = value
