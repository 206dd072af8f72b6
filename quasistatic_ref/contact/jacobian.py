"""Contact Jacobians, Eqs. :eq:`eq-2`-:eq:`eq-3`, and the contacts of a step."""

from typing import Final

import numpy as np

from quasistatic_ref.contact.distance import ClosestPoints
from quasistatic_ref.contact.pairs import ContactLayout
from quasistatic_ref.model.column_map import ColumnMap
from quasistatic_ref.model.system import Kinematics
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.numbers.ordered import YZX, ZXY, crossed, dot, product
from quasistatic_ref.step.contacts import Contacts

AXES = np.eye(3)
BLOCK: Final = 400_000
"""Most entries of J [-] that are formed at once: of 1000 bodies it has a hundred million."""


class ContactGeometry:
    """Jacobians of contacts between fixed links, prepared once for all steps.

    Parameters
    ----------
    layout : ContactLayout
        Which links the points belong to; 0 is the world.
    column_map : ColumnMap
        How the links move.
    """

    def __init__(self, layout: ContactLayout, column_map: ColumnMap) -> None:
        self.layout = layout
        self.column_map = column_map
        self.links = np.stack([layout.link_alpha, layout.link_beta])
        n_c = len(layout.link_alpha)
        # What is formed of a block of contacts stays in a processor's cache.
        count = max(1, BLOCK // (4 * column_map.moves.shape[-1] + 1))
        self.blocks = [slice(i, i + count) for i in range(0, n_c, count)]
        # 1 where a column of J moves alpha's (first) or beta's link, else 0; for each row of J.
        whole = len(self.blocks) == 1
        self.moves = np.repeat(column_map.moves[self.links], 4, axis=2) if whole else None

    def contacts(self, points: ClosestPoints, kinematics: Kinematics) -> Contacts:
        """The contacts of one step, from the closest points of all pairs. In C: rows.c.

        Parameters
        ----------
        points : ClosestPoints
        kinematics : Kinematics
            At the same configuration.
        """
        layout = self.layout
        d1, d2 = tangents(points.n)
        return Contacts(
            name=layout.contact_names(points.point),
            phi=points.phi,
            n=points.n,
            d1=d1,
            d2=d2,
            J=self.jacobian(kinematics.columns, points.alpha, points.beta, points.n),
            mu_v=layout.mu_v,
            mu_omega=layout.mu_omega,
            rows=layout.rows,
        )

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
        r = np.array([alpha, beta])
        if self.moves is not None:
            return self._of_block(self.moves, columns, r, n)
        J = np.empty((len(n), 4, self.column_map.n_v))
        for some in self.blocks:
            moves = self.column_map.moves[self.links[:, some]]
            J[some] = self._of_block(moves, columns, r[:, some], n[some])
        return J

    def _of_block(self, moves: Array, columns: Array, r: Array, n: Array) -> Array:
        """J of some contacts, of points r on both bodies, (2, k, 3) [m]."""
        # [nu; n'omega] of alpha's body and of beta's
        of_alpha, of_beta = moves * columns_at(columns, r, n)
        f = of_beta - of_alpha  # Eq. (2): nu_beta - nu_alpha and n'(omega_beta - omega_alpha)
        return self.column_map.of_coordinates(f) + 0.0  # Eq. (3); zero is 0.0, never -0.0


def columns_at(columns: Array, r: Array, n: Array) -> Array:
    """Velocity of points, and spin about unit vectors, of bodies that every column moves.

    Parameters
    ----------
    columns : ndarray, shape (6, n_x)
        Velocity of a body's point at the world's origin, then its angular velocity omega, per unit
        of each coordinate [m, rad].
    r, n : ndarray, shapes (..., 3)
        Points [m] and unit vectors [-], world frame.

    Returns
    -------
    ndarray, shape (..., 4, n_x)
        Rows 0-2: nu_origin + omega x r [m]; row 3: n'omega [rad].
    """
    nu_origin = columns[:3]
    omega = columns[3:]
    J = np.empty((*r.shape[:-1], 4, columns.shape[1]))
    r_yzx = r.take(YZX, axis=-1)[..., None]
    r_zxy = r.take(ZXY, axis=-1)[..., None]
    turning = omega.take(YZX, axis=0) * r_zxy - omega.take(ZXY, axis=0) * r_yzx
    np.add(nu_origin, turning, out=J[..., :3, :])
    J[..., 3, :] = product(n, omega)
    return J


def tangents(n: Array) -> tuple[Array, Array]:
    """Tangents d1, d2 such that {d1, d2, n} is right-handed: a fixed function of n.

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
    least = np.abs(n).argmin(axis=1)
    axis = AXES.take(least, axis=0)
    along = dot(n, axis)[:, None]
    length = np.sqrt(1 - along * along)  # of axis - along n, and of n x axis
    return (axis - along * n) / length, crossed(n, axis) / length + 0.0  # zero is 0.0
