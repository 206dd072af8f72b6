"""Volume, centre and inertia of a homogeneous solid, and the one that points enclose."""

from dataclasses import dataclass
from typing import Self

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import ConvexHull, Delaunay, QhullError

from quasistatic_ref.formats.plain import Plain
from quasistatic_ref.optional.scans.cloud import smoothed, spacing
from quasistatic_ref.step.arrays import Array, Indices

FACES = ((1, 2, 3), (0, 2, 3), (0, 1, 3), (0, 1, 2))
"""Corners of the face of a tetrahedron that lies across from each of its corners."""
PROBE = 3.0
"""Radius of the first probe, in spacings of the points [-]."""
WIDER = 2.0
"""Radius of each further probe over the one before [-]."""
HELD = 0.9
"""Share of the points that have to be on one connected solid [-]."""
LEAK = 2.0
"""Volume over that of the probe before, from which that one had got inside [-]."""
SHAKEN = 1e-3
"""How far points are shaken, in their spacing [-]: Qhull takes ten times as long if thousands lie
in one plane."""
MOST = 20_000
"""Most points whose tetrahedra are formed."""


@dataclass(frozen=True, eq=False)
class Solid(Plain):
    """A homogeneous solid.

    Parameters
    ----------
    volume : float
        [m^3]
    centre : ndarray, shape (3,)
        Of mass [m].
    gyration : ndarray, shape (3, 3)
        Inertia about the centre of mass for each kilogram [m^2].
    gap : float
        Radius of the probe that went around the points [m]; 0 of a mesh.
    """

    volume: float
    centre: Array
    gyration: Array
    gap: float = 0.0

    @classmethod
    def of_tetrahedra(cls, corners: Array, gap: float = 0.0) -> Self:
        """A solid of tetrahedra, shape (T, 4, 3) [m]; those with negative volume are taken away.

        The integral of x x' over one of them, of volume V and with corners x_i, is
        V/20 (s s' + sum of x_i x_i'), with s the sum of the x_i.
        """
        volumes = np.linalg.det(corners[:, 1:] - corners[:, :1]) / 6
        sums = corners.sum(axis=1)
        volume = volumes.sum()
        centre = volumes @ sums / 4 / volume
        second = np.einsum("t,ti,tj->ij", volumes, sums, sums)
        second += np.einsum("t,tki,tkj->ij", volumes, corners, corners)
        spread = second / 20 / volume - np.outer(centre, centre)
        return cls(float(volume), centre, np.trace(spread) * np.eye(3) - spread, gap)

    @classmethod
    def of_mesh(cls, vertices: Array, triangles: Indices) -> Self:
        """The inside of a closed mesh of vertices, (V, 3) [m], wound outwards, (T, 3)."""
        middle = vertices[triangles].mean(axis=(0, 1))
        tops = np.full((len(triangles), 1, 3), middle)
        return cls.of_tetrahedra(np.concatenate([tops, vertices[triangles]], axis=1))


def solid_of_points(points: Array) -> Solid | None:
    """The solid whose surface points were scanned, shape (N, 3) [m]; None if they enclose none.

    A ball rolls around the points and through every gap that is wider than itself: in the
    tetrahedra of Delaunay's triangulation, through each face whose circumscribed circle is larger.
    What it never reaches is the solid. The smallest ball is taken that does not get inside: of
    one that does, only splinters along the surface are left, and the next one finds far more.
    """
    try:
        ConvexHull(points)
    except QhullError:  # all of them lie in a plane
        return None
    points = smoothed(points)
    apart = spacing(points)
    points = points + SHAKEN * apart * np.random.default_rng(0).normal(size=points.shape)
    mesh = Delaunay(points)
    corners = points[mesh.simplices]
    ways = np.linalg.det(corners[:, 1:] - corners[:, :1]) < 0
    corners[ways] = corners[ways][:, [1, 0, 2, 3]]  # each volume positive
    volumes = abs(np.linalg.det(corners[:, 1:] - corners[:, :1]))
    radii = _circumscribed(points[mesh.simplices[:, FACES]])
    gap = PROBE * apart
    extent = float(np.ptp(points, axis=0).max())
    before: Solid | None = None
    while gap < 2 * extent:
        one = _largest_unreached(mesh.neighbors, radii > gap, volumes)
        solid = None
        if len(np.unique(mesh.simplices[one])) >= HELD * len(points):
            solid = Solid.of_tetrahedra(corners[one], gap)
        if solid is not None and before is not None and solid.volume < LEAK * before.volume:
            return before
        before = solid
        gap *= WIDER
    return before


def _largest_unreached(neighbours: Indices, passable: NDArray[np.bool_], volumes: Array) -> Indices:
    """Numbers of the tetrahedra of the largest part that no way leads to from outside.

    Parameters
    ----------
    neighbours : ndarray of int, shape (T, 4)
        -1 is the outside.
    passable : ndarray of bool, shape (T, 4)
        Faces that ways lead through.
    volumes : ndarray, shape (T,)
    """
    group = _joined(neighbours, passable)
    inside = np.append(group[:-1] != group[-1], False)
    part = _joined(neighbours, inside[:-1, None] & inside[neighbours])[:-1]
    inside = inside[:-1]
    return np.flatnonzero(inside & (part == np.bincount(part, volumes * inside).argmax()))


def _joined(neighbours: Indices, through: NDArray[np.bool_]) -> Indices:
    """Number of the part of each tetrahedron, and last of the outside, joined through faces."""
    n = len(neighbours)
    of, face = np.nonzero(through)
    links = coo_matrix((np.ones(len(of)), (of, neighbours[of, face] % (n + 1))), (n + 1, n + 1))
    return np.asarray(connected_components(links, directed=False)[1])


def _circumscribed(faces: Array) -> Array:
    """Radii of the circles through triangles, shape (T, 4, 3, 3) [m] -> (T, 4)."""
    a, b, c = np.moveaxis(faces, -2, 0)
    sides = [np.linalg.norm(side, axis=-1) for side in (b - c, c - a, a - b)]
    twice_area = np.linalg.norm(np.cross(b - a, c - a), axis=-1)
    product = sides[0] * sides[1] * sides[2]
    flat = twice_area <= 0
    return np.where(flat, np.inf, product / np.where(flat, 1.0, 2 * twice_area))
