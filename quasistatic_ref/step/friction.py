r"""Polyhedral friction cones, each one function of a contact's gap, slip_1, slip_2 and spin.

These are phi + J_n delta_q, mu_v J_1 delta_q, mu_v J_2 delta_q and mu_omega J_w delta_q: the gap
after the step; and the sliding along d1 and d2 and the rotation about n, each multiplied by its
coefficient of friction. All four are lengths. A cone's function returns what must not be negative,
one entry for each of its rows. It only adds, subtracts and multiplies by float64 numbers. Therefore
it returns

- given numbers, the slacks of Eq. :eq:`eq-10`;
- given CVXPY expressions, the left sides of the constraints, Eq. :eq:`eq-4`;
- given the rows J_n, mu_v J_1, mu_v J_2 and mu_omega J_w, the rows of A, Eq. :eq:`eq-8`, in floats
  or in exact numbers;
- given n~, mu_v d1, mu_v d2 and [0; mu_omega], the directions n~ + d~_i of Eqs.
  :eq:`eq-5`-:eq:`eq-7`.

Multipliers >= 0 of the rows combine to a contact force inside of the cone; each function states the
inequality that these forces satisfy. Where mu_v (or mu_omega) is 0, \|f\|/mu <= f_n means f = 0. A
contact whose mu_omega is not used has the leading rows only, and a spin of zero. The ellipsoid is
no polyhedron and has no such function: its four rows are J_n, J_1, J_2 and J_w themselves.
"""

from collections.abc import Callable
from functools import cache
from typing import Any, TypeAlias

import numpy as np

from quasistatic_ref.errors import InputError
from quasistatic_ref.step.arrays import Array
from quasistatic_ref.step.cones import ELLIPSOID, PYRAMID, cone, direction
from quasistatic_ref.step.contacts import Contacts
from quasistatic_ref.step.data import row_layout

Rows: TypeAlias = "tuple[Any, ...]"
ConeFunction: TypeAlias = "Callable[[Any, Any, Any, Any], Rows]"


def pyramid(gap: Any, slip_1: Any, slip_2: Any, spin: Any) -> Rows:
    r"""The paper's cone: :math:`|f_1|/\mu_v + |f_2|/\mu_v + |\tau|/\mu_\omega \le f_n`.

    An octahedron: the rows of a contact share one normal force. The rows are +d1, +d2, -d1, -d2,
    +spin, -spin, in the unit of the arguments, for example [m].
    """
    return (
        gap + slip_1,  # Eq. (5)
        gap + slip_2,
        gap - slip_1,  # Eq. (6)
        gap - slip_2,
        gap + spin,  # Eq. (7)
        gap - spin,
    )


def product(gap: Any, slip_1: Any, slip_2: Any, spin: Any) -> Rows:
    r""":math:`|f_1|/\mu_v + |f_2|/\mu_v \le f_n` and :math:`|\tau|/\mu_\omega \le f_n`.

    Tangential force and torque do not reduce each other's limit. The rows are +d1, +d2, -d1, -d2,
    each with +spin, then each with -spin, in the unit [m] of the arguments.
    """
    sliding = (slip_1, slip_2, -slip_1, -slip_2)
    return (*(gap + slip + spin for slip in sliding), *(gap + slip - spin for slip in sliding))


def frictionless(gap: Any, slip_1: Any, slip_2: Any, spin: Any) -> Rows:
    r""":math:`f_1 = f_2 = \tau = 0 \le f_n`: the gap [m] alone."""
    return (gap,)


@cache
def facets(K: int) -> ConeFunction:
    r"""The cone of a K-sided tangential pyramid: ||(f_1, f_2)||_K / mu_v + |tau| / mu_omega <= f_n.

    ||.||_K is the gauge of the regular polygon with corners on the unit circle, the first at d1.
    The gauge of a vector is at least its length and at most its length over cos(pi / K). K = 4 is
    the paper's cone, bit for bit. The corners' cosines and sines are data, rounded correctly to
    float64.

    Parameters
    ----------
    K : int
        Number of sides, even and at least 4.

    Returns
    -------
    callable
        The cone's function. It returns the sides counter-clockwise about n, then +spin, -spin, in
        the unit [m] of its arguments.
    """
    corners = [direction(k, K) for k in range(K)]

    def rows(gap: Any, slip_1: Any, slip_2: Any, spin: Any) -> Rows:
        sides = (gap + c * slip_1 + s * slip_2 for c, s in corners)
        return (*sides, gap + spin, gap - spin)

    return rows


