"""Signed distance of points to a convex polytope, vectorised over points and triangles."""

from typing import Protocol

import numpy as np

from quasistatic_ref.step.arrays import Array, Indices
from quasistatic_ref.step.ordered import dot, norm
from quasistatic_ref.tolerances import ON_SURFACE, OUTSIDE_FACE

CHUNK = 1 << 17
"""Points times triangles handled at once: some tens of megabytes."""


class Polytope(Protocol):
    """The surface of a convex polytope, in triangles."""

    @property
    def vertices(self) -> Array:
        """Shape (V, 3) [m]."""

    @property
    def triangles(self) -> Indices:
        """Three vertices each, shape (T, 3)."""

    @property
    def normals(self) -> Array:
        """Outward unit normals, shape (T, 3) [-]."""

    @property
    def offsets(self) -> Array:
        """Of the planes normal . x = offset, shape (T,) [m]."""


def distance_to_hull(points: Array, hull: Polytope) -> tuple[Array, Array]:
    """Signed distance and outward normal of points (N, 3) against a convex polytope.

    Inside, the largest of the signed distances to the planes of its faces, which is exact;
    outside, the distance to the nearest triangle. Each point is computed by itself: its bits do not
    depend on which other points are given.

    Returns
    -------
    phi : ndarray, shape (N,)
        [m].
    normal : ndarray, shape (N, 3)
        That of the face, unless an edge or a corner is the closest feature.
    """
    phi = np.empty(len(points))
    normal = np.empty((len(points), 3))
    count = max(1, CHUNK // len(hull.triangles))
    for start in range(0, len(points), count):
        some = slice(start, start + count)
        phi[some], normal[some] = _distance(points[some], hull)
    return phi, normal


def _distance(points: Array, hull: Polytope) -> tuple[Array, Array]:
    level = levels(points, hull)
    face = level.argmax(axis=1)
    phi = level[np.arange(len(points)), face]
    normal = hull.normals[face].copy()
    outside = np.flatnonzero(phi > 0)
    if len(outside):
        away = nearest_offsets(points[outside], hull)
        distance = norm(away)
        # Near the surface p - x is all rounding; the face's normal is right to that distance.
        size = np.abs(hull.vertices).max()
        sideways = norm(away - phi[outside, None] * normal[outside])
        edge = (sideways > OUTSIDE_FACE * size) & (distance > ON_SURFACE * size)
        at = outside[edge]
        phi[at] = distance[edge]
        normal[at] = away[edge] / distance[edge, None]
    return phi, normal


def levels(points: Array, hull: Polytope) -> Array:
    """Heights of points (N, 3) above the planes of all triangles, shape (N, T) [m]."""
    x, y, z = points.T[:, :, None]
    level = x * hull.normals[:, 0] + y * hull.normals[:, 1] + z * hull.normals[:, 2] - hull.offsets
    return np.asarray(level)


def nearest_offsets(points: Array, hull: Polytope) -> Array:
    """From the nearest point of the surface's triangles to each point outside, shape (N, 3)."""
    corners = hull.vertices[hull.triangles]
    best = np.full(len(points), np.inf)
    offset = np.zeros((len(points), 3))
    rows = np.arange(len(points))
    for k in range(3):
        # The nearest point of an edge, clamped to its ends.
        tail = corners[:, k]
        along = corners[:, (k + 1) % 3] - corners[:, k]
        arm = points[:, None] - tail
        s = np.clip(dot(arm, along) / dot(along, along), 0.0, 1.0)
        away = arm - s[..., None] * along
        square = dot(away, away)
        i = square.argmin(axis=1)
        nearer = square[rows, i] < best
        best = np.where(nearer, square[rows, i], best)
        offset = np.where(nearer[:, None], away[rows, i], offset)
    # Inside a face, where the projection on its plane falls within the triangle.
    n = hull.normals
    within = np.ones((len(points), len(n)), dtype=bool)
    for k in range(3):
        tail = corners[:, k]
        along = corners[:, (k + 1) % 3] - corners[:, k]
        within &= dot(points[:, None] - tail, np.cross(n, along)) >= 0
    level = dot(points[:, None] - corners[:, 0], n)
    above = within & (level > 0)
    # A point above the inside of a face is nearest to that face. If an edge seems nearer, that is
    # rounding, and the edge's direction is the less accurate one. For a point on a face, rounding
    # decides the sign of its level.
    some = np.asarray(above.any(axis=1))
    best = np.where(some, np.inf, best)
    square = np.where(np.where(some[:, None], above, within), level * level, np.inf)
    i = square.argmin(axis=1)
    nearer = square[rows, i] < best
    return np.where(nearer[:, None], level[rows, i, None] * n[i], offset)
