r"""The contact-and-friction directions of the paper, Eqs. (5)-(7), and the rows they make.

For each contact the rows forbid that the motion J delta_q leaves the dual of the friction
cone. Their multipliers add up to a wrench inside

.. math:: |f_1|/\mu_v + |f_2|/\mu_v + |\tau_n|/\mu_\omega \le f_n,

an octahedron: the rows of a contact share one normal force.
"""

from __future__ import annotations

import numpy as np

from quasistatic_ref.step.data import Array, Contacts


def normal_direction(n: Array) -> Array:
    """n~ = [n, 0] of Eq. (4).

    Parameters
    ----------
    n : ndarray, shape (n_c, 3)
        Unit normals, world frame.

    Returns
    -------
    ndarray, shape (n_c, 4)
    """
    return np.concatenate([n, np.zeros((len(n), 1))], axis=1)


def tangential_directions(d1: Array, d2: Array, mu_v: Array) -> Array:
    """d~_1 .. d~_4 of Eqs. (5)-(6): the tangential friction pyramid.

    Parameters
    ----------
    d1, d2 : ndarray, shape (n_c, 3)
        Unit tangents, world frame.
    mu_v : ndarray, shape (n_c,)
        Tangential friction coefficient [-].

    Returns
    -------
    ndarray, shape (n_c, 4, 4)
        Contact, direction i, component of (2).
    """
    d_tilde_1 = normal_direction(mu_v[:, None] * d1)  # Eq. (5)
    d_tilde_2 = normal_direction(mu_v[:, None] * d2)  # Eq. (5)
    return np.stack([d_tilde_1, d_tilde_2, -d_tilde_1, -d_tilde_2], axis=1)  # Eq. (6)


def torsional_directions(mu_omega: Array) -> Array:
    """d~_5, d~_6 of Eq. (7): torsional friction about the normal.

    Parameters
    ----------
    mu_omega : ndarray, shape (n_c,)
        Torsional friction coefficient, a length [m].

    Returns
    -------
    ndarray, shape (n_c, 2, 4)
    """
    d_tilde_5 = np.concatenate([np.zeros((len(mu_omega), 3)), mu_omega[:, None]], axis=1)
    return np.stack([d_tilde_5, -d_tilde_5], axis=1)  # Eq. (7)


def pyramid(contacts: Contacts) -> Array:
    """All six d~ of the paper's cone, Eqs. (5)-(7).

    Returns
    -------
    ndarray, shape (n_c, 6, 4)
        In the paper's order: +d1, +d2, -d1, -d2, +spin, -spin.
    """
    tangential = tangential_directions(contacts.d1, contacts.d2, contacts.mu_v)
    return np.concatenate([tangential, torsional_directions(contacts.mu_omega)], axis=1)


def friction_rows(contacts: Contacts) -> Array:
    """The rows [J'(n~ + d~_i)]' of Eq. (4), all six of each contact.

    Returns
    -------
    ndarray, shape (n_c, 6, n_v)
        [m] per unit of delta_q. Contacts without torsion use the first four only.
    """
    directions = normal_direction(contacts.n)[:, None, :] + pyramid(contacts)
    return directions @ contacts.J  # Eq. (4)


def contact_wrenches(contacts: Contacts, lam: Array, h: float) -> Array:
    """Contact wrenches from the multipliers: their combination of n~ + d~_i, divided by h.

    Parameters
    ----------
    contacts : Contacts
    lam : ndarray, shape (m,)
        Multipliers, contact-major [N s].
    h : float
        Time step [s].

    Returns
    -------
    ndarray, shape (n_c, 4)
        (f_d1, f_d2, f_n, tau_n) on beta's body [N, N m]; the torque is taken through beta.
    """
    impulses = np.zeros((contacts.n_c, 6))
    impulses[contacts.mask] = lam
    f_d1 = contacts.mu_v * (impulses[:, 0] - impulses[:, 2])
    f_d2 = contacts.mu_v * (impulses[:, 1] - impulses[:, 3])
    tau_n = contacts.mu_omega * (impulses[:, 4] - impulses[:, 5])
    return np.stack([f_d1, f_d2, impulses.sum(axis=1), tau_n], axis=1) / h