CONES: dict[str, ConeFunction] = {
    PYRAMID: pyramid,
    "product": product,
    "frictionless": frictionless,
}


def cone_function(name: str) -> ConeFunction:
    """The function of a polyhedral cone, by its name.

    Raises
    ------
    StepDataError
        If there is no such cone.
    InputError
        For the ellipsoid: one second-order cone, gap >= ||(slip_1, slip_2, spin)||, has no rows.
    """
    if not cone(name).polyhedral:
        raise InputError("has no rows", field="cone", value=name)
    return CONES[name] if name in CONES else facets(int(name.removeprefix("facets-")))


@cache
def cone_matrix(name: str) -> Array:
    """Coefficients of the rows of a polyhedral cone: what its function makes of unit vectors.

    Returns
    -------
    ndarray, shape (R, 4)
        Of gap, slip_1, slip_2 and spin [-]. The admissible (f_1, f_2, tau) at f_n = 1, in units of
        (mu_v, mu_v, mu_omega), are the convex hull of the R rows without their first entries; the
        limit surface is its boundary.
    """
    matrix = np.stack(cone_function(name)(*np.eye(4)))
    matrix.setflags(write=False)
    return matrix


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


def friction_rows(contacts: Contacts, name: str = PYRAMID) -> Array:
    """The rows [J'(n~ + d~_i)]' of Eq. :eq:`eq-4`, for each contact all that the cone has.

    Parameters
    ----------
    contacts : Contacts
    name : str
        The cone. For the ellipsoid, which has no inequality rows: J_n, J_1, J_2 and J_w.

    Returns
    -------
    ndarray, shape (n_c, R, n_v)
        [m] per unit of delta_q. A contact uses those of ``StepData.mask``: with the paper's
        cone six, or the first four.
    """
    return rows_along(contacts, contacts.J, name)


def rows_along(contacts: Contacts, J: Array, name: str = PYRAMID) -> Array:
    """Eq. :eq:`eq-4` for any columns of J, shape (n_c, 4, w): all of them, or those of blocks."""
    J_n, J_1, J_2, J_w = frame_jacobian(contacts, J)
    if name == ELLIPSOID:
        return np.stack([J_n, J_1, J_2, J_w], axis=1)
    mu_v, _, mu_omega = contacts.mu.T[:, :, None]
    rows = cone_function(name)(J_n, mu_v * J_1, mu_v * J_2, mu_omega * J_w)
    return np.array(rows).swapaxes(0, 1)


def row_gaps(contacts: Contacts, name: str = PYRAMID) -> Array:
    """The constant term of each row [m]: phi; in the ellipsoid phi in the row J_n, 0 in the others.

    Returns
    -------
    ndarray, shape (n_c, R)
    """
    of_gap = np.eye(4)[0] if name == ELLIPSOID else cone_matrix(name)[:, 0]
    return np.asarray(contacts.phi[:, None] * of_gap)


def contact_wrenches(contacts: Contacts, lam: Array, h: float, name: str = PYRAMID) -> Array:
    """Contact wrenches from the multipliers: their combination of n~ + d~_i, divided by h.

    Parameters
    ----------
    contacts : Contacts
    lam : ndarray, shape (m,)
        Multipliers, contact-major [N s]; in the ellipsoid each contact's impulse (n, d1, d2, spin).
    h : float
        Time step [s].
    name : str
        The cone.

    Returns
    -------
    ndarray, shape (n_c, 4)
        (f_d1, f_d2, f_n, tau_n) on beta's body [N, N m]: a force at the point beta, and a torque
        about n.
    """
    if name == ELLIPSOID:
        return lam.reshape(-1, 4)[:, [1, 2, 0, 3]] / h
    mask = row_layout(name, contacts.rows.tobytes()).mask
    impulses = np.zeros(mask.shape)
    impulses[mask] = lam
    f_n, f_d1, f_d2, tau_n = (impulses @ cone_matrix(name)).T
    mu_v, _, mu_omega = contacts.mu.T
    wrench = np.array([mu_v * f_d1, mu_v * f_d2, f_n, mu_omega * tau_n])
    return wrench.T / h
