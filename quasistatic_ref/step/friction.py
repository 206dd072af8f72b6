r"""Directions of contact and friction: the paper's, Eqs. :eq:`eq-5`-:eq:`eq-7`, and other cones'.

For each contact the rows forbid that the motion J delta_q leaves the dual of the friction
cone. Their multipliers add up to a wrench inside the cone, which of the paper's pyramid is

.. math:: |f_1|/\mu_v + |f_2|/\mu_v + |\tau_n|/\mu_\omega \le f_n,

an octahedron: the rows of a contact share one normal force. Each function below that returns d~
states the limit surface of its cone; a term whose coefficient is zero means that its force is zero.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from quasistatic_ref.step.cones import ELLIPSOID, PYRAMID, cone
from quasistatic_ref.step.data import Array, Contacts


def normal_direction(n: Array) -> Array:
    """n~ = [n, 0] of Eq. :eq:`eq-4`.

    Parameters
    ----------
    n : ndarray, shape (n_c, 3)
        Unit normals, world frame.

    Returns
    -------
    ndarray, shape (n_c, 4)
    """
    n_tilde = np.zeros((len(n), 4))
    n_tilde[:, :3] = n
    return n_tilde


def tangential_directions(d1: Array, d2: Array, mu_v: Array) -> Array:
    """d~_1 .. d~_4 of Eqs. :eq:`eq-5`-:eq:`eq-6`: the tangential friction pyramid.

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
    d_tilde = np.zeros((len(mu_v), 4, 4))
    d_tilde[:, 0, :3] = mu_v[:, None] * d1  # Eq. (5)
    d_tilde[:, 1, :3] = mu_v[:, None] * d2  # Eq. (5)
    d_tilde[:, 2:] = -d_tilde[:, :2]  # Eq. (6)
    return d_tilde


def torsional_directions(mu_omega: Array) -> Array:
    """d~_5, d~_6 of Eq. :eq:`eq-7`: torsional friction about the normal.

    Parameters
    ----------
    mu_omega : ndarray, shape (n_c,)
        Torsional friction coefficient, a length [m].

    Returns
    -------
    ndarray, shape (n_c, 2, 4)
    """
    d_tilde = np.zeros((len(mu_omega), 2, 4))
    d_tilde[:, 0, 3], d_tilde[:, 1, 3] = mu_omega, -mu_omega  # Eq. (7)
    return d_tilde


def pyramid(contacts: Contacts) -> Array:
    """All six d~ of the paper, Eqs. :eq:`eq-5`-:eq:`eq-7`.

    Their limit surface is |f_1|/mu_v + |f_2|/mu_v + |tau|/mu_omega <= f_n.

    Returns
    -------
    ndarray, shape (n_c, 6, 4)
        In the paper's order: +d1, +d2, -d1, -d2, +spin, -spin.
    """
    tangential = tangential_directions(contacts.d1, contacts.d2, contacts.mu_v)
    return np.concatenate([tangential, torsional_directions(contacts.mu_omega)], axis=1)


def product(contacts: Contacts) -> Array:
    """d~ of |f_1|/mu_v + |f_2|/mu_v <= f_n and |tau|/mu_omega <= f_n, independent of each other.

    Returns
    -------
    ndarray, shape (n_c, 8, 4)
        +d1, +d2, -d1, -d2, each with +spin, then each with -spin. Where ``rows`` is 4 there is
        no spin in them, and the last four say nothing new.
    """
    return _of_table(contacts, "product")


def facets(contacts: Contacts, name: str) -> Array:
    """d~ of a K-sided tangential pyramid: ||(f_1, f_2)||_K / mu_v + |tau|/mu_omega <= f_n.

    ||.||_K is the gauge of the regular polygon with corners on the unit circle, the first at d1:
    it is between the length and the length over cos(pi / K). K = 4 is the paper's cone, bit for
    bit. The corners' cosines and sines are data, rounded correctly to float64.

    Returns
    -------
    ndarray, shape (n_c, K + 2, 4)
        The sides counter-clockwise about n, then +spin, -spin.
    """
    return _of_table(contacts, name)


