"""The contacts of all pairs, followed from step to step: the same bits as the brute force.

The brute force measures every point of a cloud at every step. Here a short list of each cloud's
points is measured, with a proof at each step that no other point can be among the k closest, ties
included; where the proof fails, the list is made again. docs/distances.md derives the bounds.
"""

from collections.abc import Sequence
from typing import Any
from weakref import WeakKeyDictionary

import numpy as np

from quasistatic_ref.contact.distance import (
    ClosestPoints,
    check_finite,
    joined_contacts,
    pair_closest_points,
)
from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.errors import ContactError
from quasistatic_ref.optional.fast.compiled import compiled
from quasistatic_ref.optional.fast.tracker.ball_tree import BallTree, ball_tree
from quasistatic_ref.optional.fast.tracker.cloud_pairs import CloudPairs, sides, starts
from quasistatic_ref.optional.fast.tracker.tracker_bound import Shortlist, shortlist
from quasistatic_ref.shapes.placed_shape import PointCloud
from quasistatic_ref.step.data import Array, Mask
from quasistatic_ref.step.ordered import rotated

WIDTH = 32
"""Least length of a list, where the cloud has so many points."""

WIDE = 256
"""Length that a list is not made longer than because it does not last."""

ATTEMPTS = 3
"""With the lists as they are, with new ones, and with lists of all points."""

SHORT = 8
"""Steps; a list that suffices for fewer is made twice as long, up to WIDE."""

SOME = 1024
"""Points of a cloud from which its first normal is taken."""

_TREES: WeakKeyDictionary[PointCloud, BallTree] = WeakKeyDictionary()


class ContactTracker:
    """What :func:`~quasistatic_ref.contact.distance.closest_points` returns, in less time.

    A tracker remembers which points of the clouds can come among the closest, so each run has a
    tracker of its own. Poses may jump; that costs time only. A copy, or one that was pickled, makes
    its lists again. Pairs of two solids are measured
    at each step: the number of their contacts is fixed, and the distance of each is part of the
    step, near or far.

    Parameters
    ----------
    pairs : sequence of ContactPair

    Attributes
    ----------
    clouds : CloudPairs
        The pairs in which one side is a cloud, in order.
    lists : list of CloudList
        One for each of these.
    steps : int
        That were taken.
    start : ndarray of int, shape (pairs + 1,)
        Where the contacts of each pair begin among all, and where the last end.
    has_cloud : ndarray of bool, shape (pairs,)
    """

    def __init__(self, pairs: Sequence[ContactPair]) -> None:
        self.pairs = tuple(pairs)
        self.clouds = CloudPairs([pair for pair in pairs if pair.has_cloud])
        self.lists = [CloudList(pair) for pair in self.clouds.pairs]
        self.steps = 0
        self.start = starts(np.array([pair.n_c for pair in pairs], dtype=np.int64))
        self.has_cloud = np.array([pair.has_cloud for pair in pairs], dtype=bool)
        self.on_cloud = np.repeat(self.has_cloud, np.diff(self.start))
        in_c = compiled("solids")
        some = len(self.lists) < len(self.pairs)
        self.solids: Any = in_c.PosedSolids(self.pairs) if in_c is not None and some else None

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (self.pairs,)

    @property
    def lists_made(self) -> int:
        """How many lists were made so far."""
        return sum(each.made for each in self.lists)

    def closest_points(self, R: Array, t: Array) -> ClosestPoints:
        """The contacts of all pairs, in order, each pair's in ascending distance.

        Parameters
        ----------
        R, t : ndarray, shapes (L, 3, 3) and (L, 3)
            Poses of the links, as in :class:`~quasistatic_ref.model.system.Kinematics`.

        Raises
        ------
        ContactError
            If a pair has no trustworthy normal, a pose is not finite, or a distance is no number.
        """
        check_finite(R, t)
        of_clouds = self.of_clouds(R, t) if self.lists else joined_contacts([])
        if len(self.lists) == len(self.pairs):
            return of_clouds
        if self.solids is None:
            found = no_contacts(int(self.start[-1]))
            decided = self.has_cloud
        else:
            found, decided = self.solids(R, t)
        put(of_clouds, found, self.on_cloud)
        for i in np.flatnonzero(~(decided | self.has_cloud)).tolist():
            own = joined_contacts([pair_closest_points(self.pairs[i], R, t)])
            put(own, found, slice(self.start[i], self.start[i + 1]))
        return found

    def of_clouds(self, R: Array, t: Array) -> ClosestPoints:
        """The contacts of pairs with a cloud, of which there are some; ContactError as above."""
        clouds = self.clouds
        world, relative = clouds.poses(R, t)
        self.steps += 1
        if not self.lists[0].made:
            for each, pose in zip(self.lists, relative, strict=True):
                each.make(pose, each.first_normal(pose), np.inf, self.steps)
            clouds.put([each.list for each in self.lists])
        for attempt in range(ATTEMPTS):
            x, phi, normal = clouds.measured(relative)
            kept = clouds.kept(phi)
            phi_k = phi.take(kept.take(clouds.last))
            (unproved,) = (~(phi_k < clouds.limits(relative))).nonzero()
            if not unproved.size:
                found = (field.take(kept, axis=0) for field in (x, phi, normal))
                return clouds.contacts(world, relative, kept, *found)
            for i in unproved.tolist():
                # A new list is proved where it was made; if not, for some error, all points are.
                n = normal[kept[clouds.first[i]]]
                self.lists[i].make(relative[i], n, float(phi_k[i]), self.steps, attempt > 0)
            clouds.put([each.list for each in self.lists])
        name = clouds.pairs[unproved[0]].name
        raise ContactError("has distances that are not numbers", field=name)


