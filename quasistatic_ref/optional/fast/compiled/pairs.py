"""The closest points of all pairs, as C finds them; what it leaves open, the plain path does."""

from collections.abc import Sequence

import numpy as np

from quasistatic_ref.contact.distance import (
    ClosestPoints,
    check_finite,
    joined_contacts,
    pair_closest_points,
)
from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.optional.fast.compiled.library import library
from quasistatic_ref.optional.fast.compiled.poses import Poses
from quasistatic_ref.optional.fast.compiled.solids import Solid, measured, solid
from quasistatic_ref.optional.fast.compiled.structure import Structure
from quasistatic_ref.shapes.placed_shape import PointCloud
from quasistatic_ref.step.data import Indices

CROSSINGS = 1024
"""The most of a pair: LARGEST of solids.h."""

WIDTH = 32
"""Least length of a list of a cloud's points, where the cloud has so many."""


class Cloud(Structure):
    """``Cloud`` of solids.h: a cloud, the solid that it may touch, and a short list of its points.

    Parameters
    ----------
    pair : ContactPair
        With one cloud.
    """

    def __init__(self, pair: ContactPair) -> None:
        super().__init__("solids.h", "Cloud")
        is_alpha = isinstance(pair.alpha.shape, PointCloud)
        sides = (pair.alpha, pair.beta) if is_alpha else (pair.beta, pair.alpha)
        cloud, self.solid = sides[0].shape, solid(sides[1].shape)
        assert isinstance(cloud, PointCloud)
        N = len(cloud.points)
        axes = np.ascontiguousarray(cloud.points.T)  # each in one piece: a tenth of the time
        low = axes.min(axis=1)
        high = axes.max(axis=1)
        at_high = (np.arange(8)[:, None] >> np.arange(3)) & 1
        self.put(
            {
                "is_alpha": int(is_alpha), "points": N, "width": max(WIDTH, 4 * pair.n_c),
                "listed": 0, "evaluated": 0, "age": 0,
                "solid": self.solid.address, "point": cloud.points,
                "box": np.where(at_high, high, low), "index": np.zeros(N, np.int64),
                "bounds": np.zeros(2), "n": np.zeros(3), "corners": np.zeros((8, 3)),
                **{name: np.zeros(N) for name in ("phi", "height", "score")},
                "resolution": np.array([pair.resolution]),
                "nearest": np.zeros(pair.n_c), "rank": np.zeros(pair.n_c, np.int64),
            }
        )  # fmt: skip


class Pairs(Structure):
    """``Pairs`` of solids.h: all pairs, and their contacts at the poses that are there.

    Clouds keep short lists of points from step to step, so that each run has an object of its own.
    Poses may jump; that costs time only.

    Parameters
    ----------
    pairs : sequence of ContactPair
    R, t : ndarray of int, shape (L,)
        Addresses of each link's rotation, by columns, and of its origin.
    found : ClosestPoints
        Where the contacts of all pairs are written.

    Attributes
    ----------
    known : list of bool
        Of which pairs C finds the closest points, but where a normal is one of several.
    clouds : list of Cloud
        Of the pairs with a cloud that C knows.
    """

    def __init__(
        self, pairs: Sequence[ContactPair], R: Indices, t: Indices, found: ClosestPoints
    ) -> None:
        super().__init__("solids.h", "Pairs")
        self.pairs = tuple(pairs)
        self.known = [measured(pair) for pair in pairs]
        count = np.array([pair.n_c for pair in pairs], np.int64)
        self.start = np.cumsum(count) - count
        self.found = found
        self.clouds: list[Cloud] = []
        self.solids: list[Solid] = []
        address = np.zeros((3, len(pairs)), np.int64)  # of each pair's cloud, or its two solids
        for i, pair in enumerate(pairs):
            if self.known[i] and pair.has_cloud:
                self.clouds.append(Cloud(pair))
                address[0, i] = self.clouds[-1].address
            elif self.known[i]:
                self.solids += [solid(pair.alpha.shape), solid(pair.beta.shape)]
                address[1:, i] = self.solids[-2].address, self.solids[-1].address
        most = max((pair.corners for pair in pairs), default=0) + CROSSINGS + 1
        contact = np.dtype([("numbers", np.float64, 10), ("integers", np.int64, 2)])
        self.put(
            {
                "pairs": len(pairs), "R": R, "t": t,
                "cloud": address[0], "a": address[1], "b": address[2],
                "link_a": np.array([pair.alpha.link for pair in pairs], np.int64),
                "link_b": np.array([pair.beta.link for pair in pairs], np.int64),
                "on_a": np.array([np.column_stack([p.alpha.R, p.alpha.t]) for p in pairs]),
                "on_b": np.array([np.column_stack([p.beta.R, p.beta.t]) for p in pairs]),
                "k": np.array([pair.k for pair in pairs], np.int64),
                "start": self.start, "count": count,
                "corners": np.array([pair.corners for pair in pairs], np.int64),
                "candidates": np.zeros(most * contact.itemsize // 8),
                "order": np.zeros(most, np.int64), "late": np.zeros(most, np.int64),
                "decided": np.zeros(len(pairs), np.int64), **found._asdict(),
            }
        )  # fmt: skip
        self._find = library().closest_points

    def decided(self) -> Indices:
        """Have the contacts written that C finds, and tell of which pairs they are, shape (k,)."""
        self._find(self.address)
        return np.flatnonzero(self["decided"])

    def find(self, poses: Poses) -> None:
        """Write the contacts of all pairs.

        Parameters
        ----------
        poses : Poses
            Those at the addresses.

        Raises
        ------
        ContactError
            If a pair has no trustworthy normal, or a pose is not finite.
        """
        if self._find(self.address):
            return
        kinematics = poses.kinematics()
        R = kinematics.R
        t = kinematics.t
        check_finite(R, t)
        for i in np.flatnonzero(self["decided"] == 0).tolist():
            own = joined_contacts([pair_closest_points(self.pairs[i], R, t)])
            for field, values in zip(self.found, own, strict=True):
                field[self.start[i] : self.start[i] + len(own.phi)] = values