def frictionless(contacts: Contacts) -> Array:
    """The only d~ without friction, zero: f_1 = f_2 = tau = 0 <= f_n.

    Returns
    -------
    ndarray, shape (n_c, 1, 4)
    """
    return np.zeros((contacts.n_c, 1, 4))


CONES: dict[str, Callable[[Contacts], Array]] = {
    PYRAMID: pyramid,
    "product": product,
    "frictionless": frictionless,
}


def cone_directions(contacts: Contacts, name: str = PYRAMID) -> Array:
    """All d~ of a polyhedral cone, shape (n_c, R, 4)."""
    return CONES[name](contacts) if name in CONES else facets(contacts, name)


def friction_rows(contacts: Contacts, name: str = PYRAMID) -> Array:
    """The rows [J'(n~ + d~_i)]' of Eq. :eq:`eq-4`, all of each contact.

    Parameters
    ----------
    contacts : Contacts
    name : str
        The cone. The ellipsoid has no d~: its rows are the motion along n, d1, d2 and spin.

    Returns
    -------
    ndarray, shape (n_c, R, n_v)
        [m] per unit of delta_q. A contact uses those of ``StepData.mask``: with the paper's
        cone six, or the first four.
    """
    return rows_along(contacts, contacts.J, name)


def rows_along(contacts: Contacts, J: Array, name: str = PYRAMID) -> Array:
    """The same of any columns of J, shape (n_c, 4, w): all of them, or the blocks."""
    if name == ELLIPSOID:
        return np.asarray(_frames(contacts) @ J)
    n_tilde, d_tilde = normal_direction(contacts.n), cone_directions(contacts, name)
    return np.asarray((n_tilde[:, None] + d_tilde) @ J)  # Eq. (4)


def row_gaps(contacts: Contacts, name: str = PYRAMID) -> Array:
    """What the gap phi adds to each row [m]: all of it, but nothing along d1, d2 and spin.

    Returns
    -------
    ndarray, shape (n_c, R)
    """
    rows = len(cone(name).row_names)
    if name == ELLIPSOID:
        return np.asarray(contacts.phi[:, None] * np.eye(rows)[0])
    return np.asarray(contacts.phi.repeat(rows).reshape(-1, rows))


def friction_coefficients(contacts: Contacts) -> Array:
    """(mu_v, mu_v, mu_omega) of each contact, mu_omega being 0 where it is not used.

    Returns
    -------
    ndarray, shape (n_c, 3)
        [-], [-], [m].
    """
    return contacts.mu


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
        (f_d1, f_d2, f_n, tau_n) on beta's body [N, N m]; the torque is taken through beta.
    """
    if name == ELLIPSOID:
        return lam.reshape(-1, 4)[:, [1, 2, 0, 3]] / h
    counts = cone(name).counts(contacts.rows)
    impulses = np.zeros((contacts.n_c, len(cone(name).table)))
    impulses[np.arange(impulses.shape[1]) < counts[:, None]] = lam
    f_d1, f_d2, tau_n = (friction_coefficients(contacts) * (impulses @ cone(name).table)).T
    return np.stack([f_d1, f_d2, impulses.sum(axis=1), tau_n], axis=1) / h


def _frames(contacts: Contacts) -> Array:
    """Return n~, d1, d2 and spin of each contact, shape (n_c, 4, 4)."""
    frames = np.zeros((contacts.n_c, 4, 4))
    frames[:, 0, :3], frames[:, 1, :3], frames[:, 2, :3] = contacts.n, contacts.d1, contacts.d2
    frames[:, 3, 3] = 1.0
    return frames


def _of_table(contacts: Contacts, name: str) -> Array:
    """Return d~_i = mu_v (t_i1 d1 + t_i2 d2) + mu_omega t_i3 spin, shape (n_c, R, 4)."""
    axes = friction_coefficients(contacts)[:, :, None] * _frames(contacts)[:, 1:]
    return cone(name).table @ axes
