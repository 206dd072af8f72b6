"""The cloud of points, which is not solid."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from quasistatic_ref.errors import ModelError
from quasistatic_ref.numbers.arrays import Array, Indices, checked_numbers, read_only
from quasistatic_ref.shapes.frozen import freeze_array
from quasistatic_ref.shapes.shape import Shape, dimensions

GROUP: Final = 64
"""Most points of a group of neighbours, and most groups of a group of these."""


class Groups(NamedTuple):
    """Groups of neighbours, and a cuboid about each that holds all of its points.

    Parameters
    ----------
    members : ndarray of int, shape (G, n)
        Numbers of the points of each group, or of its groups one level down; some of them twice, so
        that all groups are of one size.
    middle, half : ndarray, shape (G, 3)
        Middles and half extents of the cuboids [m].
    fewest : int
        Of so many points at least is each group.
    """

    members: Indices
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
        points = checked_numbers(self.points, "points", ModelError)
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
        x = self.points[small]
        low, high = x.min(axis=1), x.max(axis=1)
        large = halved(low + high)
        ends = low[large].min(axis=1), high[large].max(axis=1)
        n = small.shape[1]
        # No point is in more than two places.
        every = Groups(small, (low + high) / 2, (high - low) / 2, (n + 1) // 2)
        fewest = ((large.shape[1] + 1) // 2 * n + 1) // 2
        return Groups(large, (ends[0] + ends[1]) / 2, (ends[1] - ends[0]) / 2, fewest), every

    def words(self) -> str:
        """Number of points, and the edges of the cloud's bounding box [m]."""
        extent = dimensions(np.ptp(self.points, axis=0))
        return f"cloud of {len(self.points)} points within {extent}"


def halved(points: Array) -> Indices:
    """Numbers of points (N, 3) [m] in groups, each half of one that its longest side was cut in.

    Returns
    -------
    ndarray of int, shape (G, n)
        Some points are there twice, so that all groups are of one size.
    """
    N = len(points)
    G = 1
    while N > GROUP * G:
        G *= 2
    groups = (np.arange(-(-N // G) * G) % N)[None]
    while len(groups) < G:
        x = points.T[:, groups]
        longest = (x.max(axis=2) - x.min(axis=2)).argmax(axis=0)
        along = np.take_along_axis(x, longest[None, :, None], axis=0)[0]
        order = along.argpartition(groups.shape[1] // 2, axis=1)
        groups = np.take_along_axis(groups, order, axis=1).reshape(2 * len(groups), -1)
    return groups
