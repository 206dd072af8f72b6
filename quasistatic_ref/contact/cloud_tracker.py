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
from quasistatic_ref.contact.shortlist import Shortlist, shortlist, size
from quasistatic_ref.contact.solid_rows import SolidRows, kind_order
from quasistatic_ref.model.shapes import PlacedShape, PointCloud
from quasistatic_ref.step.data import Array
from quasistatic_ref.tolerances import UNSEEN

CORNERS = 8
"""Corners of the box around a cloud: they stand before the points in each row."""

WIDTH = 32
"""Points of a list to begin with; twice as many where they do not suffice."""

_SIGNS = 2.0 * ((np.arange(8)[:, None] >> np.arange(3)) & 1) - 1
_SQRT_3 = float(np.nextafter(np.sqrt(3.0), 2.0))
_TREES: WeakKeyDictionary[PointCloud, BallTree] = WeakKeyDictionary()


class CloudTracker:
    """The contacts of pairs of a cloud and a solid.

    All pairs are measured at once: the points of a pair are a row, and rows are as long as the
    longest, the others filled up with NaN. A row begins with the corners of the box around its
    cloud, whose motion bounds that of every point.

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
        solids = [sides[p][0] for p in rows]
        clouds = [sides[p][1] for p in rows]
        P = len(rows)
        self.shapes = [solid.shape for solid in solids]
        self.points = [_points(cloud) for cloud in clouds]
        self.trees = [_tree(cloud) for cloud in clouds]
        self.placements, self.measured = Placements(solids, clouds), SolidRows(self.shapes)
        n_c = np.array([pairs[p].n_c for p in rows])
        # Contacts in the order of the pairs: each one's row, and its rank in the row.
        at = np.argsort(rows)
        self.row = np.repeat(at, n_c[at])
        self.rank = np.concatenate([np.arange(n) for n in n_c[at]])
        self.furthest = np.cumsum(n_c[at])[rows] - 1  # each row's k-th closest
        self.side = np.stack([self.row, P + self.row])
        self.sign = np.array([sides[p][2] for p in rows])[self.row, None]
        self.n_c, self.width = (
            n_c,
            np.minimum(np.maximum(WIDTH, 4 * n_c), [len(points) for points in self.points]),
        )
        self.box = np.array([_box_corners(points) for points in self.points])
        self.sizes = np.array(
            [size(s) + np.abs(b).max() for s, b in zip(self.shapes, self.box, strict=True)]
        )
        self.by_distance, self.by_height = np.full(P, -np.inf), np.full(P, -np.inf)
        self.n, self.corners_at = np.zeros((P, 1, 3)), np.zeros((P, CORNERS, 3))
        self.far = np.zeros(P)
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
            x = rotated(poses.R_rel[:, None], self.rows) + poses.t_rel[:, None]
            phi, normal = self.measured(x)
            order = np.argsort(phi[:, CORNERS:], axis=1, kind="stable")
            found = order.ravel()[self._ranked] + self._first
            distance = phi.ravel()[found]
            # Written so that a NaN is no proof.
            unproved = ~(distance[self.furthest] < self._limit(x))
            if not unproved.any():
                break
            if not tries:
                check_finite(R, t)
            self._make_lists(np.flatnonzero(unproved), poses, normal, found, distance, tries)
            tries += 1
        return self._contacts(poses, normal, found, distance)

    def _limit(self, x: Array) -> Array:
        """Below which signed distances (P,) [m] all points outside the lists cannot come."""
        u = x[:, :CORNERS] - self.corners_at
        moved = _SQRT_3 * np.abs(u).reshape(len(u), -1).max(axis=1)
        along = u * self.n
        risen = (along[..., 0] + along[..., 1] + along[..., 2]).min(axis=1)
        limit = np.minimum(self.by_distance - moved, self.by_height + risen)
        return np.asarray(limit - UNSEEN * (self.far + moved))

    def _contacts(
        self, poses: PairPoses, normal: Array, found: NDArray[np.int64], distance: Array
    ) -> ClosestPoints:
        both = np.empty((2, len(found), 3))
        normal.reshape(-1, 3).take(found, axis=0, out=both[0])
        self.rows.reshape(-1, 3).take(found, axis=0, out=both[1])
        n, centre = rotated(poses.R[self.side], both)
        centre += poses.t[self.side[1]]
        foot = centre - distance[:, None] * n
        point = self.index.ravel()[found]
        if (self.sign < 0).any():
            swapped = self.sign < 0
            alpha, beta = np.where(swapped, centre, foot), np.where(swapped, foot, centre)
            return ClosestPoints(distance, alpha, beta, self.sign * n, point)
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
            made = shortlist(
                self.trees[p],
                self.shapes[p],
                R,
                t,
                normal.reshape(-1, 3)[nearest],
                float(distance[last]),
                int(self.width[p]),
            )
            self._keep(p, made, rotated(R, self.box[p]) + t)
        self.lists_made += len(which)
        self._fill()

    def _keep(self, p: int, made: Shortlist, corners: Array) -> None:
        self.lists[p], self.n[p], self.corners_at[p] = made.index, made.n, corners
        self.by_distance[p], self.by_height[p] = made.by_distance, made.by_height
        self.far[p] = self.sizes[p] + np.abs(corners).max()

    def _fill(self) -> None:
        """The rows of points, and where in them the contacts are looked up."""
        P, longest = len(self.lists), max(len(index) for index in self.lists)
        self.rows = np.full((P, CORNERS + longest, 3), np.nan)
        self.index = np.full((P, CORNERS + longest), -1)
        self.rows[:, :CORNERS] = self.box
        for p, index in enumerate(self.lists):
            self.rows[p, CORNERS : CORNERS + len(index)] = self.points[p][index]
            self.index[p, CORNERS : CORNERS + len(index)] = index
        self._ranked = self.row * longest + self.rank
        self._first = self.row * (CORNERS + longest) + CORNERS


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
