"""The cloud of points, which is not solid."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from quasistatic_ref.errors import ModelError
from quasistatic_ref.numbers.arrays import Array, Indices, read_only
from quasistatic_ref.numbers.ordered import norm
from quasistatic_ref.shapes.frozen import freeze_array
from quasistatic_ref.shapes.shape import Shape, dimensions

GROUP: Final = 64
"""Most points of a group of neighbours."""


class Groups(NamedTuple):
    """Groups of neighbours of a cloud, and a ball about each.

    Parameters
    ----------
    points : list of ndarray of int
        Numbers of the points of each group.
    middle : ndarray, shape (G, 3)
        [m].
    reach : ndarray, shape (G,)
        Radius of the ball [m].
    """

    points: list[Indices]
    middle: Array
    reach: Array


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
    def groups(self) -> Groups:
        """The cloud's points in small groups, each half of a group cut across its longest side."""
        groups = [np.arange(len(self.points))]
        while len(groups[0]) > GROUP:
            longest = [np.ptp(self.points[some], axis=0).argmax() for some in groups]
            groups = [
                half
                for some, axis in zip(groups, longest, strict=True)
                for half in np.array_split(some[self.points[some, axis].argsort(kind="stable")], 2)
            ]
        middle = np.array([self.points[some].mean(axis=0) for some in groups])
        reach = [
            norm(self.points[some] - at).max() for some, at in zip(groups, middle, strict=True)
        ]
        return Groups(groups, middle, np.array(reach))

    def words(self) -> str:
        """Number of points, and the edges of the cloud's bounding box [m]."""
        extent = dimensions(np.ptp(self.points, axis=0))
        return f"cloud of {len(self.points)} points within {extent}"
