"""Convex polytopes: the hull of a mesh's vertices, and how far the mesh is from being it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Final

import numpy as np
from numpy.typing import ArrayLike

from quasistatic_ref.errors import ModelError
from quasistatic_ref.numbers.arrays import Array, Indices, checked_numbers
from quasistatic_ref.numbers.ordered import dot, norm, product
from quasistatic_ref.shapes.facets import Facets
from quasistatic_ref.shapes.frozen import freeze_array
from quasistatic_ref.shapes.shape import CHUNK, Shape, dimensions
from quasistatic_ref.tolerances import ON_SURFACE, OUTSIDE_FACE

CONVEX_EXCESS: Final = 1e-3
"""Largest excess of a convex hull over its mesh, relative to size and to volume, at which the mesh
counts as convex [-]. Single precision and coarse modelling leave 1e-5; a real dent is larger."""


@dataclass(frozen=True, eq=False)
class ConvexMesh(Shape):
    """A convex polytope; made by :func:`convex_hull` or :func:`hull_of_mesh`.

    Parameters
    ----------
    vertices : ndarray, shape (V, 3)
        Its corners [m].
    triangles : ndarray of int, shape (T, 3)
        Its surface; corners counter-clockwise from outside.
    normals, offsets : ndarray, shapes (T, 3) and (T,)
        Outward unit normal [-] and offset [m] of each triangle's plane: x is inside where
        normals @ x <= offsets. Coplanar triangles share equal bits.
    hull_volume : float
        What it encloses [m^3].
    excess : float
        How much more than the mesh that it stands for it holds, from 0 (that mesh is convex)
        to 1 [-]; see :func:`hull_of_mesh`.
    surface : ndarray, shape (S, 3, 3), optional
        Corners of the triangles of that mesh [m], if it is not convex.
    """

    vertices: Array
    triangles: Indices
    normals: Array
    offsets: Array
    hull_volume: float
    excess: float = 0.0
    surface: Array | None = None

    def __post_init__(self) -> None:
        T = len(self.triangles)
        freeze_array(self, "vertices", (len(self.vertices), 3))
        freeze_array(self, "normals", (T, 3))
        freeze_array(self, "offsets", (T,))
        self.triangles.setflags(write=False)
        if self.surface is not None:
            freeze_array(self, "surface", (len(self.surface), 3, 3))

    @property
    def is_convex(self) -> bool:
        """Whether the mesh that was read equals its own convex hull."""
        return self.excess <= CONVEX_EXCESS

    def signed_distance(self, points: Array) -> tuple[Array, Array]:
        """Signed distances and outward normals of `points`, shape (N, 3) [m].

        Inside, the largest of the signed distances to the planes of its faces, which is exact;
        outside, the distance to the nearest triangle. The normal is that of a face, unless an edge
        or a corner is the closest feature. Each point is computed by itself, so that its bits do
        not depend on the other points.
        """
        phi = np.empty(len(points))
        normal = np.empty((len(points), 3))
        count = max(1, CHUNK // len(self.triangles))
        for start in range(0, len(points), count):
            some = slice(start, start + count)
            phi[some], normal[some] = self._distance(points[some])
        return phi, normal

    def _distance(self, points: Array) -> tuple[Array, Array]:
        """The same as `signed_distance`, of points few enough for one batch."""
        level, _ = self.faces(points)
        face = level.argmax(axis=1)
        phi = level[np.arange(len(points)), face]
        normal = self.normals[face].copy()
        outside = np.flatnonzero(phi > 0)
        if len(outside):
            away = self.facets.offsets_from(points[outside])
            distance = norm(away)
            # Near the surface p - x is all rounding; the face's normal is right to that distance.
            size = np.abs(self.vertices).max()
            sideways = norm(away - phi[outside, None] * normal[outside])
            edge = (sideways > OUTSIDE_FACE * size) & (distance > ON_SURFACE * size)
            at = outside[edge]
            phi[at] = distance[edge]
            normal[at] = away[edge] / distance[edge, None]
        return phi, normal

    @cached_property
    def facets(self) -> Facets:
        """The hull's triangles, prepared for distances."""
        return Facets(self.vertices[self.triangles], self.normals, self.offsets)

    def faces(self, points: Array) -> tuple[Array, Array]:
        """Heights of `points`, shape (N, 3) [m], above all triangles' planes, and normals."""
        n = self.normals
        x, y, z = points.T[:, :, None]
        heights = x * n[:, 0] + y * n[:, 1] + z * n[:, 2] - self.offsets
        return heights, np.broadcast_to(n, (*heights.shape, 3))

    def support_point(self, direction: Array) -> Array:
        """The first vertex farthest along a `direction`; both of shape (3,), [m] and [-]."""
        return np.asarray(self.vertices[dot(self.vertices, direction).argmax()])

    def support_value(self, directions: Array) -> Array:
        """Reach of the vertices along `directions` (N, 3) [-], shape (N,) [m]."""
        return np.asarray(product(directions, self.vertices.T).max(axis=1))

    def corners(self, towards: Array) -> tuple[Array, float]:
        """The mesh's vertices, shape (V, 3) [m], whatever the direction `towards` [-] is."""
        return self.vertices, 0.0

    @property
    def volume(self) -> float:
        """What the hull encloses [m^3]."""
        return self.hull_volume

    @property
    def edge_count(self) -> int:
        """Upper bound of a face's number of edges: the number of all vertices."""
        return len(self.vertices)

    def words(self) -> str:
        """Kind, number of corners, and the edges of the box about them [m]."""
        extent = dimensions(np.ptp(self.vertices, axis=0))
        what = "convex mesh" if self.is_convex else "convex hull of a mesh"
        return f"{what}, {len(self.vertices)} corners within {extent}"


