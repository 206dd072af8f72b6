"""Contact Jacobians, Eqs. :eq:`eq-2`-:eq:`eq-3`, and the contacts of a step."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from quasistatic_ref.contact.distance import ClosestPoints
from quasistatic_ref.contact.pairs import ContactLayout
from quasistatic_ref.errors import ContactError
from quasistatic_ref.model.motion import Motion, cross_matrix
from quasistatic_ref.model.system import Kinematics
from quasistatic_ref.step.data import Array, Contacts

AXES = np.eye(3)


class ContactGeometry:
    """Contacts of the same links at every step.

    Parameters
    ----------
    layout : ContactLayout
        Which links the points belong to; 0 is the world.
    motion : Motion
        How the links move.
    """

    def __init__(self, layout: ContactLayout, motion: Motion) -> None:
        self.layout, self.motion = layout, motion
        # Of each contact, 1 for the columns that move its body and 0 for the others.
        self.moves_alpha = motion.moves[layout.link_alpha]
        self.moves_beta = motion.moves[layout.link_beta]

    def contacts(self, points: ClosestPoints, kinematics: Kinematics) -> Contacts:
        """The contacts of one step, from the closest points of all pairs.

        Parameters
        ----------
        points : ClosestPoints
        kinematics : Kinematics
            At the same configuration.
        """
        phi, n, layout = points.phi, points.n, self.layout
        d1, d2 = tangents(n)
        J = self.jacobian(kinematics.columns, points.alpha, points.beta, n)
        names = layout.contact_names(points.point)
        return Contacts(names, phi, n, d1, d2, J, layout.mu_v, layout.mu_omega, layout.rows)

    def jacobian(self, columns: Array, alpha: Array, beta: Array, n: Array) -> Array:
        """J of Eq. :eq:`eq-3`: relative velocity and spin, Eq. :eq:`eq-2`, per unit of delta_q.

        Parameters
        ----------
        columns : ndarray, shape (6, n_x)
            As in :class:`~quasistatic_ref.model.kinematics.Kinematics` [m, rad].
        alpha, beta : ndarray, shape (n_c, 3)
            Material points of the two bodies [m], world frame.
        n : ndarray, shape (n_c, 3)
            Unit normals, world frame.

        Returns
        -------
        ndarray, shape (n_c, 4, n_v)
            Rows 0-2: nu_beta - nu_alpha [m], world frame; row 3: n'(omega_beta - omega_alpha)
            [rad].
        """
        nu_alpha, spin_alpha = velocity_and_spin(self.moves_alpha * columns, alpha, n)
        nu_beta, spin_beta = velocity_and_spin(self.moves_beta * columns, beta, n)
        f = np.concatenate([nu_beta - nu_alpha, spin_beta - spin_alpha], axis=1)  # Eq. (2)
        return self.motion.of_coordinates(f)  # Eq. (3)


def velocity_and_spin(twist: Array, r: Array, n: Array) -> tuple[Array, Array]:
    """Velocity of a body's point r, and the body's spin about n.

    Parameters
    ----------
    twist : ndarray, shape (n_c, 6, n_x)
        Velocity of the body's point at the world's origin, then its angular velocity omega, per
        unit of each coordinate [m, rad].
    r, n : ndarray, shape (n_c, 3)
        Point [m] and unit vector [-], world frame.

    Returns
    -------
    nu : ndarray, shape (n_c, 3, n_x)
        nu_origin + omega x r [m].
    spin : ndarray, shape (n_c, 1, n_x)
        n'omega [rad].
    """
    of_twist = np.zeros((len(r), 4, 6))
    of_twist[:, :3, :3] = AXES  # nu_origin
    of_twist[:, :3, 3:] = -cross_matrix(r)  # omega x r = -[r x] omega
    of_twist[:, 3, 3:] = n  # n'omega
    both = of_twist @ twist
    return both[:, :3], both[:, 3:]


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
    along = (n * axis).sum(axis=1, keepdims=True)
    length = np.sqrt(1 - along * along)  # of axis - along n, and of n x axis
    n_cross_axis = (cross_matrix(n) @ axis[:, :, None])[:, :, 0]
    return (axis - along * n) / length, n_cross_axis / length


def contact_jacobian(
    kinematics: Kinematics,
    link_alpha: NDArray[np.int64],
    link_beta: NDArray[np.int64],
    alpha: Array,
    beta: Array,
    n: Array,
) -> Array:
    """J of Eq. :eq:`eq-3` between any links: `link_alpha`, `link_beta` in arrays (n_c,)."""
    nothing = np.zeros(len(n))
    names = ("",) * len(n)
    layout = ContactLayout(names, link_alpha, link_beta, nothing, nothing, link_alpha)
    return _geometry(layout, kinematics).jacobian(kinematics.columns, alpha, beta, n)


def contacts(layout: ContactLayout, points: ClosestPoints, kinematics: Kinematics) -> Contacts:
    """The contacts of one step, for once."""
    return _geometry(layout, kinematics).contacts(points, kinematics)


def _geometry(layout: ContactLayout, kinematics: Kinematics) -> ContactGeometry:
    if kinematics.motion is None:
        raise ContactError("of links that do not move has no Jacobian", field="kinematics")
    return ContactGeometry(layout, kinematics.motion)
