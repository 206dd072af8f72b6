r"""Eq. :eq:`eq-13` as the matrices H, g, A, b that solvers see, in SI units or in others.

.. math:: \min_{\delta q} \tfrac12 \delta q^T H \delta q - g^T \delta q
          \quad\text{s.t.}\quad A\,\delta q \ge b

With :math:`\delta q = \rho\,S\,x` and lengths in units of :math:`\rho\,\ell`, Eqs. :eq:`eq-13` and
:eq:`eq-4` keep their form.
"""

import math
from typing import Final, NamedTuple

import numpy as np

from quasistatic_ref.numbers.arrays import Array, Mask
from quasistatic_ref.numbers.ordered import product
from quasistatic_ref.step.cones import PYRAMID, cone
from quasistatic_ref.step.contacts import Contacts, spread
from quasistatic_ref.step.data import StepData, check_step

OUT_OF_REACH: Final = 100.0
"""Distance, in natural units [-], beyond which a contact is as good as infinitely far.

The unconstrained step has a length of about one. Solvers lose digits where 1e6 and 1 stand
together; a row that is put at 100 stays inactive, and the judge, who has the true distance, would
notice if it did not."""


class StandardForm(NamedTuple):
    """The quadratic program of one step, in float64.

    ``standard_form`` makes it; its constructor checks nothing.

    Parameters
    ----------
    H : ndarray, shape (n_v, n_v)
        Positive definite; block diagonal, unless a user's cost couples the blocks.
    g : ndarray, shape (n_v,)
    A : ndarray, shape (m, n_v)
        Contact-major; the user's extra rows come last. A contact in the ellipsoid has four rows,
        J_n, J_1, J_2 and J_w: A delta_q - b is (gap, sliding along d1 and d2, rotation about n).
    b : ndarray, shape (m,)

    Examples
    --------
    >>> step = qr.load_scenario("sphere_spin", steps=1).run(progress=False).step_data(0)
    >>> form: qr.StandardForm = qr.standard_form(step)
    >>> form
    <StandardForm of 6 variables, 6 rows>
    """

    H: Array
    g: Array
    A: Array
    b: Array

    def __repr__(self) -> str:
        return f"<{type(self).__name__} of {len(self.g)} variables, {len(self.b)} rows>"

    def free(self) -> Array:
        """The minimiser without rows, H^-1 g, shape (n_v,)."""
        return np.asarray(np.linalg.solve(self.H, self.g), dtype=np.float64)


def standard_form(step: StepData) -> StandardForm:
    """H, g of Eq. :eq:`eq-13` and A, b of Eq. :eq:`eq-8`, stacked over the contacts.

    Parameters
    ----------
    step : StepData

    Returns
    -------
    StandardForm

    Examples
    --------
    >>> step = qr.load_scenario("sphere_spin", steps=1).run(progress=False).step_data(0)
    >>> form = qr.standard_form(step)
    >>> form.H.shape, form.A.shape
    ((6, 6), (6, 6))
    """
    check_step(step)
    A, b = inequalities(step)
    return StandardForm(step.H, linear_term(step), A, b)


def inequalities(step: StepData, known: tuple[Array, Array] | None = None) -> tuple[Array, Array]:
    """A, shape (m, n_v), and b, shape (m,), of Eq. :eq:`eq-8` and of the user's rows.

    Parameters
    ----------
    step : StepData
    known : (ndarray, ndarray), shapes (m_c, w) and (m,), optional [m]
        Its :func:`own_inequalities`, where they are known.
    """
    own, b = own_inequalities(step) if known is None else known
    column = np.repeat(step.contacts.column, step.counts, axis=0)
    A = spread(own[:, None], column, step.n_v)[:, 0]
    return np.concatenate([A, step.extra.A]) if step.extra.names else A, b


def own_inequalities(step: StepData) -> tuple[Array, Array]:
    """A of the contacts by their own columns, (m_c, w), and b of all rows, (m,): Eq. :eq:`eq-8`."""
    A, b = contact_inequalities(step.contacts, step.cone, step.mask)
    return A, np.concatenate([b, step.extra.b]) if step.extra.names else b


def contact_inequalities(contacts: Contacts, name: str, mask: Mask) -> tuple[Array, Array]:
    """A by own columns, (m_c, w), and b, (m_c,), of the rows that a `mask` says: Eq. :eq:`eq-8`.

    Parameters
    ----------
    contacts : Contacts
    name : str
        The cone.
    mask : ndarray of bool, shape (n_c, R)
        As of ``StepData.mask``.
    """
    if contacts.pyramid is not None and name == PYRAMID:
        return contacts.pyramid
    A = friction_rows(contacts, name, contacts.own)[mask]  # Eq. (8)
    return A, -row_constants(contacts, name)[mask]  # Eq. (8)


def linear_term(step: StepData) -> Array:
    """The linear term g of Eq. :eq:`eq-13` and of a user's cost, (n_v,) [N s, N m s]."""
    g = linear_terms(step.h, step.K_q, step.delta_q_bar_a, step.tau_a, step.tau_u)
    cost = step.extra.cost
    return g if cost is None else g + cost[1]


def linear_terms(h: float, K_q: Array, delta_q_bar_a: Array, tau_a: Array, tau_u: Array) -> Array:
    """The linear term g of Eq. :eq:`eq-13` of a step, or of N, shape (..., n_v) [N s, N m s].

    Parameters
    ----------
    h, K_q, delta_q_bar_a, tau_a, tau_u
        As of :class:`~quasistatic_ref.step.data.StepData`; the last three of all steps.
    """
    tau_k = spring_load(K_q, delta_q_bar_a)
    return np.asarray(h * np.concatenate([tau_k + tau_a, tau_u], axis=-1))


