"""Rows and wrenches of contacts in their friction cone (:mod:`~quasistatic_ref.step.cones`)."""

from typing import Any

import numpy as np

from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.step.cones import PYRAMID, cone
from quasistatic_ref.step.contacts import Contacts
from quasistatic_ref.step.data import row_layout


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
    """The rows [J'(n~ + d~_i)]' of Eq. :eq:`eq-4`: for each contact all rows of the cone.

    Parameters
    ----------
    contacts : Contacts
    name : str
        The cone. A curved one has no inequality rows: J_n, J_1, J_2 and J_w.

    Returns
    -------
    ndarray, shape (n_c, R, n_v)
        [m] per unit of delta_q. A contact uses those of ``StepData.mask``: with the paper's
        cone six, or the first four.
    """
    J_n, J_1, J_2, J_w = frame_jacobian(contacts, contacts.J)
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


def contact_wrenches(contacts: Contacts, lam: Array, h: float, name: str = PYRAMID) -> Array:
    """Contact wrenches from the multipliers: their combination of n~ + d~_i, divided by h.

    Parameters
    ----------
    contacts : Contacts
    lam : ndarray, shape (..., m)
        Multipliers, contact-major [N s]; in a curved cone each contact's impulse (n, d1, d2, spin);
        of one step, or of several.
    h : float
        Time step [s].
    name : str
        The cone.

    Returns
    -------
    ndarray, shape (..., n_c, 4)
        (f_d1, f_d2, f_n, tau_n) on beta's body [N, N m]: a force at the point beta, and a torque
        about n.
    """
    friction_cone = cone(name)
    of_rows = impulses(contacts, lam, name)
    wrench: Array = wrenches(
        of_rows, friction_cone.matrix, friction_cone.row_coefficients(contacts.mu)
    )
    return wrench / h


def impulses(contacts: Contacts, lam: Array, name: str) -> Array:
    """The multiplier of each row of the cone, (..., n_c, R) [N s]; 0 where a contact lacks it.

    Parameters
    ----------
    contacts, lam, name
        As in :func:`contact_wrenches`.
    """
    mask = row_layout(name, contacts.rows.tobytes()).mask
    of_rows = np.zeros((*lam.shape[:-1], *mask.shape))
    of_rows[..., mask] = lam
    return of_rows


def wrenches(of_rows: Any, matrix: Any, mu: Any) -> Any:
    """Wrenches times h, shape (..., n_c, 4) [N s, N m s], in floats or in fractions.

    Parameters
    ----------
    of_rows : ndarray, shape (..., n_c, R)
        Impulses [N s].
    matrix : ndarray, shape (R, 4)
        Of the cone [-].
    mu : ndarray, shape (n_c, 3)
        (mu_v, mu_v, mu_omega) [-, -, m].
    """
    wrench = (of_rows @ matrix)[..., [1, 2, 0, 3]]  # from (f_n, f_d1, f_d2, tau_n)
    wrench[..., :2] *= mu[:, :2]
    wrench[..., 3] *= mu[:, 2]
    return wrench
