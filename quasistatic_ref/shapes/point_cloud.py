"""The cloud of points, which is not solid."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from quasistatic_ref.errors import ModelError
from quasistatic_ref.numbers.arrays import Array, Indices, read_only
from quasistatic_ref.shapes.frozen import freeze_array
from quasistatic_ref.shapes.shape import Shape, dimensions

GROUP: Final = 64
"""Most points of a group of neighbours, and most groups of a group of these."""


class Groups(NamedTuple):
    """Groups of neighbours, and a cuboid about each that holds all of its points.

    Parameters
    ----------
    members : list of ndarray of int
        Numbers of the points of each group, or of its groups one level down.
    middle, half : ndarray, shape (G, 3)
        Of the cuboids: their middles and half extents [m].
    fewest : int
        Points of the smallest group.
    """

    members: list[Indices]
    middle: Array
    half: Array
    fewest: int


@dataclass(frozen=True, eq=False)
class PointCloud(Shape):
    """A rigid set of points in its own frame, shape (N, 3) with N >= 1 [m].

    Points that repeat an earlier one are left out: they would be contacts that bear nothing more,
    in the place of others. Numbers of points count those that are left.

    Examples
    --------
    >>> len(qr.PointCloud(np.eye(3)).points)
    3
    """

    points: Array

    if TYPE_CHECKING:  # what is made of lists, too

        def __init__(self, points: ArrayLike) -> None: ...

    def __post_init__(self) -> None:
        points = np.asarray(self.points)
        if points.ndim != 2 or points.shape[0] < 1:
            problem = "must contain at least one point, as an array of shape (N, 3)"
            raise ModelError(problem, field="points", value=points.shape)
        freeze_array(self, "points", (points.shape[0], 3))
        _, first = np.unique(self.points, axis=0, return_index=True)
        if len(first) < len(self.points):
            object.__setattr__(self, "points", read_only(self.points[np.sort(first)]))

    @cached_property
    def extent(self) -> float:
        """Longest edge of the cloud's bounding box along its own axes [m]."""
        return float(np.ptp(self.points, axis=0).max())

    @cached_property
    def levels(self) -> tuple[Groups, Groups]:
        """Large groups of small groups of the points, and the small groups."""
        small = halved(self.points)
        middle = np.array([self.points[some].mean(axis=0) for some in small])
        large = halved(middle)
        points = [np.concatenate([small[i] for i in some]) for some in large]
        return self._groups(large, points), self._groups(small, small)

    def _groups(self, members: list[Indices], points: list[Indices]) -> Groups:
        """Groups of some members, which have these points."""
        low = np.array([self.points[some].min(axis=0) for some in points])
        high = np.array([self.points[some].max(axis=0) for some in points])
        return Groups(members, (low + high) / 2, (high - low) / 2, min(map(len, points)))

    def words(self) -> str:
        """Number of points, and the edges of the cloud's bounding box [m]."""
        extent = dimensions(np.ptp(self.points, axis=0))
        return f"cloud of {len(self.points)} points within {extent}"


def halved(points: Array) -> list[Indices]:
    """Numbers of points (N, 3) [m] in groups, each half of one that its longest side was cut in."""
    groups = [np.arange(len(points))]
    while len(groups[0]) > GROUP:
        longest = [np.ptp(points[some], axis=0).argmax() for some in groups]
        groups = [
            half
            for some, axis in zip(groups, longest, strict=True)
            for half in np.array_split(some[points[some, axis].argpartition(len(some) // 2)], 2)
        ]
    return groups
