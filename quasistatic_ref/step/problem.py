"""The paper's program in CVXPY: Eqs. :eq:`eq-1`, :eq:`eq-3`-:eq:`eq-7`, :eq:`eq-10`, :eq:`eq-13`.

Where the problem is built, symbols are CVXPY objects, except the numbers h, mu_v and mu_omega.
Units are those of the steps that fill it. A run fills it with steps in natural units, in which
contacts out of reach are nearer (:mod:`~quasistatic_ref.solve.through_cvxpy`).
"""

import cvxpy as cp
import numpy as np

from quasistatic_ref.errors import StepDataError
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.parts import needing
from quasistatic_ref.step.cones import PYRAMID
from quasistatic_ref.step.data import KIND, StepData, differences
from quasistatic_ref.step.friction import frame_jacobian
from quasistatic_ref.tolerances import ACCURACY


class StepProblem:
    """Eq. :eq:`eq-13`, for the steps of one h, mu_v, mu_omega, row count and size.

    ``problem`` is an ordinary :class:`cvxpy.Problem`: print it, extend it. Filled with a step in
    SI units, its costs are about 1e-7, below the tolerances of every solver: ``problem.solve()``
    then ends "optimal", and is wrong by up to all of its digits. :meth:`solve` asks a solver in
    natural units, as ``solve_step`` does before its proof. Other cones,
    rows of a user's own and the order of the multipliers build on it in
    :class:`~quasistatic_ref.solve.cvxpy_problem.CvxpyProblem`.

    Parameters
    ----------
    template : StepData
        A step of that kind.

    Attributes
    ----------
    parameters : dict of str to cvxpy.Parameter
        What changes from step to step, by name; :meth:`fill` sets it.
    contact_motion : tuple of cvxpy.Expression
        gap, slip_1, slip_2 and spin [m, or natural units], shapes (n_c,), mu included in the last
        three.
    contact_rows : list of cvxpy.Constraint
        Eq. :eq:`eq-4` in the paper's order, one constraint for that row of the contacts that have
        it; none where no contact has.

    Raises
    ------
    StepDataError
        If the step is in another cone, or has rows or a cost of a user's own.

    Examples
    --------
    >>> step = qr.load_scenario("sphere_spin", steps=1).run(progress=False).step_data(0)
    >>> page = qr.StepProblem(step)
    >>> page.fill(step)
    >>> page.problem.is_qp()
    True
    >>> bool(abs(page.solve("clarabel") - qr.solve_step(step).delta_q).max() < 1e-12)
    True
    """

    def __init__(self, template: StepData) -> None:
        self.template = template
        self.step: StepData | None = None
        self.check_kind()
        n_a = template.n_a
        n_u = template.n_u
        n_v = template.n_v
        n_c = template.contacts.n_c

        # What all these steps have in common.
        h = template.h
        mu_v = template.contacts.mu_v
        mu_omega = template.contacts.mu[:, 2]
        torsional = template.contacts.torsion

        # What changes from step to step.
        K_q = cp.Parameter((n_a, n_a), "K_q", PSD=True)  # stiffness of the actuated coordinates
        M_u = cp.Parameter((n_u, n_u), "M_u", PSD=True)  # mass matrix of the un-actuated ones
        tau_k = cp.Parameter(n_a, "tau_k")  # force of the springs, K_q delta_q_bar_a, Eq. (1)
        tau_a = cp.Parameter(n_a, "tau_a")  # other forces on the actuated coordinates
        tau_u = cp.Parameter(n_u, "tau_u")  # forces on the un-actuated ones
        phi = cp.Parameter(n_c, "phi")  # signed distances
        J_n = cp.Parameter((n_c, n_v), "J_n")  # J of Eq. (3) along n
        J_1 = cp.Parameter((n_c, n_v), "J_1")  # along d1
        J_2 = cp.Parameter((n_c, n_v), "J_2")  # along d2
        J_w = cp.Parameter((n_c, n_v), "J_w")  # about n

        # What is sought: the displacement.
        delta_q_a = cp.Variable(n_a, "delta_q_a")
        delta_q_u = cp.Variable(n_u, "delta_q_u")
        delta_q = cp.hstack([delta_q_a, delta_q_u])

        # Where it brings each contact, Eqs. (3), (4).
        gap = phi + J_n @ delta_q
        slip_1 = cp.multiply(mu_v, J_1 @ delta_q)
        slip_2 = cp.multiply(mu_v, J_2 @ delta_q)
        spin = cp.multiply(mu_omega, J_w @ delta_q)

        # Eq. (10): the rows of Eq. (4), of which each contact has four or six.
        rows = [
            gap + slip_1 >= 0,  # Eq. (5)
            gap + slip_2 >= 0,
            gap - slip_1 >= 0,  # Eq. (6)
            gap - slip_2 >= 0,
            (gap + spin)[torsional] >= 0,  # Eq. (7)
            (gap - spin)[torsional] >= 0,
        ]

        # Eq. (13). CVXPY refuses a quadratic form of no coordinates.
        stiffness = h / 2 * cp.quad_form(delta_q_a, K_q) if n_a else 0
        inertia = 1 / (2 * h) * cp.quad_form(delta_q_u, M_u) if n_u else 0
        work = h * (tau_k + tau_a) @ delta_q_a + h * tau_u @ delta_q_u
        self.contact_rows = [row for row in rows if row.size]
        self.problem = cp.Problem(cp.Minimize(stiffness + inertia - work), self.contact_rows)

        self.delta_q = delta_q
        self.delta_q_a = delta_q_a
        self.delta_q_u = delta_q_u
        self.contact_motion = (gap, slip_1, slip_2, spin)
        named = (K_q, M_u, tau_k, tau_a, tau_u, phi, J_n, J_1, J_2, J_w)
        self.parameters = {parameter.name(): parameter for parameter in named}

    def fill(self, step: StepData) -> None:
        """Set every parameter from one step, which has checked its numbers: CVXPY need not again.

        Raises
        ------
        StepDataError
            If the step is of another kind, naming what differs.
        """
        self.check(step)
        self.set_parameters(step)

    def set_parameters(self, step: StepData) -> None:
        """The same for a step that is known to be of the problem's kind."""
        self.step = step
        J_n, J_1, J_2, J_w = frame_jacobian(step.contacts, step.contacts.J)
        self.parameters["K_q"].save_value(step.K_q)
        self.parameters["M_u"].save_value(step.M_u)
        self.parameters["tau_k"].save_value(step.K_q @ step.delta_q_bar_a)  # Eq. (1)
        self.parameters["tau_a"].save_value(step.tau_a)
        self.parameters["tau_u"].save_value(step.tau_u)
        self.parameters["phi"].save_value(step.contacts.phi)
        self.parameters["J_n"].save_value(J_n)
        self.parameters["J_1"].save_value(J_1)
        self.parameters["J_2"].save_value(J_2)
        self.parameters["J_w"].save_value(J_w)

    def solve(self, solver: str = "clarabel", accuracy: float = ACCURACY) -> Array:
        """A solver's answer to the step that the problem is filled with, in natural units.

        It is the solver's own: nothing is proved. The variables and the multipliers of
        ``contact_rows`` then have its values, in SI units.

        Parameters
        ----------
        solver : str
            A name of ``solve_step``'s; upper case, as in CVXPY, is as good.
        accuracy : float
            Of the answer, in natural units [-].

        Returns
        -------
        ndarray, shape (n_v,)
            delta_q [m, rad].

        Raises
        ------
        StepDataError
            If it is not filled.
        BackendError
            If the solver is unknown or not installed.
        StepNotSolved
            If it claims anything but a full solution.
        """
        if self.step is None:
            raise StepDataError("is not filled: call fill(step) first", field="StepProblem")
        with needing("StepProblem.solve"):
            from quasistatic_ref.optional.extensions.solved_page import solved_page
        return solved_page(self, self.step, solver, accuracy)

    def check(self, step: StepData) -> None:
        """Refuse a step that is not of this problem's kind; StepDataError, naming what differs."""
        for name in differences(self.template, step):
            needed = np.asarray(KIND[name](self.template)).tolist()
            value = np.asarray(KIND[name](step)).tolist()
            message = f"must be {needed!r}; make a problem of this step"
            raise StepDataError(message, field=name, value=value)

    def check_kind(self) -> None:
        """Refuse steps that are not the paper's, with StepDataError."""
        cone = self.template.cone
        names = list(self.template.extra.names)
        remedy = "CvxpyProblem of solve/cvxpy_problem.py takes it"
        if cone != PYRAMID:
            raise StepDataError(f"is not the pyramid; {remedy}", field="cone", value=cone)
        if names:
            raise StepDataError(f"has a user's own rows; {remedy}", field="extra", value=names)
        if self.template.extra.cost is not None:
            raise StepDataError(f"has a user's own cost; {remedy}", field="extra.H")
