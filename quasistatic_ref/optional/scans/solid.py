"""Volume, centre and inertia of a homogeneous solid, and the one that points enclose."""

from dataclasses import dataclass
from typing import Self

import numpy as np
import trimesh
from scipy.spatial import ConvexHull, Delaunay, QhullError

from quasistatic_ref.formats.plain import Plain
from quasistatic_ref.numbers.arrays import Array, Indices, Mask
from quasistatic_ref.optional.scans.cloud import smoothed, spacing

FACES = ((1, 2, 3), (0, 3, 2), (0, 1, 3), (0, 2, 1))
"""Corners of the face of a tetrahedron that lies across from each of its corners, wound outwards
if its volume is positive."""
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
    def of_triangles(cls, triangles: Array, gap: float = 0.0) -> Self:
        """What triangles, shape (T, 3, 3) [m], enclose; they are wound outwards."""
        middle = triangles.mean(axis=(0, 1))  # far from it sums would lose digits
        mass = trimesh.triangles.mass_properties(triangles - middle, density=1.0)
        return cls(float(mass.volume), mass.center_mass + middle, mass.inertia / mass.volume, gap)


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
    volumes = np.linalg.det(corners[:, 1:] - corners[:, :1])
    triangles = corners[:, FACES]
    triangles[volumes < 0] = triangles[volumes < 0][:, :, ::-1]
    volumes = abs(volumes)
    radii = _circumscribed(triangles)
    gap = PROBE * apart
    extent = float(np.ptp(points, axis=0).max())
    before: Solid | None = None
    while gap < 2 * extent:
        one = _largest_unreached(mesh.neighbors, radii > gap, volumes)
        solid = None
        if len(np.unique(mesh.simplices[one])) >= HELD * len(points):
            solid = Solid.of_triangles(triangles[one].reshape(-1, 3, 3), gap)
        if solid is not None and before is not None and solid.volume < LEAK * before.volume:
            return before
        before = solid
        gap *= WIDER
    return before


def _largest_unreached(neighbours: Indices, passable: Mask, volumes: Array) -> Indices:
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


def _joined(neighbours: Indices, through: Mask) -> Indices:
    """Number of the part of each tetrahedron, and last of the outside, joined through faces."""
    n = len(neighbours)
    of, face = np.nonzero(through)
    links = np.stack([of, neighbours[of, face] % (n + 1)], axis=1)
    return np.asarray(trimesh.graph.connected_component_labels(links, n + 1))


def _circumscribed(triangles: Array) -> Array:
    """Radii of the circles through triangles, shape (T, 4, 3, 3) [m] -> (T, 4)."""
    sides = np.linalg.norm(triangles - np.roll(triangles, 1, axis=2), axis=3)
    areas = trimesh.triangles.area(triangles.reshape(-1, 3, 3)).reshape(-1, 4)
    radii = np.full(areas.shape, np.inf)
    np.divide(sides.prod(axis=2), 4 * areas, out=radii, where=areas > 0)
    return radii
