"""Short lists of several clouds, measured by few NumPy calls, and the proof that they suffice."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from quasistatic_ref.contact.cloud import closest
from quasistatic_ref.contact.poses import PairPoses
from quasistatic_ref.contact.shortlist import Shortlist
from quasistatic_ref.contact.solid_rows import SolidRows
from quasistatic_ref.model.shapes import Shape
from quasistatic_ref.step.data import Array
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
    point: NDArray[np.int64]
    proved: NDArray[np.bool_]


class Batch:
    """Lists that are measured at once: rows as long as the longest, filled up with NaN.

    In memory, rows follow each other, x, y and z apart, after the corners of the boxes around the
    clouds.

    Parameters
    ----------
    rows : sequence of int, length r
        Which of all pairs these are.
    shapes : sequence of Shape
        Their solids, in :func:`~quasistatic_ref.contact.solid_rows.kind_order`.
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
        self.n_c, self.first = np.array(n_c), self.r * CORNERS
        filled, self.index = np.full((self.r, W, 3), np.nan), np.full((self.r, W), -1)
        for i, (some, made) in enumerate(zip(points, lists, strict=True)):
            filled[i, : len(some)], self.index[i, : len(some)] = some, made.index
        self.local = np.ascontiguousarray(filled.reshape(-1, 3).T)
        self.columns = np.ones((4, 3, self.first + self.r * W))
        self.columns[:3] = np.concatenate([np.concatenate(boxes).T, self.local], axis=1)[:, None]
        self.of = np.concatenate([np.repeat(rows, CORNERS), np.repeat(rows, W)])
        self.measured = SolidRows(shapes, W)
        # Where in the sorted rows the contacts are: in each from its start, by rank.
        self.start = np.repeat(np.arange(self.r) * W, n_c)
        self.ranked = self.start + np.concatenate([np.arange(n) for n in n_c])
        self.furthest = np.cumsum(n_c) - 1
        self.corners = np.concatenate([made.corners for made in lists]).T.copy()
        self.n = np.repeat([made.n for made in lists], CORNERS, axis=0).T.copy()
        self.bounds = np.array([[m.by_height for m in lists], [m.by_distance for m in lists]])

    def nearest(self, poses: PairPoses) -> Nearest:
        """The closest points at the poses of all pairs."""
        pose = np.concatenate([poses.R_rel, poses.t_rel[..., None]], axis=2)
        # The sums of `rotated`, without broadcasting, which takes longer than the sums.
        term = pose.T.take(self.of, axis=2) * self.columns
        x = term[0] + term[1] + term[2] + term[3]
        phi, normal = self.measured(x[:, self.first :].T)
        if self.r == 1:
            found = closest(phi, int(self.n_c[0]))
        else:
            order = phi.reshape(self.r, -1).argsort(axis=1, kind="stable")
            found = order.ravel().take(self.ranked) + self.start
        distance = phi.take(found)
        proved = distance.take(self.furthest) < self.limit(x[:, : self.first])
        return Nearest(
            distance,
            normal.T.take(found, axis=1),
            self.local.take(found, axis=1),
            self.index.take(found),
            proved,
        )

    def limit(self, corners: Array) -> Array:
        """Below which signed distances (r,) [m] no point outside the lists can have come.

        Parameters
        ----------
        corners : ndarray, shape (3, 8 r)
            Where the corners are now, in the frames of the solids [m].
        """
        u = corners - self.corners
        along, moved = u * self.n, np.abs(u)
        least = np.concatenate(
            [
                along[0] + along[1] + along[2],
                -_SQRT_3 * np.maximum(np.maximum(moved[0], moved[1]), moved[2]),
            ]
        )
        change = np.minimum.reduce(least.reshape(2, -1, CORNERS), axis=2)
        bounds = self.bounds + change
        # Rounding grows with the distance moved as it does with the sizes.
        return np.asarray(np.minimum(bounds[0], bounds[1]) + UNSEEN * change[1])
