"""The paper's page: Eqs. :eq:`eq-1`, :eq:`eq-3`-:eq:`eq-7`, :eq:`eq-10`, :eq:`eq-13` in CVXPY.

Where the problem is built, symbols are CVXPY objects, except the numbers h, mu_v and mu_omega.
"""

import cvxpy as cp
import numpy as np

from quasistatic_ref.errors import StepDataError
from quasistatic_ref.step.cones import PYRAMID
from quasistatic_ref.step.data import Array, StepData
from quasistatic_ref.step.extension import Own, none
from quasistatic_ref.step.friction import Friction, frame_jacobian


class StepProblem:
    """Eq. :eq:`eq-13`; ``problem`` is an ordinary :class:`cvxpy.Problem`: print it, extend it.

    Extensions read ``delta_q``, ``contact_rows`` (a constraint for each row of the cone) and
    ``motion``: gap, slip_1, slip_2 and spin [m], shapes (n_c,), mu included in the last three.

    Parameters
    ----------
    like : StepData
        A step of the same kind: its h, mu_v, mu_omega, cone and sizes are constants of the problem.
    friction : callable, optional
        A cone of :mod:`~quasistatic_ref.step.friction`, in place of the paper's.
    constraints, costs : callable, optional
        Functions of this StepProblem that return a list of additional constraints, or costs. Where
        a cost replaces the springs, set K_q and tau_k to zero after each :meth:`fill`.
    """

    def __init__(
        self, like: StepData, friction: Friction = None, constraints: Own = none, costs: Own = none
    ) -> None:
        if friction is None and like.cone != PYRAMID:
            raise StepDataError("needs its own friction function", field="cone", value=like.cone)
        h, n_a, n_u, n_v, n_c = like.h, like.n_a, like.n_u, like.n_v, like.contacts.n_c
        mu_v, _, mu_omega = like.contacts.mu.T
        torsional = like.contacts.rows == 6
        delta_q_a, delta_q_u = cp.Variable(n_a, "delta_q_a"), cp.Variable(n_u, "delta_q_u")
        delta_q = cp.hstack([delta_q_a, delta_q_u])
        K_q, M_u = (cp.Parameter((n, n), s, PSD=True) for s, n in (("K_q", n_a), ("M_u", n_u)))
        tau_k, tau_a = cp.Parameter(n_a, "tau_k"), cp.Parameter(n_a, "tau_a")
        tau_u, phi = cp.Parameter(n_u, "tau_u"), cp.Parameter(n_c, "phi")
        J_n, J_1, J_2, J_w = (cp.Parameter((n_c, n_v), f"J_{axis}") for axis in "n12w")
        A_x, b_x = cp.Parameter(like.extra.A.shape, "A_x"), cp.Parameter(like.extra.b.shape, "b_x")

        gap = phi + J_n @ delta_q  # Eqs. (3), (4): J along n, d1, d2 and about n
        slip_1 = cp.multiply(mu_v, J_1 @ delta_q)
        slip_2 = cp.multiply(mu_v, J_2 @ delta_q)
        spin = cp.multiply(mu_omega, J_w @ delta_q)
        pyramid = [gap + slip_1 >= 0, gap + slip_2 >= 0]  # Eq. (5)
        pyramid += [gap - slip_1 >= 0, gap - slip_2 >= 0]  # Eq. (6)
        torsion = [(gap + spin)[torsional] >= 0, (gap - spin)[torsional] >= 0]  # Eq. (7)
        rows = pyramid + torsion  # Eq. (10)
        if friction is not None:
            sides = friction(gap, slip_1, slip_2, spin)  # no sides in the ellipsoid
            rows = [side[j] >= 0 for side, j in zip(sides, like.mask.T, strict=bool(sides))]

        stiffness = h / 2 * cp.quad_form(delta_q_a, K_q) if n_a else 0  # Eq. (13)
        inertia = 1 / (2 * h) * cp.quad_form(delta_q_u, M_u) if n_u else 0
        work = h * (tau_k + tau_a) @ delta_q_a + h * tau_u @ delta_q_u

        self.delta_q_a, self.delta_q_u, self.delta_q = delta_q_a, delta_q_u, delta_q
        self.motion = gap, slip_1, slip_2, spin
        self.contact_rows = [row for row in rows if row.size]
        self.like, self.extra = like, [A_x @ delta_q >= b_x] if like.extra.names else []
        self.parameters = (K_q, M_u, tau_k, tau_a, tau_u, phi, J_n, J_1, J_2, J_w, A_x, b_x)
        objective = cp.Minimize(sum(costs(self), stiffness + inertia - work))
        self.problem = cp.Problem(objective, [*self.contact_rows, *self.extra, *constraints(self)])

    def fits(self, step: StepData) -> bool:
        """Tell whether a step can be filled in without building another problem."""
        kinds = [(s.h, s.cone, s.n_a, s.n_u, s.extra.A.shape) for s in (self.like, step)]
        fixed = [(s.contacts.rows, s.contacts.mu) for s in (self.like, step)]
        return kinds[0] == kinds[1] and all(map(np.array_equal, *fixed))

    def fill(self, step: StepData) -> None:
        """Set every parameter from one step; StepDataError if it is of another kind."""
        if not self.fits(step):
            raise StepDataError("the step has another h, cone, size, mu_v, mu_omega or row count")
        tau_k = step.K_q @ step.delta_q_bar_a  # Eq. (1)
        J = frame_jacobian(step.contacts, step.contacts.J)
        forces, own = (tau_k, step.tau_a, step.tau_u), (step.extra.A, step.extra.b)
        values = (step.K_q, step.M_u, *forces, step.contacts.phi, *J, *own)
        for parameter, value in zip(self.parameters, values, strict=True):
            if not np.array_equal(parameter.value, value):  # CVXPY checks each matrix that is set
                parameter.value = value

    def primal(self) -> Array:
        """delta_q of the last solve, shape (n_v,)."""
        return np.concatenate([x.value for x in (self.delta_q_a, self.delta_q_u) if x.size])

    def dual(self) -> Array:
        """Multipliers of the last solve, contact-major, the user's own rows last; shape (m,)."""
        lam, mask = np.zeros(self.like.mask.shape), self.like.mask
        for i, row in zip(np.flatnonzero(mask.any(axis=0)), self.contact_rows, strict=True):
            lam[mask[:, i], i] = row.dual_value
        return np.concatenate([lam[mask], *(row.dual_value for row in self.extra)])