def convex_hull(points: ArrayLike) -> ConvexMesh:
    """Convex hull of some points.

    Parameters
    ----------
    points : array_like, shape (N, 3)
        At least four, not in one plane [m]; corners keep their order, the others are dropped.

    Raises
    ------
    ModelError
        If the points are too few or not finite, or lie in one plane.

    Examples
    --------
    >>> tetrahedron = qr.convex_hull(np.vstack([np.zeros(3), 0.1 * np.eye(3)]))
    >>> phi, n = tetrahedron.signed_distance(np.array([[-0.01, 0.01, 0.01]]))
    >>> phi.round(12)  # [m]
    array([0.01])
    """
    from scipy.spatial import ConvexHull, QhullError  # takes as long as a short run

    points = checked_numbers(points, "vertices", ModelError)
    if points.ndim != 2 or points.shape[1:] != (3,) or len(points) < 4:
        problem = "must be at least four points, as an array of shape (N, 3)"
        raise ModelError(problem, field="vertices", value=points.shape)
    if not np.isfinite(points).all():
        k = int(np.isfinite(points).all(axis=1).argmin())
        problem = "must be finite numbers"
        raise ModelError(problem, field=f"vertices[{k}]", value=points[k].tolist())
    try:
        hull = ConvexHull(points)
    except QhullError:
        problem = "must not lie in one plane: a convex mesh needs a volume"
        raise ModelError(problem, field="vertices", value=f"{len(points)} points") from None
    kept = np.sort(hull.vertices).astype(np.int64)
    renumbered = np.zeros(len(points), dtype=np.int64)
    renumbered[kept] = np.arange(len(kept))
    vertices = points[kept]
    triangles = renumbered[hull.simplices]
    normals = hull.equations[:, :3]
    offsets = -hull.equations[:, 3]
    a, b, c = vertices[triangles].transpose(1, 0, 2)
    inward = np.sum(np.cross(b - a, c - a) * normals, axis=1) < 0
    triangles[inward] = triangles[inward][:, ::-1]
    return ConvexMesh(vertices, triangles, normals, offsets, float(hull.volume))


def hull_of_mesh(vertices: ArrayLike, triangles: Indices) -> ConvexMesh:
    """Hull of all vertices of a triangle mesh, knowing how much more it holds.

    ``excess`` is the part of the hull's volume that the mesh does not enclose or, where that is
    next to nothing, the depth of the mesh's deepest vertex below the hull's surface relative to
    the hull's size, if larger. An open or inconsistently wound mesh encloses no volume worth the
    name, and counts as not convex.

    Parameters
    ----------
    vertices : array_like, shape (N, 3)
        [m].
    triangles : ndarray of int, shape (T, 3)

    Raises
    ------
    ModelError
        If the vertices are not finite, or lie in one plane.
    """
    points = np.array(vertices, dtype=np.float64)
    every = np.unique(points, axis=0)
    hull = convex_hull(every)
    a, b, c = (points[triangles] - hull.vertices.mean(axis=0)).transpose(1, 0, 2)
    enclosed = abs(float(np.sum(a * np.cross(b, c)))) / 6
    excess = abs(hull.volume - enclosed) / hull.volume
    if excess <= CONVEX_EXCESS:
        deepest = -hull.signed_distance(every)[0].min()
        excess = max(excess, float(deepest / np.ptp(every, axis=0).max()))
    surface = points[triangles] if excess > CONVEX_EXCESS else None
    return replace(hull, excess=min(excess, 1.0), surface=surface)
