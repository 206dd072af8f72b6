"""How contacts rank, and which points of a cloud may be among the k that rank first.

Signed distances are rounded before they rank; of equal ranks the least number is first. A rank
never falls where the gap rises. Let r be the largest rank of any k points: the k-th best rank of
all is no more than r. A point whose gap is at least a bound that ranks after r ranks after r
itself, and is none of the first k. The others stay in the cloud's order, which decides ties.
"""

from typing import Final

import numpy as np

from quasistatic_ref.contact.shape_in_world import moved
from quasistatic_ref.numbers.arrays import Array, Indices
from quasistatic_ref.shapes.convex_mesh import ConvexMesh
from quasistatic_ref.shapes.facets import FEW
from quasistatic_ref.shapes.placed_shape import PointCloud, Shape
from quasistatic_ref.shapes.point_cloud import GROUP

MANY: Final = 4096
"""Points of a cloud from which groups of neighbours are dropped at once."""


def rounded_gaps(phi: Array, resolution: float) -> Array:
    """Signed distances as numbers of the nearest multiple of a length, for ranking.

    Zero is the middle of its multiple: what touches stays there, however rounding moves it.

    Parameters
    ----------
    phi : ndarray, shape (N,)
        [m].
    resolution : float
        [m]; 0 rounds nothing.

    Returns
    -------
    ndarray, shape (N,)
        [-], or `phi` where nothing is rounded.
    """
    return np.rint(phi / resolution) if resolution else phi


def closest(phi: Array, k: int) -> Indices:
    """Indices of the k smallest signed distances in ascending order, ties broken by index.

    Parameters
    ----------
    phi : ndarray, shape (N,)
    k : int
        All of them if k >= N.

    Returns
    -------
    ndarray of int, shape (min(k, N),)
    """
    if k < len(phi):
        kth = np.partition(phi, k - 1)[k - 1]
        near = np.flatnonzero(~(phi > kth))  # and all that tie with it
        return near[phi[near].argsort(kind="stable")][:k]
    return phi.argsort(kind="stable")


def may_be_first(
    solid: Shape, bound: Array, some: Array, k: int, resolution: float = 0.0
) -> Indices:
    """Numbers of bounds that do not rank after the distance of each of some k points.

    Parameters
    ----------
    solid : Shape
    bound : ndarray, shape (N,)
        Lower bounds of distances of points or groups of them [m].
    some : ndarray, shape (M, 3)
        At least k of the points, in the solid's frame [m].
    k : int
    resolution : float
        [m].
    """
    ranks = rounded_gaps(solid.signed_distance(some)[0], resolution)
    return np.flatnonzero(rounded_gaps(bound, resolution) <= np.partition(ranks, k - 1)[k - 1])


def near_points(
    solid: Shape, cloud: PointCloud, pose: Array, k: int, resolution: float
) -> tuple[Indices, Array]:
    """The points of a cloud among which are the k that rank first: all, but of a convex mesh fewer.

    Parameters
    ----------
    solid : Shape
    cloud : PointCloud
    pose : ndarray, shape (3, 4)
        [R, t] from the cloud's frame to the solid's [-, m].
    k : int
    resolution : float
        Length to whose multiples distances are rounded before they rank [m].

    Returns
    -------
    number : ndarray of int, shape (M,)
        In ascending order.
    x : ndarray, shape (M, 3)
        The points in the solid's frame [m].
    """
    points = cloud.points
    number = np.arange(len(points))
    if not isinstance(solid, ConvexMesh) or k >= len(points):
        return number, moved(pose, points)

    facets = solid.facets
    if len(points) >= MANY:
        groups = cloud.groups
        bound = facets.above_planes(moved(pose, groups.middle)) - groups.reach
        likely = bound.argsort()[: 1 + 2 * k // GROUP]  # none has fewer than half of GROUP
        some = np.concatenate([groups.points[i] for i in likely])
        kept = may_be_first(solid, bound, moved(pose, points[some]), k, resolution)
        number = np.sort(np.concatenate([groups.points[i] for i in kept]))
    x = moved(pose, points[number])
    for above in (facets.above_planes, facets.above_faces)[len(facets.normals) <= FEW :]:
        bound = above(x)
        nearest = x[bound.argpartition(k - 1)[:k]]
        kept = may_be_first(solid, bound, nearest, k, resolution)
        number = number[kept]
        x = x[kept]
    return number, x
