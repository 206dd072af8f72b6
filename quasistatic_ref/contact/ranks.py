"""How contacts rank, and which points of a cloud may be among the k that rank first.

Signed distances are rounded before they rank; of equal ranks the least number is first. A rank
never falls where the gap rises. Let r be the largest rank of any k points: the k-th best rank of
all is no more than r. A point whose gap is at least a bound that ranks after r ranks after r
itself, and is none of the first k. The others stay in the cloud's order, which decides ties.
"""

from collections.abc import Sequence
from typing import Final

import numpy as np

from quasistatic_ref.contact.shape_in_world import Pose
from quasistatic_ref.numbers.arrays import Array, Indices
from quasistatic_ref.numbers.ordered import dot, product
from quasistatic_ref.shapes.convex_mesh import ConvexMesh
from quasistatic_ref.shapes.facets import FEW_FACETS
from quasistatic_ref.shapes.placed_shape import PointCloud, Shape
from quasistatic_ref.shapes.point_cloud import Groups

MANY_POINTS: Final = 4096
"""Points of a cloud from which groups of neighbours are dropped at once."""

ROUNDED: Final = 1e-8
"""How much bounds of groups give way, of sizes and places [-]: more than what rounding changes, and
what a pose stretches whose rotation is one to 1e-9."""


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


def cannot_be_excluded(
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
    solid: Shape, cloud: PointCloud, pose: Pose, k: int, resolution: float
) -> tuple[Indices, Array]:
    """Points of a cloud among which are the k that rank first: of a large cloud few, or of a mesh.

    Parameters
    ----------
    solid : Shape
    cloud : PointCloud
    pose : Pose
        Of the cloud's frame in the solid's.
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
    number = np.arange(len(cloud.points))
    if len(number) >= MANY_POINTS and k < len(number):
        number = points_of_groups(solid, cloud, pose, k, resolution)
    x = pose.points(cloud.points[number])
    if not isinstance(solid, ConvexMesh) or k >= len(number):
        return number, x

    facets = solid.facets
    for above in (facets.above_planes, facets.above_faces)[len(facets.normals) <= FEW_FACETS :]:
        bound = above(x)
        nearest = x[bound.argpartition(k - 1)[:k]]
        kept = cannot_be_excluded(solid, bound, nearest, k, resolution)
        number = number[kept]
        x = x[kept]
    return number, x


def points_of_groups(
    solid: Shape, cloud: PointCloud, pose: Pose, k: int, resolution: float
) -> Indices:
    """Numbers, in ascending order, of the points of all groups that may hold one of the first k.

    `resolution` is that of gaps [m].

    The signed distance from a convex solid is convex, with the normal as its slope: at p it is at
    least phi + n . (p - c) of the middle c of a cuboid. Down the nearest cuboids are k points, and
    none counts that is farther than the last of these. The arguments are those of
    :func:`near_points`.
    """

    def least(level: Groups, some: Indices) -> Array:
        """Lower bounds of distances of some groups [m]."""
        x = pose.points(level.middle[some])
        phi, n = solid.signed_distance(x)
        half = level.half[some]
        rounded = ROUNDED * (np.abs(x).max() + np.abs(phi).max() + half.max())
        return np.asarray(phi - dot(np.abs(product(n, pose.R)), half) - rounded)

    def members(level: Groups, some: Indices) -> Indices:
        return np.unique(level.members[some])

    def kth(levels: Sequence[Groups], number: Indices) -> float:
        """The distance of the farthest of k points, which are of near groups of some [m]."""
        for level in levels:
            count = min(len(number), -(-k // level.fewest))  # so many groups have k points
            number = members(level, number[least(level, number).argpartition(count - 1)[:count]])
        phi, _ = solid.signed_distance(pose.points(cloud.points[number]))
        return float(np.partition(phi, k - 1)[k - 1])

    number = np.arange(len(cloud.levels[0].members))
    for i, level in enumerate(cloud.levels):
        after = kth(cloud.levels[i:], number) + 2 * resolution
        number = members(level, number[~(least(level, number) > after)])
    return number
