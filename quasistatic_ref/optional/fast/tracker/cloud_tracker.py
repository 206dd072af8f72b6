"""The closest points of clouds on solids, followed from step to step.

The brute force measures every point at every step. Here a short list of each pair's points is
measured, with a proof at each step that no other point can be among the k closest, ties included;
where the proof fails, the list is made again. docs/distances.md derives the bounds.
"""

from collections.abc import Sequence
from weakref import WeakKeyDictionary

import numpy as np

from quasistatic_ref.contact.cloud import signed_distance
from quasistatic_ref.contact.distance import ClosestPoints, check_finite
from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.contact.patch import cloud_surface
from quasistatic_ref.contact.placed import Placed
from quasistatic_ref.contact.poses import PairPoses, Placements
from quasistatic_ref.contact.separations import OWN
from quasistatic_ref.errors import ContactError
from quasistatic_ref.optional.fast.tracker.ball_tree import BallTree, ball_tree
from quasistatic_ref.optional.fast.tracker.batch import Batch, Nearest
from quasistatic_ref.optional.fast.tracker.solid_rows import kind_order
from quasistatic_ref.optional.fast.tracker.tracker_bound import Shortlist, shortlist
from quasistatic_ref.shapes.placed_shape import PlacedShape, PointCloud
from quasistatic_ref.step.data import Array, Indices
from quasistatic_ref.step.ordered import rotated, total
from quasistatic_ref.tolerances import TIED_FACES

WIDTH = 32
"""Least length of a list, where the cloud has so many points."""

WIDE = 256
"""Length above which a list, of points that are equally close, is measured by itself."""

ATTEMPTS = 3
"""With the lists as they are, with new ones, and with lists of all points."""

SHORT = 8
"""Steps; a list that suffices for fewer is made twice as long, up to WIDE."""

SOME = 1024
"""Points of a cloud from which its first normal is taken."""

_TREES: WeakKeyDictionary[PointCloud, BallTree] = WeakKeyDictionary()


