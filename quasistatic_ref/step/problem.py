"""The paper's program in CVXPY: Eqs. :eq:`eq-1`, :eq:`eq-3`-:eq:`eq-7`, :eq:`eq-10`, :eq:`eq-13`.

The unknowns are accelerations, a = delta_q / h^2. With the energy (13) divided by h^3 and its rows
by h^2, which changes no solution, this is Gauss's principle: numbers are those of accelerations and
forces, to which a solver's tolerances fit, and the multipliers are forces [N].

Symbols are CVXPY objects here, except the number h. Units are those of the step, SI as a rule.
"""

from dataclasses import dataclass

import cvxpy as cp
import numpy as np
import scipy.sparse as sp

from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.step.cones import cone
from quasistatic_ref.step.data import StepData
from quasistatic_ref.step.standard_form import (
    Units,
    frame_jacobian,
    page_units,
    si_units,
    spring_load,
)


@dataclass(eq=False)
class Page:
    """The paper's program (13) in CVXPY: its unknowns, parameters, constraints and problem.

    Parameters
    ----------
    problem : cvxpy.Problem
        (13) over h^3 [N m/s^2].
    parameters : dict of str to cvxpy.Parameter
        What changes from step to step, by name.
    a_a, a_u : cvxpy.Variable
        What is sought, shapes (n_a,) and (n_u,) [m/s^2, rad/s^2].
    delta_q_a, delta_q_u : cvxpy.Expression
        The displacement h^2 a, shapes (n_a,) and (n_u,) [m, rad].
    delta_q : cvxpy.Expression
        The one, then the other, shape (n_v,).
    contact_motion : tuple of cvxpy.Expression
        gap, slip_1, slip_2 and spin [m], shapes (n_c,), mu included in the last three.
    contact_rows : list of cvxpy.Constraint
        Eq. :eq:`eq-4` over h^2 [m/s^2] in the paper's order, one constraint for that row of the
        contacts that have it; none where no contact has. Of another cone its own constraints. A
        ``dual_value`` is a force [N], lam / h.
    """

    problem: cp.Problem
    parameters: dict[str, cp.Parameter]
    a_a: cp.Variable
    a_u: cp.Variable
    delta_q_a: cp.Expression
    delta_q_u: cp.Expression
    delta_q: cp.Expression
    contact_motion: tuple[cp.Expression, cp.Expression, cp.Expression, cp.Expression]
    contact_rows: list[cp.Constraint]


def paper_problem(step: StepData) -> Page:
    """Eq. :eq:`eq-13` for steps of one h, mu_v, mu_omega, row count and size.

    :func:`set_values` fills it with such a step. Its rows are those of the step's cone, as A's are.

    Parameters
    ----------
    step : StepData
        A step of that kind.

    Examples
    --------
    >>> from quasistatic_ref.step.problem import paper_problem, set_values
    >>> step = qr.load_scenario("sphere_spin", steps=1).run(progress=False).step_data(0)
    >>> page = paper_problem(step)
    >>> set_values(page, step)
    >>> page.problem.is_qp(), float(page.parameters["tau_u"].value[2])  # -m g [N]
    (True, -2.943)

    The parameters enter as disciplined parametrized programming (DPP) asks, so that CVXPY compiles
    the page once for all their values. ``is_dpp()`` says so inside of the scope in which CVXPY
    counts ``quad_form(x, P)`` as affine in P. Outside it does not: there a P that is a parameter
    counts as one that might make the form concave. CVXPY opens the scope itself when it compiles
    the page for a solver that takes quadratic costs.

    >>> from cvxpy.utilities.scopes import quad_form_dpp_scope
    >>> with quad_form_dpp_scope():
    ...     inside = page.problem.is_dpp()
    >>> inside, page.problem.is_dpp()
    (True, False)
    """
    n_a = step.n_a
    n_u = step.n_u
    n_v = step.n_v
    n_c = step.contacts.n_c

    # What all these steps have in common.
    h = step.h
    h2 = cp.Constant(h**2, name="h^2")
    h2_each = np.full(max(n_v, n_c), h**2)  # CVXPY prints a number times an array as Promote(...)
    mu_v = step.contacts.mu_v
    mu_omega = step.contacts.mu[:, 2]

    # What changes from step to step.
    K_q = cp.Parameter((n_a, n_a), "K_q")  # stiffness of the actuated coordinates
    M_u = cp.Parameter((n_u, n_u), "M_u")  # mass matrix of the un-actuated ones
    tau_k = cp.Parameter(n_a, "tau_k")  # force of the springs
    tau_a = cp.Parameter(n_a, "tau_a")  # other forces on the actuated coordinates
    tau_u = cp.Parameter(n_u, "tau_u")  # forces on the un-actuated ones
    phi = cp.Parameter(n_c, "phi")  # signed distances
    J_n = cp.Parameter((n_c, n_v), "J_n")  # J of Eq. (3) along n
    J_1 = cp.Parameter((n_c, n_v), "J_1")  # along d1
    J_2 = cp.Parameter((n_c, n_v), "J_2")  # along d2
    J_w = cp.Parameter((n_c, n_v), "J_w")  # about n

    # What is sought: accelerations, of which the displacement is h^2 times as much.
    a_a = cp.Variable(n_a, "a_a")
    a_u = cp.Variable(n_u, "a_u")
    delta_q_a = scaled("h^2", h2_each[:n_a], a_a)
    delta_q_u = scaled("h^2", h2_each[:n_u], a_u)
    moving = [part for part in (delta_q_a, delta_q_u) if part.size]  # CVXPY stacks nothing empty
    delta_q = cp.hstack(moving or [delta_q_a])

    # Eq. (4) is phi + [J'(n~ + d~_i)]' delta_q >= 0. In it phi + [J' n~]' delta_q is the gap, and
    # [J' d~_i]' delta_q is slip_1, slip_2, -slip_1, -slip_2, spin and -spin for i = 1 to 6.
    gap = phi + J_n @ delta_q
    slip_1 = scaled("mu_v", mu_v, J_1 @ delta_q)
    slip_2 = scaled("mu_v", mu_v, J_2 @ delta_q)
    spin = scaled("mu_omega", mu_omega, J_w @ delta_q)

    # Eq. (10) over h^2: the rows of Eq. (4), of which each contact has four or six.
    motion = (gap, slip_1, slip_2, spin)
    over = cp.Constant(h2_each[:n_c], name="h^2")
    contact_rows = cone(step.cone).constraints(tuple(part / over for part in motion), step.mask)

    # Eq. (13) over h^3. The quadratic forms are of the unknowns themselves: of h^2 times them CVXPY
    # would make further unknowns and equations. It refuses a quadratic form of no coordinates.
    stiffness = h2 / 2 * cp.quad_form(a_a, K_q, assume_PSD=True) if n_a else 0
    inertia = 1 / 2 * cp.quad_form(a_u, M_u, assume_PSD=True) if n_u else 0
    work = (tau_k + tau_a) @ a_a + tau_u @ a_u
    problem = cp.Problem(cp.Minimize(stiffness + inertia - work), contact_rows)

    named = (K_q, M_u, tau_k, tau_a, tau_u, phi, J_n, J_1, J_2, J_w)
    parameters = {parameter.name(): parameter for parameter in named}
    displacement = (delta_q_a, delta_q_u, delta_q)
    return Page(problem, parameters, a_a, a_u, *displacement, motion, contact_rows)


