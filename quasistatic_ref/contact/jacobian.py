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
    n_c = len(n)
    twist = kinematics.twist[np.concatenate([link_alpha, link_beta])]  # of the two bodies
    nu_origin, omega = twist[:, :3], twist[:, 3:]
    nu = nu_origin - cross_matrix(np.concatenate([alpha, beta])) @ omega  # nu + omega x r
    J = np.empty((n_c, 4, nu.shape[2]))
    np.subtract(nu[n_c:], nu[:n_c], out=J[:, :3])  # Eqs. (2)-(3)
    np.matmul(n[:, None, :], omega[n_c:] - omega[:n_c], out=J[:, 3:])
    return J


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
    axis = AXES[np.abs(n).argmin(axis=1)]
    d1 = axis - (axis * n).sum(axis=1, keepdims=True) * n
    d1 /= np.sqrt((d1 * d1).sum(axis=1, keepdims=True))
    return d1, (cross_matrix(n) @ d1[:, :, None])[:, :, 0]


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
    name = tuple([f"{pair}/{i}" for pair, i in zip(layout.names, points.point.tolist(), strict=True)])
    if like is not None:
        return like.moved(name, phi=phi, n=n, d1=d1, d2=d2, J=J)
    mu_v, mu_omega, rows = layout.mu_v, layout.mu_omega, layout.rows
    return Contacts(name, phi, n, d1, d2, J, mu_v, mu_omega, rows)