class CloudList:
    """The short list of a pair of a cloud and a solid.

    Parameters
    ----------
    pair : ContactPair
        With one cloud.

    Attributes
    ----------
    list : Shortlist
        From the first step on.
    width : int
        Length of the next list.
    made, made_at : int
        How many lists were made, and in which step the last of them.
    """

    list: Shortlist

    def __init__(self, pair: ContactPair) -> None:
        solid, cloud = sides(pair)
        assert isinstance(cloud.shape, PointCloud)
        self.solid = solid.shape
        self.points = cloud.shape.points
        self.tree = cloud_tree(cloud.shape)
        self.n_c = pair.n_c
        self.width = max(WIDTH, 4 * pair.n_c)
        self.made = 0
        self.made_at = 0

    def first_normal(self, relative: Array) -> Array:
        """About the normal at the nearest point, shape (3,) [-], from some of the points.

        Parameters
        ----------
        relative : ndarray, shape (3, 4)
            [R, t] of the cloud in the solid's frame [-, m].
        """
        some = self.points[:: max(1, len(self.points) // SOME)]
        x = rotated(relative[:, :3], some) + relative[:, 3]
        phi, normal = self.solid.signed_distance(x)
        return np.asarray(normal[phi.argmin()])

    def make(self, relative: Array, n: Array, phi_k: float, step: int, whole: bool = False) -> None:
        """Make a list; of all points if `whole`.

        Parameters
        ----------
        relative : ndarray, shape (3, 4)
            [R, t] of the cloud in the solid's frame [-, m].
        n : ndarray, shape (3,)
            The normal at the nearest point [-].
        phi_k : float
            The k-th smallest distance [m]; infinite if not known.
        step : int
            The number of this step.
        whole : bool
        """
        if self.made and step - self.made_at < SHORT:
            self.width = min(2 * self.width, WIDE)
        width = len(self.points) if whole else self.width
        R = relative[:, :3]
        t = relative[:, 3]
        self.list = shortlist(self.tree, self.solid, R, t, n, phi_k, self.n_c, width)
        self.made += 1
        self.made_at = step


def put(some: ClosestPoints, every: ClosestPoints, where: Mask | slice) -> None:
    """Write some contacts among others, in the places of a mask or a slice of these."""
    for field, values in zip(every, some, strict=True):
        field[where] = values


def no_contacts(n_c: int) -> ClosestPoints:
    """Zeros in the place of some contacts."""
    return ClosestPoints(np.zeros(n_c), *np.zeros((3, n_c, 3)), *np.zeros((2, n_c), np.int64))


def cloud_tree(cloud: PointCloud) -> BallTree:
    """The cloud's tree, built once for all pairs and trackers."""
    if cloud not in _TREES:
        _TREES[cloud] = ball_tree(cloud.points)
    return _TREES[cloud]