def scaled(name: str, factors: Array, motion: cp.Expression) -> cp.Expression:
    """Each number of a motion, (n,), times a factor that CVXPY prints by its `name`.

    A diagonal matrix is compiled in a tenth of the time that ``multiply`` takes. One of zeros alone
    would leave parameters without entries, which CVXPY 1.9.3 compiles to arrays it cannot divide.

    Parameters
    ----------
    name : str
    factors : ndarray, shape (n,)
        Coefficients of friction [-, m], or h^2 [s^2].
    motion : cvxpy.Expression, shape (n,)
        [m, rad], or an acceleration [m/s^2, rad/s^2].
    """
    if not factors.any():
        return cp.Constant(np.zeros(factors.size), name="0")
    return cp.Constant(sp.diags_array(factors), name=name) @ motion


def set_values(
    page: Page,
    step: StepData,
    units: Units | None = None,
    ends: tuple[Array, Array] | None = None,
) -> None:
    """Set the parameters of a page to those of a `step` of its kind.

    They have been checked where the step was made. An assignment to the ``value`` of K_q or M_u is
    not: the page takes for granted that both are positive semidefinite.

    Parameters
    ----------
    page : Page
        Of the step's kind; with the parameters of the step's own rows and cost, if it has any.
    step : StepData
        SI units.
    units : Units, optional
        Natural units in which the page is to be solved, up to those of accelerations and forces:
        see :func:`~quasistatic_ref.step.standard_form.page_units`. SI units by default.
    ends : tuple of ndarray, shapes (n_c,) and (e,), optional
        Gaps [m] and ends of own rows [m, rad] in the place of the step's, such as those of
        :func:`~quasistatic_ref.step.standard_form.clipped_gaps`.
    """
    S, ell, rho = si_units(step.n_v) if units is None else page_units(units, step.h)
    phi, b_extra = (step.contacts.phi, step.extra.b) if ends is None else ends
    S_a = S[: step.n_a]
    S_u = S[step.n_a :]
    contacts = step.contacts
    J_n, J_1, J_2, J_w = frame_jacobian(contacts, contacts.J * (S / ell))  # Eq. (3)
    values = {
        "K_q": step.K_q * np.outer(S_a, S_a),
        "M_u": step.M_u * np.outer(S_u, S_u),
        "tau_k": spring_load(step.K_q, step.delta_q_bar_a) * S_a / rho,
        "tau_a": step.tau_a * S_a / rho,
        "tau_u": step.tau_u * S_u / rho,
        "phi": phi / (rho * ell),
        "J_n": J_n,
        "J_1": J_1,
        "J_2": J_2,
        "J_w": J_w,
    }
    if step.extra.names:
        values |= {"A_extra": step.extra.A * (S / ell), "b_extra": b_extra / (rho * ell)}
    if step.extra.cost is not None:
        H, g = step.extra.cost
        values |= {"H_extra": H * np.outer(S, S), "g_extra": g * S / rho}
    for name, value in values.items():
        page.parameters[name].save_value(value)