def spring_load(K_q: Array, delta_q_bar_a: Array) -> Array:
    """The force tau_k of the springs at delta_q = 0, Eq. :eq:`eq-1`, shape (..., n_a) [N, N m].

    Parameters
    ----------
    K_q : ndarray, shape (n_a, n_a)
        [N/m, N m/rad]
    delta_q_bar_a : ndarray, shape (n_a,); or (N, n_a), of several steps
        How far the targets are [m, rad].
    """
    if delta_q_bar_a.ndim == 1:
        return product(K_q, delta_q_bar_a)  # Eq. (1)
    return product(delta_q_bar_a, K_q.T) if delta_q_bar_a.size else delta_q_bar_a


def frame_jacobian(contacts: Contacts, J: Array) -> tuple[Array, Array, Array, Array]:
    """J_n, J_1, J_2 and J_w: J of Eq. :eq:`eq-3` in the contact's frame.

    Parameters
    ----------
    contacts : Contacts
    J : ndarray, shape (n_c, 4, w)
        Any columns of J: all of them, or those of blocks.

    Returns
    -------
    tuple of ndarray, each of shape (n_c, w)
        The motion along n, d1 and d2 [m] and about n [rad], per unit of delta_q.
    """
    # Not `@`: BLAS sums in another order on another processor, and the last bits would differ.
    axes = np.array([contacts.n, contacts.d1, contacts.d2])
    parts = axes[..., None] * J[:, :3]
    J_n, J_1, J_2 = parts[:, :, 0] + parts[:, :, 1] + parts[:, :, 2]
    return J_n, J_1, J_2, J[:, 3]


def friction_rows(contacts: Contacts, name: str = PYRAMID, J: Array | None = None) -> Array:
    """The rows [J'(n~ + d~_i)]' of Eq. :eq:`eq-4`: for each contact all rows of the cone.

    Parameters
    ----------
    contacts : Contacts
    name : str
        The cone. A curved one has no inequality rows: J_n, J_1, J_2 and J_w.
    J : ndarray, shape (n_c, 4, w), optional
        Any columns of J; by default all.

    Returns
    -------
    ndarray, shape (n_c, R, w)
        [m] per unit of delta_q. A contact uses those of ``StepData.mask``: with the paper's
        cone six, or the first four.
    """
    J_n, J_1, J_2, J_w = frame_jacobian(contacts, contacts.J if J is None else J)
    friction_cone = cone(name)
    mu_v, _, mu_omega = friction_cone.row_coefficients(contacts.mu).T[:, :, None]
    rows = friction_cone.function(J_n, mu_v * J_1, mu_v * J_2, mu_omega * J_w)
    # np.stack(rows, axis=1) takes twice as long.
    return np.concatenate(rows, axis=1).reshape(len(J_n), len(rows), J_n.shape[1])


def row_constants(contacts: Contacts, name: str = PYRAMID) -> Array:
    """The constant term of each row [m]: phi; in a curved cone phi in the row J_n, otherwise 0.

    Returns
    -------
    ndarray, shape (n_c, R)
    """
    return np.asarray(contacts.phi[:, None] * cone(name).matrix[:, 0])


class Units(NamedTuple):
    """Units of one step.

    Parameters
    ----------
    coordinate : ndarray, shape (n_v,)
        Diagonal of S [m or rad, per (N m s)^0.5].
    length : float
        ell [m per (N m s)^0.5].
    size : float
        rho [(N m s)^0.5].
    """

    coordinate: Array
    length: float
    size: float


def si_units(n_v: int) -> Units:
    """SI units for a step of n_v coordinates: all factors are one."""
    return Units(np.ones(n_v), 1.0, 1.0)


def page_units(units: Units, h: float) -> Units:
    """Units in which a page of accelerations and forces is the program in natural units.

    With delta_q = h^2 a, energy / h^3 and rows / h^2 the matrix of (13) is multiplied by h, its
    loads by 1 / h and the ends of (4) by 1 / h^2: S and ell become S and ell over sqrt(h), and rho
    becomes rho / h^1.5, each to the next power of two.

    Parameters
    ----------
    units : Units
        Natural units; or SI units, for those of the page in natural units.
    h : float
        Time step [s].
    """
    root = _power_of_two(-0.5 * math.log2(h))
    size = _power_of_two(-2.0 * math.log2(h) - math.log2(root))
    return Units(units.coordinate * root, units.length * root, units.size * size)


def _power_of_two(exponent: float) -> float:
    return 2.0 ** min(round(exponent), 1023)  # the largest in float64


def clipped_gaps(step: StepData, units: Units, far: float = OUT_OF_REACH) -> tuple[Array, Array]:
    """Gaps of the contacts and ends of the user's rows; those out of reach put nearer.

    They bear nothing, and numbers of very different size cost solvers digits.

    Parameters
    ----------
    step : StepData
    units : Units
    far : float
        How far is out of reach, in these units [-], of rows of at most unit length; of longer ones
        so many times farther.

    Returns
    -------
    phi : ndarray, shape (n_c,)
        [m]
    b : ndarray, shape (e,)
        [m, rad]
    """
    S, ell, rho = units
    far *= rho * ell
    unit = (np.append(S, 0.0) / ell)[step.contacts.column]
    phi = np.minimum(step.contacts.phi, far * _lengths(step.contacts.own * unit[:, None]))
    b = np.maximum(step.extra.b, -far * _lengths(step.extra.A[:, None] * (S / ell)))
    return phi, b


def _lengths(J: Array) -> Array:
    """The Frobenius norm of each matrix of J, (n, rows, n_v), and at least 1, shape (n,) [-]."""
    return np.asarray(np.maximum(1.0, np.sqrt(np.einsum("cij,cij->c", J, J))))
