"""Hulls of what links are known by."""

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property
from itertools import product

import numpy as np

from quasistatic_ref.errors import ModelError
from quasistatic_ref.numbers.arrays import Array, Mask
from quasistatic_ref.shapes.convex_mesh import ConvexMesh, convex_hull
from quasistatic_ref.shapes.placed_shape import PlacedShape, Shape

WAYS = [np.array(way) / np.linalg.norm(way) for way in product((-1, 0, 1), repeat=3) if any(way)]
"""To the faces, edges and corners of a cube [-]."""
FLAT = 1e-6
"""Volume of a polytope in a cloud, over the cube of the cloud's extent [-], above which the cloud
surely has a hull."""
SEARCHED = 30
"""Steps of the search for a plane between a point and a hull."""


@dataclass(frozen=True, eq=False)
class CloudHull(Shape):
    """The convex hull of points, shape (N, 3) [m], which is formed only where bounds leave doubt.

    To form it takes SciPy, whose import alone takes as long as a short run.
    """

    points: Array

    @cached_property
    def hull(self) -> ConvexMesh:
        """The hull itself; a ModelError if all points are in a plane."""
        return convex_hull(self.points)

    @cached_property
    def tetrahedra(self) -> Array:
        """Two on both sides of one triangle, of points far apart, shape (2, 4, 3) [m]."""
        x = self.points
        a = x[np.square(x - x.mean(axis=0)).sum(axis=1).argmax()]
        b = x[np.square(x - a).sum(axis=1).argmax()]
        c = x[np.square(np.cross(x - a, b - a)).sum(axis=1).argmax()]
        heights = (x - a) @ np.cross(b - a, c - a)
        return np.array([[a, b, c, x[heights.argmax()]], [a, b, c, x[heights.argmin()]]])

    @cached_property
    def least_volume(self) -> float:
        """What the tetrahedra hold [m^3]."""
        edges = self.tetrahedra[:, 1:] - self.tetrahedra[:, :1]
        return float(np.abs(np.linalg.det(edges)).sum()) / 6

    @property
    def has_volume(self) -> bool:
        """Whether the points are not all in a plane."""
        if self.least_volume > FLAT * self.extent**3:
            return True
        with suppress(ModelError):
            return self.hull.volume > 0
        return False

    @property
    def most_volume(self) -> float:
        """What the box about the points holds [m^3]."""
        return float(np.prod(np.ptp(self.points, axis=0)))

    @property
    def volume(self) -> float:
        """What the hull encloses [m^3]."""
        return self.hull.volume

    @cached_property
    def extent(self) -> float:
        """Longest edge of the box about the points [m]."""
        return float(np.ptp(self.points, axis=0).max())

    def surely_holds(self, point: Array) -> bool:
        """Whether a point, shape (3,) [m], is in one of the tetrahedra."""
        for corners in self.tetrahedra:
            edges = (corners[1:] - corners[0]).T
            if np.linalg.det(edges):
                shares = np.linalg.solve(edges, point - corners[0])
                if shares.min() >= 0 and shares.sum() <= 1:
                    return True
        return False

    def signed_distance(self, points: Array) -> tuple[Array, Array]:
        """Signed distances and outward normals of the hull at `points`, shape (N, 3) [m]."""
        return self.hull.signed_distance(points)

    def support_point(self, direction: Array) -> Array:
        """The first point farthest along a `direction`; both of shape (3,), [m] and [-]."""
        return np.asarray(self.points[(self.points @ direction).argmax()])

    def corners(self, towards: Array) -> tuple[Array, float]:
        """All points, shape (N, 3) [m], whatever the direction `towards` [-] is."""
        return self.points, 0.0


def volume_bounds(shape: Shape) -> tuple[float, float]:
    """What a shape holds at least and at most [m^3]."""
    if isinstance(shape, CloudHull):
        return shape.least_volume, shape.most_volume
    return shape.volume, shape.volume


def holds(placed: PlacedShape, point: Array) -> bool:
    """Whether a point of the link's frame, shape (3,) [m], is in a shape."""
    seen = (point - placed.t) @ placed.R
    if isinstance(placed.shape, CloudHull) and placed.shape.surely_holds(seen):
        return True
    return bool(placed.shape.signed_distance(seen[None])[0][0] <= 0)


def surely_outside(points: Array, corners: Array) -> Mask:
    """Which points a plane is known to separate from all corners of a hull, shape (K,).

    Gilbert's search: v runs to the shortest vector from the point to the hull. Where no corner is
    behind the plane through the point across v, the point is outside.

    Parameters
    ----------
    points, corners : ndarray, shapes (K, 3) and (n, 3)
        [m].
    """
    outside = np.zeros(len(points), dtype=bool)
    v = corners.mean(axis=0) - points
    for _ in range(SEARCHED if len(points) else 0):
        nearest = corners[(v @ corners.T).argmin(axis=1)] - points
        outside |= (v * nearest).sum(axis=1) > 0
        edge = nearest - v
        length = (edge * edge).sum(axis=1)
        share = np.clip(-(v * edge).sum(axis=1) / np.where(length == 0, 1.0, length), 0.0, 1.0)
        v += share[:, None] * edge
        if outside.all():
            break
    return outside


def corners_of(shapes: Sequence[PlacedShape]) -> Array:
    """Points whose hull stands for a link's shapes, in its frame, shape (n, 3) [m]."""
    corners = [placed.shape.corners(WAYS[0])[0] @ placed.R.T + placed.t for placed in shapes]
    return np.concatenate([*map(farthest_points, shapes), *corners])


def hull_of(shapes: Sequence[PlacedShape]) -> ConvexMesh | None:
    """Convex hull of a link's shapes, in its frame; None if they are flat."""
    with suppress(ModelError):
        return convex_hull(corners_of(shapes))
    return None


def farthest_points(placed: PlacedShape) -> Array:
    """The points of a shape that are farthest in the WAYS, in the frame of its link, (n, 3) [m]."""
    farthest = np.array([placed.shape.support_point(way) for way in WAYS])
    return farthest @ placed.R.T + placed.t
