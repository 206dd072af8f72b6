"""Shapes as points whose hull looks like them, and hulls as polygons."""

from functools import lru_cache

import numpy as np
from scipy.spatial import ConvexHull

from quasistatic_ref.contact.jacobian import tangents
from quasistatic_ref.contact.solids.polytope import polytope
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.shapes import placed_shape as shapes

AROUND, UP = 48, 24
"""Corners of round shapes around their axis and along it: no level is in the middle of a side."""
DECIMALS = 12
"""To which corners that are found several times agree [m]."""


@lru_cache(maxsize=256)
def surface_points(shape: shapes.Shape, around: int = AROUND, up: int = UP) -> Array:
    """A cloud's points, or points whose hull looks like the shape; its own frame, (N, 3) [m].

    They are the corners of a box or a mesh, and of any other shape its farthest points along
    directions that are spread over the sphere. A half-space has none: see :func:`patch`.

    Parameters
    ----------
    shape : Shape
    around, up : int
        Numbers of directions around its axis and along it.
    """
    if isinstance(shape, shapes.PointCloud):
        return shape.points
    if isinstance(shape, shapes.HalfSpace):
        return np.zeros((0, 3))
    flat = polytope(shape)
    if flat is not None and not flat.margin:
        return flat.vertices
    down, turn = np.meshgrid(np.linspace(0, np.pi, up), np.arange(around) * (2 * np.pi / around))
    directions = [np.sin(down) * np.cos(turn), np.sin(down) * np.sin(turn), -np.cos(down)]
    every = np.array([shape.support_point(d) for d in np.reshape(directions, (3, -1)).T])
    return np.unique(every.round(DECIMALS), axis=0)


def patch(floor: shapes.HalfSpace, centre: Array, half_width: float) -> Array:
    """Corners of a square of a half-space's surface below the point `centre`, shape (4, 3) [m]."""
    n = floor.normal
    foot = centre - (n @ centre - floor.offset) * n
    one, other = np.concatenate(tangents(n[None]))
    around = np.array([-one - other, one - other, one + other, other - one])
    return np.asarray(foot + half_width * around)


def triangles(points: Array) -> Array:
    """Corners of the convex hull's triangles, shape (3T, 3), counter-clockwise from outside."""
    hull = ConvexHull(points)
    one, two, three = points[hull.simplices.T]
    outside = np.vecdot(np.cross(two - one, three - one), hull.equations[:, :3]) > 0
    corners = np.where(outside[:, None], [one, two, three], [one, three, two])
    return np.asarray(corners.transpose(1, 0, 2).reshape(-1, 3))
