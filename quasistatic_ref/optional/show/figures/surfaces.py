"""Shapes as points whose hull looks like them, and hulls as polygons."""

from functools import lru_cache

import numpy as np
from scipy.sparse import csr_array
from scipy.spatial import ConvexHull

from quasistatic_ref.contact.jacobian import tangents
from quasistatic_ref.contact.solids.polytope import polytope
from quasistatic_ref.shapes import placed_shape as shapes
from quasistatic_ref.step.data import Array

AROUND, UP = 48, 24
"""Corners of round shapes around their axis and along it: no level is in the middle of a side."""
DECIMALS = 12
"""To which corners that are found several times agree [m]."""

ROUND = 0.8
"""Cosine of the angle between triangles at a corner above which the surface is round there [-]."""


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
    every = np.array([shape.support_point(direction) for direction in ball(around, up)])
    return np.unique(every.round(DECIMALS), axis=0)


def ball(around: int, up: int) -> Array:
    """Points of the unit sphere, shape (up around, 3) [-]."""
    azimuth, height = np.meshgrid(np.linspace(0, 2 * np.pi, around), np.linspace(-1, 1, up))
    r = np.sqrt(1 - height**2)
    points = np.stack([r * np.cos(azimuth), r * np.sin(azimuth), height], axis=-1)
    return points.reshape(-1, 3)


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
    corners = points[hull.simplices]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    inward = np.einsum("ti,ti->t", normal, hull.equations[:, :3]) < 0
    corners[inward] = corners[inward][:, [0, 2, 1]]
    return np.asarray(corners.reshape(-1, 3))


def normals(corners: Array) -> Array:
    """Normals at the corners of a surface's triangles, shape (3T, 3): means where it is round.

    Parameters
    ----------
    corners : ndarray, shape (3T, 3)
        Three of each triangle [m].
    """
    first, second, third = corners.reshape(-1, 3, 3).transpose(1, 0, 2)
    flat = np.cross(second - first, third - first).repeat(3, axis=0)
    _, place = np.unique(corners.round(DECIMALS), axis=0, return_inverse=True)
    at = csr_array((np.ones(len(corners)), (np.arange(len(corners)), place.ravel())))
    one, other = (at @ at.T).nonzero()  # corners that are at one place
    alike = np.einsum("ci,ci->c", _unit(flat)[one], _unit(flat)[other]) > ROUND
    near = csr_array((np.ones(alike.sum()), (one[alike], other[alike])), shape=(len(corners),) * 2)
    return _unit(near @ flat)


def _unit(vectors: Array) -> Array:
    return np.asarray(vectors / np.maximum(np.linalg.norm(vectors, axis=1, keepdims=True), 1e-300))
