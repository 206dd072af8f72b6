"""Contact Jacobians, Eqs. :eq:`eq-2`-:eq:`eq-3`, and the contacts of a step."""

from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from quasistatic_ref.contact.closest_points import ClosestPoints
from quasistatic_ref.contact.pairs import ContactLayout
from quasistatic_ref.model.column_map import JacobianColumns
from quasistatic_ref.model.system import Kinematics
from quasistatic_ref.numbers.arrays import Array, Indices, Scalar, read_only
from quasistatic_ref.numbers.ordered import crossed, dot
from quasistatic_ref.step.contacts import Contacts, friction_coefficients

AXES = np.eye(3)


class ContactGeometry:
    """Jacobians of contacts between fixed links, by the coordinates that can move each contact.

    Parameters
    ----------
    layout : ContactLayout
        Which links the points belong to; 0 is the world.
    column_map : JacobianColumns
        How the links move.

    Attributes
    ----------
    column : ndarray of int, shape (n_c, w)
        The coordinates that can move each contact, ascending; n_v where it has fewer.
    n_x : int
        Number of columns of ``Kinematics``.
    joint : ndarray of int, shape (n_c, x)
        The columns of ``Kinematics`` that can.
    sides : list of (str, float, ndarray)
        Of beta's and alpha's body, if it can move: its sign in J, and whether each column moves it,
        shape (n_c, 1, x) [-].
    sums : list
        Which columns are added to which coordinates; none where each is of one.
    """

    def __init__(self, layout: ContactLayout, column_map: JacobianColumns) -> None:
        self.layout = layout
        self.n_v = column_map.n_v
        self.n_x = column_map.moves.shape[-1]
        links = np.stack([layout.link_alpha, layout.link_beta])
        moves = column_map.moves[:, 0] > 0
        # The columns of pinocchio's or MuJoCo's Jacobian that move a contact, by coordinates.
        x, v, share = column_map.shares
        of_x = padded(x, v, moves.shape[1], self.n_v)
        link, column = np.nonzero(moves)
        of_link = padded(link, column, len(moves), -1)
        movers = of_link[links].transpose(1, 0, 2).reshape(len(layout.rows), 2 * of_link.shape[1])
        at, k = np.nonzero(movers >= 0)
        # Without repeats, as np.unique, which would import NumPy's masked arrays for this alone.
        every = np.sort(at * self.n_x + movers[at, k])
        every = every[np.diff(every, prepend=-1) > 0]
        contact, mover = np.divmod(every, max(self.n_x, 1))
        some = np.lexsort((of_x[mover].min(axis=1, initial=self.n_v), contact))
        joint = padded(contact, mover[some], len(layout.rows), -1)
        self.joint = np.maximum(joint, 0)
        self.sides = []  # beta's, then alpha's, if any column moves it
        for name, sign, link in (
            ("beta", 1.0, layout.link_beta),
            ("alpha", -1.0, layout.link_alpha),
        ):
            moved = moves[link[:, None], self.joint] & (joint >= 0)
            if moved.any():
                self.sides.append((name, sign, moved[:, None] * 1.0))
        # A column mostly moves with one coordinate, as much as that.
        of_joint = np.where(joint[..., None] >= 0, of_x[self.joint], self.n_v)
        coordinate: Indices = of_joint.reshape(len(joint), joint.shape[1] * of_x.shape[1])
        ascending = np.sort(coordinate, axis=1)
        c, k = np.nonzero((np.diff(ascending, axis=1, prepend=-1) > 0) & (ascending < self.n_v))
        self.column = read_only(padded(c, ascending[c, k], len(joint), self.n_v))
        self.sums: list[tuple[Indices, Indices, Indices, Array]] = []
        if not ((share == 1).all() and np.array_equal(self.column, coordinate)):
            c, t = np.nonzero(coordinate < self.n_v)
            place = (self.column[c] < coordinate[c, t, None]).sum(axis=1)
            shares = padded(x, share, moves.shape[1], 0.0)[self.joint].reshape(coordinate.shape)
            same = coordinate[c] == coordinate[c, t, None]
            turn = (same & (np.arange(coordinate.shape[1]) < t[:, None])).sum(axis=1)
            for i in range(turn.max(initial=-1) + 1):
                at = turn == i
                k = t[at] // of_x.shape[1]
                self.sums.append((c[at], place[at], k, shares[c, t][at, None]))

    def contacts(self, points: ClosestPoints, kinematics: Kinematics) -> Contacts:
        """The contacts of one step, from the closest points of all pairs.

        They are right by construction, but for numbers that are not finite.

        Parameters
        ----------
        points : ClosestPoints
        kinematics : Kinematics
            At the same configuration.
        """
        d1, d2, own = self.frames(kinematics.columns, points.alpha, points.beta, points.n)
        phi = points.phi + 0.0  # zero is 0.0, never -0.0
        n = points.n + 0.0
        for array in (phi, n, d1, d2, own):
            read_only(array)
        return self.contacts_of(points.point, phi, n, d1, d2, own)

    def contacts_of(
        self,
        point: Indices,
        phi: Array,
        n: Array,
        d1: Array,
        d2: Array,
        own: Array,
        pyramid: tuple[Array, Array] | None = None,
    ) -> Contacts:
        """The contacts of numbered points, (n_c,), from arrays that are theirs.

        Their rows in the `pyramid` may be known. Shapes, phi (n_c,), n, d1 and d2 (n_c, 3), own
        (n_c, 4, w), and units [m, -, m and rad] are those of
        :class:`~quasistatic_ref.step.contacts.Contacts`.
        """
        layout = self.layout
        return Contacts.unchecked(
            name=layout.contact_names(point),
            phi=phi,
            n=n,
            d1=d1,
            d2=d2,
            own=own,
            pyramid=pyramid,
            column=self.column,
            n_v=self.n_v,
            mu_v=layout.mu_v,
            mu_omega=layout.mu_omega,
            rows=layout.rows,
            mu=self.mu,
        )

    @cached_property
    def mu(self) -> Array:
        """Coefficients of friction, shape (n_c, 3), as of :class:`.Contacts` [-, -, m]."""
        layout = self.layout
        return friction_coefficients(layout.mu_v, layout.mu_omega, layout.rows)

    def frames(
        self, columns: Array, alpha: Array, beta: Array, n: Array
    ) -> tuple[Array, Array, Array]:
        """Tangents d1 and d2, (n_c, 3), and J, of the arguments of :meth:`jacobian`.

        `columns`, shape (6, n_x) [m, rad], are those of the links' joints.
        """
        d1, d2 = tangents(n)
        return d1 + 0.0, d2, self.jacobian(columns, alpha, beta, n)

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
        ndarray, shape (n_c, 4, w)
            The columns of each contact's ``column``. Rows 0-2: nu_beta - nu_alpha [m], world frame;
            row 3: n'(omega_beta - omega_alpha) [rad].
        """
        points = {"alpha": alpha, "beta": beta}
        own = columns.T[self.joint].transpose(0, 2, 1)  # (n_c, 6, w)
        J = np.zeros((len(n), 4, own.shape[2]))
        for name, sign, moved in self.sides:
            J += sign * (moved * columns_at(own, points[name], n))  # Eq. (2)
        if self.sums:  # a joint that mimics another moves with its coordinate
            summed = np.zeros((len(n), 4, self.column.shape[1]))
            for c, place, k, share in self.sums:
                summed[c, :, place] += share * J[c, :, k]
            J = summed
        return J + 0.0  # Eq. (3); zero is 0.0, never -0.0


def padded(row: Indices, value: NDArray[Scalar], rows: int, none: float) -> NDArray[Scalar]:
    """Values by rows, each from the left, in an array filled up with `none`: shape (rows, w).

    `value` (k,) and `none` have any unit [that of the array].

    Parameters
    ----------
    row : ndarray of int, shape (k,)
        Ascending.
    value : ndarray, shape (k,) [any unit]
    rows : int
    none : int or float [any unit]
    """
    count = np.bincount(row, minlength=rows)
    array = np.full((rows, int(count.max(initial=0))), none, value.dtype)
    array[row, np.arange(len(row)) - (np.cumsum(count) - count)[row]] = value
    return array


def columns_at(columns: Array, r: Array, n: Array) -> Array:
    """Velocity of points, and spin about unit vectors, of bodies that every column moves.

    Parameters
    ----------
    columns : ndarray, shape (6, n_x), or (..., 6, n_x) of each point
        Velocity of a body's point at the world's origin, then its angular velocity omega, per unit
        of each coordinate [m, rad].
    r, n : ndarray, shapes (..., 3)
        Points [m] and unit vectors [-], world frame.

    Returns
    -------
    ndarray, shape (..., 4, n_x)
        Rows 0-2: nu_origin + omega x r [m]; row 3: n'omega [rad].
    """
    nu_origin = columns[..., :3, :]
    omega = columns[..., 3:, :]
    J = np.empty((*r.shape[:-1], 4, columns.shape[-1]))
    J[..., :3, :] = nu_origin + crossed(omega, r[..., None], axis=-2)  # Eq. (2)
    J[..., 3, :] = dot(n[..., None, :], omega.swapaxes(-1, -2))
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
