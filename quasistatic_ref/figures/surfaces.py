"""Shapes as points whose hull looks like them, and hulls as polygons."""

import numpy as np
from scipy.spatial import ConvexHull

from quasistatic_ref.model import shapes
from quasistatic_ref.model.convex_mesh import ConvexMesh
from quasistatic_ref.step.data import Array, Indices

AROUND, UP = 48, 25
"""Corners of round shapes around their axis and along it."""

SAME_PLANE = 9
"""Decimals to which the planes of two triangles agree that are parts of one face."""


def surface_points(placed: shapes.PlacedShape, around: int = AROUND, up: int = UP) -> Array:
    """A cloud's points, or points whose hull looks like the shape; its own frame, (N, 3) [m].

    A half-space has none: see :func:`patch`.
    """
    shape = placed.shape
    if isinstance(shape, shapes.PointCloud):
        return shape.points
    if isinstance(shape, ConvexMesh):
        return shape.vertices
    if isinstance(shape, shapes.Box):
        signs = np.array(np.meshgrid([-1, 1], [-1, 1], [-1, 1])).reshape(3, -1).T
        return np.asarray(signs * shape.half_extents)
    if isinstance(shape, shapes.HalfSpace):
        return np.zeros((0, 3))
    angle = np.linspace(0, 2 * np.pi, around)
    circle = np.stack([np.cos(angle), np.sin(angle), np.zeros(around)], axis=1)
    if isinstance(shape, shapes.Cylinder | shapes.Cone):
        end = np.array([0, 0, shape.half_length])
        top = end[None] if isinstance(shape, shapes.Cone) else shape.radius * circle + end
        return np.concatenate([shape.radius * circle - end, top])
    azimuth, height = np.meshgrid(angle, np.linspace(-1, 1, up))
    r = np.sqrt(1 - height**2)
    ball = np.stack([r * np.cos(azimuth), r * np.sin(azimuth), height], axis=-1).reshape(-1, 3)
    if isinstance(shape, shapes.Ellipsoid):
        return np.asarray(ball * shape.half_axes)
    points = np.asarray(shape.radius * ball)
    if isinstance(shape, shapes.Capsule):
        end = np.array([0, 0, shape.half_length])
        return np.concatenate([points + end, points - end])
    assert isinstance(shape, shapes.Sphere)
    return points


def patch(floor: shapes.HalfSpace, centre: Array, half_width: float) -> Array:
    """Corners of a square of a half-space's surface below the point `centre`, shape (4, 3) [m]."""
    n = floor.normal
    foot = centre - (n @ centre - floor.offset) * n
    one = np.eye(3)[np.abs(n).argmin()]
    one = half_width * (one - (one @ n) * n) / np.linalg.norm(one - (one @ n) * n)
    other = np.cross(n, one)
    around = np.array([-one - other, one - other, one + other, other - one])
    return np.asarray(foot + around)


def triangles(points: Array) -> Indices:
    """Triangles of the convex hull as indices, (T, 3), counter-clockwise from outside."""
    hull = ConvexHull(points)
    corners = points[hull.simplices]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    inward = np.einsum("ti,ti->t", normal, hull.equations[:, :3]) < 0
    found = np.array(hull.simplices, dtype=np.int64)
    found[inward] = found[inward][:, [0, 2, 1]]
    return found


def faces(points: Array) -> list[Array]:
    """Faces of the convex hull, each with its corners in order, shapes (corners, 3)."""
    hull = ConvexHull(points)
    members: dict[tuple[float, ...], set[int]] = {}
    for simplex, plane in zip(hull.simplices, hull.equations, strict=True):
        members.setdefault(tuple(np.round(plane, SAME_PLANE)), set()).update(simplex.tolist())
    ordered = []
    for plane, corners in members.items():
        at = points[sorted(corners)]
        centre, normal = at.mean(axis=0), np.array(plane[:3])
        first = at[0] - centre
        angle = np.arctan2((at - centre) @ np.cross(normal, first), (at - centre) @ first)
        ordered.append(at[np.argsort(angle)])
    return ordered
