"""Wrenches of contacts from the multipliers of their friction cone."""

from typing import Any

import numpy as np

from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.step.cones import PYRAMID, cone
from quasistatic_ref.step.contacts import Contacts
from quasistatic_ref.step.data import row_layout


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
