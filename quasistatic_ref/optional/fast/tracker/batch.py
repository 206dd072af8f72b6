"""Short lists of several clouds, measured by few NumPy calls, and the proof that they suffice."""

from collections.abc import Sequence
from operator import methodcaller
from typing import NamedTuple

import numpy as np

from quasistatic_ref.contact.cloud import closest
from quasistatic_ref.contact.poses import PairPoses
from quasistatic_ref.optional.fast.tracker.solid_rows import SolidRows
from quasistatic_ref.optional.fast.tracker.tracker_bound import Shortlist
from quasistatic_ref.shapes.placed_shape import Shape
from quasistatic_ref.step.data import Array, Indices, Mask
from quasistatic_ref.step.ordered import total
from quasistatic_ref.tolerances import UNSEEN

CORNERS = 8
_SQRT_3 = float(np.nextafter(np.sqrt(3.0), 2.0))


class Nearest(NamedTuple):
    """The k closest points of each list, list after list, in ascending distance.

    Parameters
    ----------
    phi : ndarray, shape (n,)
        [m].
    normal : ndarray, shape (3, n)
        In the frames of the solids.
    local : ndarray, shape (3, n)
        The points in the frames of their clouds [m].
    point : ndarray of int, shape (n,)
        Their indices.
    proved : ndarray of bool, shape (rows,)
        Of each list, whether no point outside it can be among them.
    """

    phi: Array
    normal: Array
    local: Array
    point: Indices
    proved: Mask

    def chosen(self, order: Indices) -> "Nearest":
        """The same contacts in another order, shape (k,)."""
        phi, normal, local, point = map(methodcaller("take", order, axis=-1), self[:-1])
        return Nearest(phi, normal, local, point, self.proved)


class Batch:
    """Lists that are measured at once: rows as long as the longest, filled up with NaN.

    In memory, rows follow each other, x, y and z apart, after the corners of the boxes around the
    clouds.

    Parameters
    ----------
    rows : sequence of int, length r
        Which of all pairs these are.
    shapes : sequence of Shape
        Their solids, in :func:`~quasistatic_ref.optional.fast.tracker.solid_rows.kind_order`.
    lists : sequence of Shortlist
    points : sequence of ndarray, shape (m, 3)
        The points of each list [m], cloud's frame.
    boxes : sequence of ndarray, shape (8, 3)
        Corners of the boxes around the clouds, in their frames [m].
    n_c : sequence of int
        How many of the closest points of each are kept.
    """

    def __init__(
        self,
        rows: Sequence[int],
        shapes: Sequence[Shape],
        lists: Sequence[Shortlist],
        points: Sequence[Array],
        boxes: Sequence[Array],
        n_c: Sequence[int],
    ) -> None:
        self.r, W = len(rows), max(len(some) for some in points)
        self.n_c = np.array(n_c)
        filled, self.index = np.full((self.r, W, 3), np.nan), np.full((self.r, W), -1)
        for i, (some, made) in enumerate(zip(points, lists, strict=True)):
            filled[i, : len(some)], self.index[i, : len(some)] = some, made.index
        self.local = np.ascontiguousarray(filled.reshape(-1, 3).T)
        self.columns = np.ones((4, 3, self.r * W))
        self.columns[:3] = self.local[:, None]
        self.rows, self.of = np.array(rows), np.repeat(rows, W)
        self.measured = SolidRows(shapes, W)
        # Where in the sorted rows the contacts are: in each from its start, by rank.
        self.start = np.repeat(np.arange(self.r) * W, n_c)
        self.ranked = self.start + np.concatenate([np.arange(n) for n in n_c])
        self.furthest = np.cumsum(n_c) - 1
        of_lists = [bounds(made, box) for made, box in zip(lists, boxes, strict=True)]
        self.slope = np.array([slope for slope, _ in of_lists])
        self.offset = np.array([offset for _, offset in of_lists])

    def nearest(self, poses: PairPoses) -> Nearest:
        """The closest points at the poses of all pairs."""
        return self.selection(*self.distances(poses))

    def distances(self, poses: PairPoses) -> tuple[Array, Array, Array]:
        """What is measured of all points of the lists; NaN where a row is shorter.

        Returns
        -------
        phi : ndarray, shape (r W,)
            Signed distances [m].
        normal : ndarray, shape (r W, 3)
            Unit normals in the frames of the solids [-].
        limit : ndarray, shape (r,)
            As :meth:`limit` has it [m].
        """
        pose = poses.relative
        # The sums of `rotated`, without broadcasting, which takes longer than the sums.
        x = total(pose.T.take(self.of, axis=2) * self.columns)
        phi, normal = self.measured(x.T)
        return phi, normal, self.limit(pose)

    def selection(self, phi: Array, normal: Array, limit: Array) -> Nearest:
        """The closest of the points whose :meth:`distances` these are.

        Parameters
        ----------
        phi, normal, limit : ndarray, shapes (r W,), (r W, 3) and (r,)
            [m], [-] and [m].
        """
        if self.r == 1:  # its own order is the order
            found = closest(phi, int(self.n_c[0]))
        else:
            order = phi.reshape(self.r, -1).argsort(axis=1, kind="stable")
            found = order.ravel().take(self.ranked) + self.start
        distance = phi.take(found)
        proved = distance.take(self.furthest) < limit
        n, local = normal.T.take(found, axis=1), self.local.take(found, axis=1)
        return Nearest(distance, n, local, self.index.take(found), proved)

    def reorder(self, order: Indices) -> None:
        """Give the contacts in another order (r,) from now on: entry i was number order[i]."""
        self.ranked, self.start = self.ranked[order], self.start[order]
        self.furthest = np.argsort(order)[self.furthest]

    def limit(self, pose: Array) -> Array:
        """Below which signed distances (r,) [m] no point outside the lists can have come.

        Parameters
        ----------
        pose : ndarray, shape (P, 3, 4)
            [R, t] of all pairs, from the cloud's frame to the solid's.
        """
        own = pose.reshape(-1, 12, 1)
        if len(own) != self.r:
            own = own[self.rows]
        limit: Array = np.minimum.reduce((self.slope @ own)[..., 0] + self.offset, axis=1)
        return limit


def bounds(made: Shortlist, box: Array) -> tuple[Array, Array]:
    """Functions of the pose, slope . [R, t] + offset [m], of which the least is a list's limit.

    Parameters
    ----------
    made : Shortlist
    box : ndarray, shape (8, 3)
        Corners of the box around the cloud, in its frame [m].

    Returns
    -------
    ndarray, shape (48 + 48, 12), and ndarray, shape (48 + 48,)

    Notes
    -----
    A point that moves by u has its height changed by n . u, its distance by |u| at most, and what
    is rounded by UNSEEN |u|. All these are concave in u, and u is affine in the point: over the
    box the least is at a corner. |u| <= sqrt(3) max |u_i| makes them linear.
    """
    ways = _SQRT_3 * np.concatenate([np.eye(3), -np.eye(3)])
    here = np.column_stack([box, np.ones(CORNERS)])
    by_height = made.n + UNSEEN * ways, made.by_height
    slopes, offsets = [], []
    for directions, bound in (by_height, ((1 + UNSEEN) * ways, made.by_distance)):
        slopes.append(np.einsum("ai,cj->acij", directions, here).reshape(-1, 12))
        offsets.append(bound - (directions @ made.corners.T).ravel())
    return np.concatenate(slopes), np.concatenate(offsets)
