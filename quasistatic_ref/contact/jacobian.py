"""Contact Jacobians, Eqs. (2)-(3), and the contacts of a step."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from quasistatic_ref.contact.distance import ClosestPoints
from quasistatic_ref.contact.pairs import ContactLayout
from quasistatic_ref.model.motion import cross_matrix
from quasistatic_ref.model.system import Kinematics
from quasistatic_ref.step.data import Array, Contacts

AXES = np.eye(3)


def contact_jacobian(
    kinematics: Kinematics,
    link_alpha: NDArray[np.int64],
    link_beta: NDArray[np.int64],
    alpha: Array,
    beta: Array,
    n: Array,
) -> Array:
    """J of Eq. (3): relative velocity and spin, Eq. (2), per unit of delta_q.

    Parameters
    ----------
    kinematics : Kinematics
        Poses and Jacobians of the links.
    link_alpha, link_beta : ndarray of int, shape (n_c,)
        Which links the points belong to; 0 is the world.
    alpha, beta : ndarray, shape (n_c, 3)
        Material points of the two bodies [m], world frame.
    n : ndarray, shape (n_c, 3)
        Unit normals, world frame.

    Returns
    -------
    ndarray, shape (n_c, 4, n_v)
        Rows 0-2: nu_beta - nu_alpha [m], world frame; row 3: n'(omega_beta - omega_alpha) [rad].
    """
    n_c, motion = len(n), kinematics.motion
    r = np.concatenate([alpha, beta])
    wrenches = np.zeros((2 * n_c, 4, 6))
    wrenches[:, :3, :3] = AXES
    wrenches[:, :3, 3:] = cross_matrix(r).transpose(0, 2, 1)  # nu_origin + omega x r
    wrenches[:n_c, 3, 3:] = wrenches[n_c:, 3, 3:] = n
    moved = (wrenches.reshape(-1, 6) @ kinematics.columns).reshape(2 * n_c, 4, -1)
    moved *= motion.moves.take(np.concatenate([link_alpha, link_beta]), axis=0)
    return motion.of_coordinates(moved[n_c:] - moved[:n_c])  # Eqs. (2)-(3)


def tangents(n: Array) -> tuple[Array, Array]:
    """Tangents d1, d2 such that {d1, d2, n} is dextral: a fixed function of n.

    d1 is the projection of the world axis that is farthest from n (the least index on a tie),
    normalised; d2 = n x d1. For n along z: d1 along x, d2 along y.

    Parameters
    ----------
    n : ndarray, shape (n_c, 3)
        Unit normals.

    Returns
    -------
    d1, d2 : ndarray, shape (n_c, 3)
    """
    every, k = np.arange(len(n)), np.abs(n).argmin(axis=1)
    n_k = n[every, k][:, None]
    length = np.sqrt(1 - n_k * n_k)
    d1 = (AXES.take(k, axis=0) - n_k * n) / length
    return d1, cross_matrix(n)[every, :, k] / length  # n x d1 = n x axis / length


def contacts(
    layout: ContactLayout,
    points: ClosestPoints,
    kinematics: Kinematics,
    like: Contacts | None = None,
) -> Contacts:
    """The contacts of one step, from the closest points of all pairs.

    Parameters
    ----------
    layout : ContactLayout
        Of the pairs that the points belong to.
    points : ClosestPoints
    kinematics : Kinematics
        At the same configuration.
    like : Contacts, optional
        Those of an earlier step: of the same layout, so that it is not checked again.

    Returns
    -------
    Contacts
    """
    phi, n = points.phi, points.n
    d1, d2 = tangents(n)
    J = contact_jacobian(
        kinematics, layout.link_alpha, layout.link_beta, points.alpha, points.beta, n
    )

    def name() -> tuple[str, ...]:
        numbered = zip(layout.names, points.point.tolist(), strict=True)
        return tuple([f"{pair}/{i}" for pair, i in numbered])

    if like is not None:
        return like.moved(name, phi=phi, n=n, d1=d1, d2=d2, J=J)
    mu_v, mu_omega, rows = layout.mu_v, layout.mu_omega, layout.rows
    return Contacts(name(), phi, n, d1, d2, J, mu_v, mu_omega, rows)
