"""The closest points of clouds on solids, followed from step to step.

The brute force measures every point at every step. Here a short list of each pair's points is
measured, with a proof at each step that no other point can be among the k closest, ties included;
where the proof fails, the list is made anew. docs/distances.md derives the bounds.
"""

from __future__ import annotations

from collections.abc import Sequence
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray

from quasistatic_ref.contact.ball_tree import BallTree, ball_tree
from quasistatic_ref.contact.distance import ClosestPoints, check_finite
from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.contact.poses import PairPoses, Placements, rotated
from quasistatic_ref.contact.proofs import CORNERS, Proofs
from quasistatic_ref.contact.shortlist import shortlist, size
from quasistatic_ref.contact.solid_rows import SolidRows, kind_order
from quasistatic_ref.model.shapes import PlacedShape, PointCloud
from quasistatic_ref.step.data import Array

WIDTH = 32
"""Points of a list to begin with; twice as many where they do not suffice."""

_SIGNS = 2.0 * ((np.arange(8)[:, None] >> np.arange(3)) & 1) - 1
_TREES: WeakKeyDictionary[PointCloud, BallTree] = WeakKeyDictionary()


class CloudTracker:
    """The contacts of pairs of a cloud and a solid.

    All pairs are measured at once: the points of a pair are a row, and rows are as long as the
    longest, the others filled up with NaN. In memory they follow each other, x, y and z apart,
    after the corners of the boxes around the clouds, whose motion bounds that of every point.

    Parameters
    ----------
    pairs : sequence of ContactPair
        Each with one cloud.

    Attributes
    ----------
    lists_made : int
        How many lists were made so far.
    """

    def __init__(self, pairs: Sequence[ContactPair]) -> None:
        sides = [_sides(pair) for pair in pairs]
        rows = kind_order([solid.shape for solid, _, _ in sides])
        solids, clouds = [sides[p][0] for p in rows], [sides[p][1] for p in rows]
        self.shapes = [solid.shape for solid in solids]
        self.points = [_points(cloud) for cloud in clouds]
        self.trees = [_tree(cloud) for cloud in clouds]
        self.placements = Placements(solids, clouds)
        n_c = np.array([pairs[p].n_c for p in rows])
        self.n_c, counts = n_c, np.array([len(points) for points in self.points])
        self.width = np.minimum(np.maximum(WIDTH, 4 * n_c), counts)
        # Contacts in the order of the pairs: each one's row, and its rank in the row.
        at = np.argsort(rows)
        self.row = np.repeat(at, n_c[at])
        self.rank = np.concatenate([np.arange(n) for n in n_c[at]])
        self.furthest = np.cumsum(n_c[at])[rows] - 1  # each row's k-th closest
        self.side = np.concatenate([self.row, len(rows) + self.row])
        self.sign = np.array([sides[p][2] for p in rows])[self.row, None]
        self.box = np.array([_box_corners(points) for points in self.points])
        self.sizes = np.array(
            [size(s) + np.abs(b).max() for s, b in zip(self.shapes, self.box, strict=True)]
        )
        self.swaps = bool((self.sign < 0).any())
        self.proofs = Proofs(len(rows))
        self.lists_made = 0
        self.lists = [np.arange(width) for width in self.width]
        self._fill()

    def closest_points(self, R: Array, t: Array) -> ClosestPoints:
        """The contacts at the poses of the links, shapes (L, 3, 3) and (L, 3).

        Raises
        ------
        ContactError
            If a pose is not finite.
        """
        poses = self.placements.poses(R, t)
        tries = 0
        while True:
            x = self._in_solids(poses)
            phi, normal = self.measured(x[:, self.first :].T)
            order = phi.reshape(len(self.shapes), -1).argsort(axis=1, kind="stable")
            found = order.ravel().take(self.ranked) + self.row_start
            distance = phi.take(found)
            # Written so that a NaN is no proof.
            proved = distance.take(self.furthest) < self.proofs.limit(x[:, : self.first])
            if proved.all():
                return self._contacts(poses, normal, found, distance)
            if not tries:
                check_finite(R, t)
            self._make_lists(np.flatnonzero(~proved), poses, normal, found, distance, tries)
            tries += 1

    def _in_solids(self, poses: PairPoses) -> Array:
        """Corners and points in the frames of their solids, shape (3, columns) [m]."""
        pose = np.concatenate([poses.R_rel, poses.t_rel[..., None]], axis=2)
        # The sums of `rotated`, without broadcasting, which takes longer than the sums.
        term = pose.T.take(self.of, axis=2) * self.columns
        return np.asarray(term[0] + term[1] + term[2] + term[3])

    def _contacts(
        self, poses: PairPoses, normal: Array, found: NDArray[np.int64], distance: Array
    ) -> ClosestPoints:
        vectors = np.concatenate([normal.T.take(found, axis=1), self.local.take(found, axis=1)], 1)
        term = poses.R.T.take(self.side, axis=2) * vectors[:, None]
        turned = term[0] + term[1] + term[2]
        n, centre = turned[:, : len(found)], turned[:, len(found) :]
        centre += poses.t.T.take(self.side[len(found) :], axis=1)
        foot = centre - distance * n
        n, foot, centre = (np.ascontiguousarray(vector.T) for vector in (n, foot, centre))
        point = self.index.take(found)
        if self.swaps:
            n, swapped = self.sign * n, self.sign < 0
            foot, centre = np.where(swapped, centre, foot), np.where(swapped, foot, centre)
        return ClosestPoints(distance, foot, centre, n, point)

    def _make_lists(
        self,
        which: NDArray[np.int64],
        poses: PairPoses,
        normal: Array,
        found: NDArray[np.int64],
        distance: Array,
        tries: int,
    ) -> None:
        """New lists for some rows, at these poses.

        The first list of a pair starts from any points; the second from its closest. If that is
        not proved complete either, many points are as close: it becomes longer.
        """
        for p in which.tolist():
            if tries >= 2:
                self.width[p] = min(2 * self.width[p], len(self.points[p]))
            last = self.furthest[p]
            nearest = found[last - self.n_c[p] + 1]
            R, t = poses.R_rel[p], poses.t_rel[p]
            phi_k, width = float(distance[last]), int(self.width[p])
            made = shortlist(self.trees[p], self.shapes[p], R, t, normal[nearest], phi_k, width)
            self.lists[p] = made.index
            self.proofs.keep(p, made, rotated(R, self.box[p]) + t, self.sizes[p])
        self.lists_made += len(which)
        self._fill()

    def _fill(self) -> None:
        """The columns of numbers, and where in them the contacts are looked up."""
        P, W = len(self.lists), max(len(index) for index in self.lists)
        rows, self.index = np.full((P, W, 3), np.nan), np.full((P, W), -1)
        for p, index in enumerate(self.lists):
            rows[p, : len(index)], self.index[p, : len(index)] = self.points[p][index], index
        self.first = P * CORNERS
        self.local = np.ascontiguousarray(rows.reshape(-1, 3).T)
        every = np.concatenate([self.box.reshape(-1, 3).T, self.local], axis=1)
        self.columns = np.ones((4, 3, every.shape[1]))
        self.columns[:3] = every[:, None]
        self.of = np.concatenate([np.repeat(np.arange(P), CORNERS), np.repeat(np.arange(P), W)])
        self.row_start = self.row * W
        self.ranked = self.row_start + self.rank
        self.measured = SolidRows(self.shapes, W)


def _sides(pair: ContactPair) -> tuple[PlacedShape, PlacedShape, float]:
    """The solid, the cloud, and the sign of the solid's normal in the contact's."""
    if isinstance(pair.beta.shape, PointCloud):
        return pair.alpha, pair.beta, 1.0
    return pair.beta, pair.alpha, -1.0


def _points(placed: PlacedShape) -> Array:
    assert isinstance(placed.shape, PointCloud)
    return placed.shape.points


def _tree(placed: PlacedShape) -> BallTree:
    """The cloud's tree, built once for all pairs and trackers."""
    cloud = placed.shape
    assert isinstance(cloud, PointCloud)
    if cloud not in _TREES:
        _TREES[cloud] = ball_tree(cloud.points)
    return _TREES[cloud]


def _box_corners(points: Array) -> Array:
    low, high = points.min(axis=0), points.max(axis=0)
    return np.asarray(np.where(_SIGNS > 0, high, low))
