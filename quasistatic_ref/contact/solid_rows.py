"""Signed distances of rows of points, each row to a solid of its own, by few NumPy calls."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from quasistatic_ref.contact.cloud import distance_to_rounded_box, rounded_box, signed_distance
from quasistatic_ref.model.shapes import Box, Capsule, HalfSpace, Shape, Sphere
from quasistatic_ref.step.data import Array


def kind_order(shapes: Sequence[Shape]) -> list[int]:
    """The order in which solids of one kind follow each other, as :class:`SolidRows` needs it."""
    return sorted(range(len(shapes)), key=lambda i: _rank(shapes[i]))


def _rank(shape: Shape) -> int:
    match shape:
        case Sphere() | Capsule() | Box():
            return 0
        case HalfSpace():
            return 1
        case _:
            return 2


class SolidRows:
    """P solids in :func:`kind_order`: those of the first two kinds are measured at once.

    The bits are those of :func:`~quasistatic_ref.contact.cloud.signed_distance`.
    """

    def __init__(self, shapes: Sequence[Shape]) -> None:
        ranks = [_rank(shape) for shape in shapes]
        self.boxes, self.planes = slice(0, ranks.count(0)), slice(ranks.count(0), len(ranks))
        if 2 in ranks:
            self.planes = slice(ranks.count(0), ranks.index(2))
        self.others = [(p, shape) for p, shape in enumerate(shapes) if ranks[p] == 2]
        cores = [rounded_box(s) for s in shapes if isinstance(s, Sphere | Capsule | Box)]
        self.half_extents = np.array([core[0] for core in cores]).reshape(-1, 1, 3)
        self.ball = np.array([core[1] for core in cores]).reshape(-1, 1)
        walls = [s for s in shapes if isinstance(s, HalfSpace)]
        self.n = np.array([wall.normal for wall in walls]).reshape(-1, 1, 3)
        self.offset = np.array([wall.offset for wall in walls]).reshape(-1, 1)

    def __call__(self, x: Array) -> tuple[Array, Array]:
        """Signed distances (P, W) [m] and unit normals (P, W, 3) of points (P, W, 3)."""
        phi, normal = np.empty(x.shape[:2]), np.empty(x.shape)
        if len(self.half_extents):
            phi[self.boxes], normal[self.boxes] = distance_to_rounded_box(
                x[self.boxes], self.half_extents, self.ball
            )
        if len(self.n):
            level = x[self.planes] * self.n
            phi[self.planes] = level[..., 0] + level[..., 1] + level[..., 2] - self.offset
            normal[self.planes] = self.n
        for p, shape in self.others:
            given = ~np.isnan(x[p, :, 0])  # rows are filled up with NaN
            phi[p], normal[p] = np.nan, np.nan
            phi[p, given], normal[p, given] = signed_distance(shape, x[p, given])
        return phi, normal
