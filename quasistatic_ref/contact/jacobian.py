"""Contact Jacobians, Eqs. :eq:`eq-2`-:eq:`eq-3`, and the contacts of a step."""

from __future__ import annotations

from functools import cache

import numpy as np
from numpy.typing import NDArray

from quasistatic_ref.contact.distance import ClosestPoints
from quasistatic_ref.contact.pairs import ContactLayout
from quasistatic_ref.errors import ContactError
from quasistatic_ref.model.motion import OF_VECTOR, Motion
from quasistatic_ref.model.system import Kinematics
from quasistatic_ref.step.data import Array, Contacts

AXES = np.eye(3)
MINUS_CROSS = -OF_VECTOR
"""r @ MINUS_CROSS are the entries of -[r x], row by row."""

CROSS_AXES = -OF_VECTOR
"""n @ CROSS_AXES are n x (axis i), one after the other: the rows of -[n x]."""


class ContactGeometry:
    """Contacts of the same links at every step, in arrays that are kept.

    Parameters
    ----------
    layout : ContactLayout
        Which links the points belong to; 0 is the world.
    motion : Motion
        How the links move.
    """

    def __init__(self, layout: ContactLayout, motion: Motion) -> None:
        self.layout, self.motion, self.n_c = layout, motion, len(layout.names)
        self.moves = motion.moves[np.stack([layout.link_alpha, layout.link_beta])]
        # Of alpha's points, then beta's: velocity (rows 0-2) and spin (row 3) of a twist.
        self.of_twist = np.zeros((2, self.n_c, 4, 6))
        self.of_twist[:, :, :3, :3] = AXES

    def contacts(
        self, points: ClosestPoints, kinematics: Kinematics, like: Contacts | None = None
    ) -> Contacts:
        """The contacts of one step, from the closest points of all pairs.

        Parameters
        ----------
        points : ClosestPoints
        kinematics : Kinematics
            At the same configuration.
        like : Contacts, optional
            Those of an earlier step: these are then not checked again.
        """
        phi, n, layout = points.phi, points.n, self.layout
        d1, d2 = tangents(n)
        J = self.jacobian(kinematics.columns, points.alpha, points.beta, n)

        def name() -> tuple[str, ...]:
            numbered = zip(layout.names, points.point.tolist(), strict=True)
            return tuple([f"{pair}/{i}" for pair, i in numbered])

        if like is not None:
            return like.moved(name, phi=phi, n=n, d1=d1, d2=d2, J=J)
        return Contacts(name(), phi, n, d1, d2, J, layout.mu_v, layout.mu_omega, layout.rows)

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
        n_c, of_twist = self.n_c, self.of_twist
        r = np.concatenate([alpha, beta])
        of_twist[:, :, :3, 3:] = (r @ MINUS_CROSS).reshape(2, n_c, 3, 3)  # nu_origin + omega x r
        of_twist[:, :, 3, 3:] = n
        moved = (of_twist.reshape(-1, 6) @ columns).reshape(2, n_c, 4, columns.shape[1])
        moved *= self.moves
        return self.motion.of_coordinates(moved[1] - moved[0])  # Eqs. (2)-(3)


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
    axis = np.abs(n).argmin(axis=1)
    at = _starts(len(n)) + axis
    n_axis = n.take(at)[:, None]
    both = np.empty((2, *n.shape))
    np.subtract(AXES.take(axis, axis=0), n_axis * n, out=both[0])
    both[1] = (n @ CROSS_AXES).reshape(-1, 3).take(at, axis=0)  # n x axis
    both /= np.sqrt(1 - n_axis * n_axis)  # the length of both
    return both[0], both[1]


@cache
def _starts(n: int) -> NDArray[np.int64]:
    return np.arange(0, 3 * n, 3)


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
