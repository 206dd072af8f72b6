"""The contacts of all pairs, followed from step to step: the same bits as the brute force.

The brute force measures every point of a cloud at every step. Here a short list of each cloud's
points is measured, with a proof at each step that no other point can be among the k closest, ties
included; where the proof fails, the list is made again. docs/distances.md derives the bounds.
"""

from collections.abc import Sequence
from weakref import WeakKeyDictionary

import numpy as np

from quasistatic_ref.contact.distance import (
    ClosestPoints,
    check_finite,
    cloud_contacts,
    in_world,
    joined,
    pair_closest_points,
    relative_pose,
)
from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.errors import ContactError
from quasistatic_ref.optional.fast.tracker.ball_tree import BallTree, ball_tree
from quasistatic_ref.optional.fast.tracker.tracker_bound import Shortlist, shortlist
from quasistatic_ref.shapes.placed_shape import PointCloud
from quasistatic_ref.step.data import Array
from quasistatic_ref.step.ordered import rotated

WIDTH = 32
"""Least length of a list, where the cloud has so many points."""

WIDE = 256
"""Length that a list is not made longer than because it does not last."""

ATTEMPTS = 3
"""With the list as it is, with a new one, and with a list of all points."""

SHORT = 8
"""Steps; a list that suffices for fewer is made twice as long, up to WIDE."""

SOME = 1024
"""Points of a cloud from which its first normal is taken."""

_TREES: WeakKeyDictionary[PointCloud, BallTree] = WeakKeyDictionary()


class ContactTracker:
    """What :func:`~quasistatic_ref.contact.distance.closest_points` returns, in less time.

    A tracker remembers which points of the clouds can come among the closest, so each run has a
    tracker of its own. Poses may jump; that costs time only. Pairs of two solids are measured
    at each step: the number of their contacts is fixed, and the distance of each is part of the
    step, near or far.

    Parameters
    ----------
    pairs : sequence of ContactPair

    Attributes
    ----------
    clouds : list of FollowedCloud
        Of the pairs in which one side is a cloud, in order.
    """

    def __init__(self, pairs: Sequence[ContactPair]) -> None:
        self.pairs = [FollowedCloud(pair) if pair.has_cloud else pair for pair in pairs]
        self.clouds = [pair for pair in self.pairs if isinstance(pair, FollowedCloud)]

    @property
    def lists_made(self) -> int:
        """How many lists were made so far."""
        return sum(cloud.lists_made for cloud in self.clouds)

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
        return joined(
            [
                pair.closest_points(R, t)
                if isinstance(pair, FollowedCloud)
                else pair_closest_points(pair, R, t)
                for pair in self.pairs
            ]
        )


class FollowedCloud:
    """The contacts of a pair of a cloud and a solid.

    Parameters
    ----------
    pair : ContactPair
        With one cloud.

    Attributes
    ----------
    solid, cloud : PlacedShape
    sign : float
        Of the solid's normal in the contact's.
    points : ndarray, shape (N, 3)
        Of the cloud, in its frame [m].
    tree : BallTree
    list : Shortlist or None
        None before the first step.
    width : int
        Length of the next list.
    lists_made : int
    steps : int
        That were taken.
    """

    def __init__(self, pair: ContactPair) -> None:
        self.pair, self.solid, self.cloud, self.sign = pair, pair.alpha, pair.beta, 1.0
        if isinstance(pair.alpha.shape, PointCloud):
            self.solid, self.cloud, self.sign = pair.beta, pair.alpha, -1.0
        assert isinstance(self.cloud.shape, PointCloud)
        self.points, self.tree = self.cloud.shape.points, cloud_tree(self.cloud.shape)
        self.width = max(WIDTH, 4 * pair.n_c)
        self.list: Shortlist | None = None
        self.lists_made = self.steps = self.made_at = 0

    def closest_points(self, R: Array, t: Array) -> ClosestPoints:
        """The contacts at the poses of the links, shapes (L, 3, 3) and (L, 3).

        Raises
        ------
        ContactError
            If a distance is no number.
        """
        solid, cloud = in_world(self.solid, R, t), in_world(self.cloud, R, t)
        relative = relative_pose(solid, cloud)
        self.steps += 1
        if self.list is None:
            self.list = self.first_list(relative)
        for attempt in range(ATTEMPTS):
            x, phi, normal = self.measured(relative)
            phi_k = float(np.partition(phi, self.pair.n_c - 1)[self.pair.n_c - 1])
            if phi_k < self.list.limit(relative):
                index = self.list.index
                found = cloud_contacts(self.pair, solid, cloud, relative, x, phi, normal, index)
                return found if self.sign > 0 else found.swapped()
            if self.steps - self.made_at < SHORT:
                self.width = min(2 * self.width, WIDE)
            # A new list is proved where it was made; if not, for some error, all points are.
            width = len(self.points) if attempt else self.width
            self.list = self.new_list(relative, normal[phi.argmin()], phi_k, width)
        raise ContactError("has distances that are not numbers", field=self.pair.name)

    def measured(self, relative: Array) -> tuple[Array, Array, Array]:
        """Of the listed points at a pose: where they are, and what is measured.

        Parameters
        ----------
        relative : ndarray, shape (3, 4)
            [R, t] of the cloud in the solid's frame [-, m].

        Returns
        -------
        x, phi, normal : ndarray, shapes (N, 3), (N,) and (N, 3)
            In the solid's frame [m], signed distances [m] and normals [-].
        """
        assert self.list is not None
        x = rotated(relative[:, :3], self.points[self.list.index]) + relative[:, 3]
        return x, *self.solid.shape.signed_distance(x)

    def first_list(self, relative: Array) -> Shortlist:
        """A list that starts from some points of the cloud.

        Parameters
        ----------
        relative : ndarray, shape (3, 4)
            [R, t] of the cloud in the solid's frame [-, m].
        """
        some = self.points[:: max(1, len(self.points) // SOME)]
        x = rotated(relative[:, :3], some) + relative[:, 3]
        phi, normal = self.solid.shape.signed_distance(x)
        return self.new_list(relative, normal[phi.argmin()], np.inf, self.width)

    def new_list(self, relative: Array, n: Array, phi_k: float, width: int) -> Shortlist:
        """A list at a pose.

        Parameters
        ----------
        relative : ndarray, shape (3, 4)
            [R, t] of the cloud in the solid's frame [-, m].
        n : ndarray, shape (3,)
            [-].
        phi_k : float
            [m].
        width : int
        """
        self.lists_made += 1
        self.made_at = self.steps
        R, t = relative[:, :3], relative[:, 3]
        return shortlist(self.tree, self.solid.shape, R, t, n, phi_k, self.pair.n_c, width)


def cloud_tree(cloud: PointCloud) -> BallTree:
    """The cloud's tree, built once for all pairs and trackers."""
    if cloud not in _TREES:
        _TREES[cloud] = ball_tree(cloud.points)
    return _TREES[cloud]
