"""The step as a CVXPY problem: Eqs. :eq:`eq-1`, :eq:`eq-4`, :eq:`eq-10`, :eq:`eq-13`.

In this file a bare symbol is a CVXPY object. The problem is compiled once for a given number
of coordinates and contacts; each step only fills in its parameters. ``StepProblem.problem`` is
an ordinary :class:`cvxpy.Problem`: print it, inspect it, extend it.
"""

from __future__ import annotations

from collections.abc import Sequence

import cvxpy as cp
import numpy as np

from quasistatic_ref.errors import StepDataError
from quasistatic_ref.step.cones import ELLIPSOID
from quasistatic_ref.step.data import Array, StepData
from quasistatic_ref.step.extension import Extension, Scale, Symbols
from quasistatic_ref.step.friction import friction_coefficients, friction_rows


class StepProblem:
    """Eq. :eq:`eq-13` with everything that changes between steps as a parameter.

    Parameters
    ----------
    like : StepData
        A step of the same kind: its h, its numbers of coordinates and extra rows, and the
        cone and number of rows of each contact are fixed; everything else is a parameter.
    extension : Extension, optional
        Further constraints and costs.
    scale : Scale, optional
        What the numbers of `like` mean, where they are not SI units.

    Attributes
    ----------
    problem : cvxpy.Problem
    delta_q_a : cvxpy.Variable
        Shape (n_a,) [m, rad].
    delta_q_u : cvxpy.Variable
        Shape (n_u,) [m, rad].
    delta_q : cvxpy.Expression
        [delta_q_a; delta_q_u].
    """

    def __init__(
        self, like: StepData, extension: Extension | None = None, scale: Scale | None = None
    ) -> None:
        h, n_a, n_u, n_v, n_c = like.h, like.n_a, like.n_u, like.n_v, like.contacts.n_c
        self.h, self.n_a, self.n_u = h, n_a, n_u
        self.cone, self.rows, self.mask = like.cone, like.contacts.rows, like.mask
        having = [np.flatnonzero(column) for column in self.mask.T]

        delta_q_a, delta_q_u = cp.Variable(n_a, "delta_q_a"), cp.Variable(n_u, "delta_q_u")
        delta_q = cp.hstack([delta_q_a, delta_q_u])
        K_q = cp.Parameter((n_a, n_a), "K_q", PSD=True)
        M_u = cp.Parameter((n_u, n_u), "M_u", PSD=True)
        delta_q_bar_a = cp.Parameter(n_a, "delta_q_bar_a")
        tau_k = cp.Parameter(n_a, "tau_k")  # K_q delta_q_bar_a, Eq. (1)
        tau_a, tau_u = cp.Parameter(n_a, "tau_a"), cp.Parameter(n_u, "tau_u")
        phi = cp.Parameter(n_c, "phi")
        A = [cp.Parameter((len(j), n_v), f"A_{i}") for i, j in enumerate(having)]
        A_x = cp.Parameter(like.extra.A.shape, "A_x")
        b_x = cp.Parameter(like.extra.b.shape, "b_x")

        # Eqs. (4) and (10): row i of every contact j that has it. In the paper's cone, i = 0 .. 3
        # are the tangential pyramid (5)-(6), i = 4, 5 the torsional rows (7).
        slack = [phi[j] + A[i] @ delta_q for i, j in enumerate(having)]
        friction = [slack_i >= 0 for slack_i in slack if slack_i.size]
        if like.cone == ELLIPSOID and n_c:  # no rows: phi + J_n dq >= ||mu o (J_1, J_2, J_w) dq||
            slack = slack[:1]
            friction = [cp.SOC(slack[0], cp.vstack([A_i @ delta_q for A_i in A[1:]]))]
        extra = [A_x @ delta_q >= b_x] if like.extra.names else []

        # Eq. (13); a term without coordinates is left out.
        impedance = n_a and not (extension is not None and extension.without_stiffness)
        stiffness = h / 2 * cp.quad_form(delta_q_a, K_q) if impedance else 0
        inertia = 1 / (2 * h) * cp.quad_form(delta_q_u, M_u) if n_u else 0
        work_a = h * ((tau_k + tau_a) if impedance else tau_a) @ delta_q_a if n_a else 0
        work_u = h * tau_u @ delta_q_u if n_u else 0
        objective = stiffness + inertia - work_a - work_u

        self.delta_q_a, self.delta_q_u, self.delta_q = delta_q_a, delta_q_u, delta_q
        self.K_q, self.M_u, self.tau_k, self.tau_a, self.tau_u = K_q, M_u, tau_k, tau_a, tau_u
        self.delta_q_bar_a, self.phi, self.A, self.A_x, self.b_x = delta_q_bar_a, phi, A, A_x, b_x
        self.having, self.slack, self.friction, self.extra = having, slack, friction, extra
        own_cost = self._add_own(extension, scale or Scale(np.ones(n_v), 1.0, 1.0))
        constraints = friction + extra + self.own_constraints
        self.problem = cp.Problem(cp.Minimize(objective + own_cost), constraints)

    def fits(self, step: StepData) -> bool:
        """Tell whether a step can be filled in without building another problem."""
        return (
            step.h == self.h
            and (step.n_a, step.n_u) == (self.n_a, self.n_u)
            and step.cone == self.cone
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
            raise StepDataError(
                "the step has another h or cone, or other numbers of coordinates or rows"
            )
        A = friction_rows(step.contacts, step.cone)
        self.mu = friction_coefficients(step.contacts)
        if step.cone == ELLIPSOID:
            A[:, 1:] *= self.mu[:, :, None]
        _set(self.K_q, step.K_q)
        _set(self.M_u, step.M_u)
        self.delta_q_bar_a.value = step.delta_q_bar_a
        self.tau_k.value = step.K_q @ step.delta_q_bar_a  # Eq. (1)
        self.tau_a.value, self.tau_u.value = step.tau_a, step.tau_u
        self.phi.value = step.contacts.phi
        for i, (A_i, j) in enumerate(zip(self.A, self.having, strict=True)):
            A_i.value = A[j, i]
        self.A_x.value, self.b_x.value = step.extra.A, step.extra.b

    def primal(self) -> Array:
        """delta_q of the last solve, shape (n_v,)."""
        blocks = [x.value for x in (self.delta_q_a, self.delta_q_u) if x.size]
        return np.concatenate([np.zeros(0), *blocks])

    def dual(self) -> Array:
        """Multipliers of the last solve, contact-major, the user's own rows last; shape (m,)."""
        lam = np.zeros(self.mask.shape)
        if self.cone == ELLIPSOID:
            for constraint in self.friction:  # one, or none without contacts
                f_n, scaled = constraint.dual_value
                lam = np.column_stack([f_n, self.mu * np.transpose(scaled)])
        else:
            having = [(i, j) for i, j in enumerate(self.having) if len(j)]
            for (i, j), constraint in zip(having, self.friction, strict=True):
                lam[j, i] = constraint.dual_value
        own = [constraint.dual_value for constraint in self.extra]
        return np.concatenate([lam[self.mask], *own])

    def _add_own(self, extension: Extension | None, one: Scale) -> cp.Expression | float:
        """Keep a user's constraints and costs, and return the costs in units of the problem."""
        own: Sequence[cp.Constraint | cp.Expression] = ()
        if extension is not None:
            a, u = one.coordinate[: self.n_a], one.coordinate[self.n_a :]
            symbols = Symbols(
                delta_q=cp.multiply(one.coordinate, self.delta_q),
                delta_q_a=cp.multiply(a, self.delta_q_a),
                delta_q_u=cp.multiply(u, self.delta_q_u),
                delta_q_bar_a=cp.multiply(a, self.delta_q_bar_a),
                slack=tuple(one.length * slack_i for slack_i in self.slack),
            )
            own = extension.terms(symbols)
        self.own_constraints = [term for term in own if isinstance(term, cp.Constraint)]
        self.own_costs = [term for term in own if not isinstance(term, cp.Constraint)]
        return sum(self.own_costs) / one.cost if self.own_costs else 0


def _set(parameter: cp.Parameter, value: Array) -> None:
    """Set a matrix parameter only when it changed: CVXPY checks its definiteness each time."""
    if parameter.value is None or not np.array_equal(parameter.value, value):
        parameter.value = value
