"""Hulls of what links are known by."""

from collections.abc import Sequence
from contextlib import suppress
from itertools import product

import numpy as np

from quasistatic_ref.errors import ModelError
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.shapes.convex_mesh import ConvexMesh, convex_hull
from quasistatic_ref.shapes.placed_shape import PlacedShape

WAYS = [np.array(way) / np.linalg.norm(way) for way in product((-1, 0, 1), repeat=3) if any(way)]
"""To the faces, edges and corners of a cube [-]."""


def hull_of(shapes: Sequence[PlacedShape]) -> ConvexMesh | None:
    """Convex hull of a link's shapes, in its frame; None if they are flat."""
    corners = [placed.shape.corners(WAYS[0])[0] @ placed.R.T + placed.t for placed in shapes]
    with suppress(ModelError):
        return convex_hull(np.concatenate([*map(farthest_points, shapes), *corners]))
    return None


def farthest_points(placed: PlacedShape) -> Array:
    """The points of a shape that are farthest in the WAYS, in the frame of its link, (n, 3) [m]."""
    farthest = np.array([placed.shape.support_point(way) for way in WAYS])
    return farthest @ placed.R.T + placed.t