class CloudTracker:
    """The contacts of pairs of a cloud and a solid.

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
        # Rows are pairs in another order, in which like solids follow each other.
        self.pair = kind_order([solid.shape for solid, _, _ in sides])
        solids, clouds = [sides[p][0] for p in self.pair], [sides[p][1] for p in self.pair]
        self.solids = [solid.shape for solid in solids]
        self.clouds = [_cloud(cloud) for cloud in clouds]
        self.trees = [cloud_tree(cloud) for cloud in self.clouds]
        self.placements = Placements(solids, clouds)
        self.signs = np.array([sides[p][2] for p in self.pair])
        self.n_c, self.names = [pairs[p].n_c for p in self.pair], [pairs[p].name for p in self.pair]
        self.width = [max(WIDTH, 4 * n_c) for n_c in self.n_c]
        extents = np.array([shape.extent for shape in self.solids])
        self.largest = float(extents[np.isfinite(extents)].max(initial=0.0))
        self.lists: list[Shortlist] = []
        self.batches: list[Batch] = []
        self.lists_made = self.steps = 0
        self.made_at = [0] * len(self.pair)

    def closest_points(self, R: Array, t: Array) -> ClosestPoints:
        """The contacts at the poses of the links, shapes (L, 3, 3) and (L, 3).

        Raises
        ------
        ContactError
            If a pose is not finite, or a distance is no number.
        """
        poses = self.placements.poses(R, t)
        self.steps += 1
        if not self.lists:
            check_finite(R, t)
            self.lists = [self._first_list(row, poses) for row in range(len(self.solids))]
            self._arrange()
        for attempt in range(ATTEMPTS):
            nearest = _joined([batch.nearest(poses) for batch in self.batches])
            if np.count_nonzero(nearest.proved) == len(nearest.proved):
                return self._contacts(poses, *self._decided(poses, nearest))
            check_finite(R, t)
            for i in np.flatnonzero(~nearest.proved).tolist():
                row = int(self.rows[i])
                if self.steps - self.made_at[row] < SHORT:
                    self.width[row] = min(2 * self.width[row], WIDE)
                n = nearest.normal[:, self.best[i]].copy()
                phi_k = float(nearest.phi[self.last[i]])
                # A new list is proved where it was made; if not, for some error, all points are.
                width = len(self.clouds[row].points) if attempt else self.width[row]
                self.lists[row] = self._list(row, poses, n, phi_k, width)
            self._arrange()
        unknown = ", ".join(self.names[row] for row in self.rows[~nearest.proved])
        raise ContactError("has distances that are not numbers", field=unknown)

    def _first_list(self, row: int, poses: PairPoses) -> Shortlist:
        """A list that starts from some points of the cloud, and one that starts from its best."""
        points, solid = self.clouds[row].points, self.solids[row]
        R, t = poses.R_rel[row], poses.t_rel[row]
        some = points[:: max(1, len(points) // SOME)]
        phi, normal = signed_distance(solid, rotated(R, some) + t)
        return self._list(row, poses, normal[phi.argmin()], np.inf, self.width[row])

    def _list(self, row: int, poses: PairPoses, n: Array, phi_k: float, width: int) -> Shortlist:
        """A list of one pair at these poses; n and phi_k as :func:`shortlist` wants them."""
        self.lists_made += 1
        self.made_at[row] = self.steps
        tree, R, t = self.trees[row], poses.R_rel[row], poses.t_rel[row]
        return shortlist(tree, self.solids[row], R, t, n, phi_k, self.n_c[row], width)

    def _arrange(self) -> None:
        """Batches of the lists: the short ones together, each long one by itself."""
        long = [row for row, made in enumerate(self.lists) if len(made.index) > WIDE]
        short = [row for row in range(len(self.lists)) if row not in long]
        parts = [[row] for row in long] + ([short] if short else [])
        self.batches = [self._batch(rows) for rows in parts]
        self.rows = np.array([row for rows in parts for row in rows])
        # Contacts are found row by row, and returned pair by pair.
        owner = np.repeat(self.rows, [self.n_c[row] for row in self.rows])
        self.order = np.argsort(np.array(self.pair)[owner], kind="stable")
        row = owner[self.order]
        self.side, self.sign = np.concatenate([row, len(self.solids) + row]), self.signs[row, None]
        self.cloud_side = self.side[len(row) :]
        several = [shape.faces(np.zeros((1, 3)))[0].size > 1 for shape in self.solids]
        self.faced = np.array(several)[row]
        self.swaps = bool((self.sign < 0).any())
        n_c = np.array([self.n_c[row] for row in self.rows])
        self.last = np.cumsum(n_c) - 1
        self.best = self.last - n_c + 1
        if len(self.batches) == 1:  # then it can give them in that order itself
            at = np.argsort(self.order)
            self.batches[0].reorder(self.order)
            self.last, self.best = at[self.last], at[self.best]

    def _batch(self, rows: list[int]) -> Batch:
        solids, lists = [self.solids[row] for row in rows], [self.lists[row] for row in rows]
        points = [self.clouds[row].points[self.lists[row].index] for row in rows]
        boxes, n_c = [self.trees[row].box for row in rows], [self.n_c[row] for row in rows]
        return Batch(rows, solids, lists, points, boxes, n_c)

    def _decided(self, poses: PairPoses, nearest: Nearest) -> tuple[Nearest, Indices]:
        """The contacts in order, ties of their normals decided, and how."""
        if len(self.batches) > 1:
            nearest = nearest.chosen(self.order)
        tie = np.full(len(nearest.phi), OWN)
        far = max(self.largest, float(np.abs(poses.t).max()))
        near = nearest.phi <= TIED_FACES * far
        if not np.count_nonzero(near):
            return nearest, tie
        normal, row_of = nearest.normal.copy(), self.side[: len(tie)]
        for row in np.unique(row_of[near & self.faced]).tolist():
            own = np.flatnonzero(near & (row_of == row))
            solid, cloud = (
                Placed(shape, poses.R[side], poses.t[side])
                for shape, side in (
                    (self.solids[row], row),
                    (self.clouds[row], len(self.solids) + row),
                )
            )
            relative = poses.relative[row]
            x = rotated(relative[:, :3], nearest.local[:, own].T) + relative[:, 3]
            name, phi = self.names[row], nearest.phi[own]
            found = cloud_surface(name, solid, cloud, relative, x, phi, normal[:, own].T)
            normal[:, own], tie[own] = found.normal.T, found.tie
        return nearest._replace(normal=normal), tie

    def _contacts(self, poses: PairPoses, nearest: Nearest, tie: Indices) -> ClosestPoints:
        vectors = np.concatenate([nearest.normal, nearest.local], axis=1)
        turned = total(poses.R.T.take(self.side, axis=2) * vectors[:, None])
        count = len(self.order)
        n, centre = turned[:, :count], turned[:, count:]
        centre += poses.t.T.take(self.cloud_side, axis=1)
        phi = nearest.phi
        foot = centre - phi * n
        n, foot, centre = np.ascontiguousarray(n.T), foot.T, centre.T
        point = nearest.point
        if self.swaps:
            n, swapped = self.sign * n, self.sign < 0
            foot, centre = np.where(swapped, centre, foot), np.where(swapped, foot, centre)
        return ClosestPoints(phi, foot, centre, n, point, tie)


def _joined(found: list[Nearest]) -> Nearest:
    if len(found) == 1:
        return found[0]
    return Nearest(*(np.concatenate(part, axis=-1) for part in zip(*found, strict=True)))


def _sides(pair: ContactPair) -> tuple[PlacedShape, PlacedShape, float]:
    """The solid, the cloud, and the sign of the solid's normal in the contact's."""
    if isinstance(pair.beta.shape, PointCloud):
        return pair.alpha, pair.beta, 1.0
    return pair.beta, pair.alpha, -1.0


def _cloud(placed: PlacedShape) -> PointCloud:
    assert isinstance(placed.shape, PointCloud)
    return placed.shape


def cloud_tree(cloud: PointCloud) -> BallTree:
    """The cloud's tree, built once for all pairs and trackers."""
    if cloud not in _TREES:
        _TREES[cloud] = ball_tree(cloud.points)
    return _TREES[cloud]
