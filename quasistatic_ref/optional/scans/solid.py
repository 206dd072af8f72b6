"""Volume, centre and inertia of a homogeneous solid."""

from dataclasses import dataclass
from typing import Self

import numpy as np
import trimesh
from scipy.spatial import ConvexHull, QhullError

from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.text.plain import Plain


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
    """

    volume: float
    centre: Array
    gyration: Array

    @classmethod
    def of_triangles(cls, triangles: Array) -> Self:
        """What triangles, shape (T, 3, 3) [m], enclose; they are wound outwards."""
        middle = triangles.mean(axis=(0, 1))  # far from it sums would lose digits
        mass = trimesh.triangles.mass_properties(triangles - middle, density=1.0)
        return cls(float(mass.volume), mass.center_mass + middle, mass.inertia / mass.volume)


def hull_of_points(points: Array) -> Solid | None:
    """The convex hull of points, shape (N, 3) [m]; None if all of them lie in a plane."""
    try:
        hull = ConvexHull(points)
    except QhullError:
        return None
    triangles = points[hull.simplices]
    inward = np.vecdot(trimesh.triangles.cross(triangles), hull.equations[:, :3]) < 0
    triangles[inward] = triangles[inward][:, ::-1]
    return Solid.of_triangles(triangles)
