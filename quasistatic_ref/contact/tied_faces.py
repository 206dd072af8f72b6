"""Which normal a contact has where a point is as near to one face as to another.

Of two convex solids it is the pair's, the direction n of the largest gap s(n): a corner over a face
that faces n has this face's normal, and a corner on the edge or vertex that is farthest along n
has n. A cloud need not be convex: its points have their own faces, and of faces that are as near
within rounding the one along which the whole cloud is farthest out. docs/conventions.md states the
rule, (R37) says why bodies that touch bear along no other normal.
"""

import numpy as np

from quasistatic_ref.contact.separations import (
    BISECTOR,
    OF_CLOUD,
    OF_PAIR,
    UNIQUE_NORMAL,
    distinct,
    mean_direction,
    refuse_unless_touching,
    rounding,
)
from quasistatic_ref.contact.shape_in_world import ShapeInWorld, moved
from quasistatic_ref.numbers.angles import cos_sin
from quasistatic_ref.numbers.arrays import Array, Indices, Mask
from quasistatic_ref.numbers.ordered import dot, product
from quasistatic_ref.shapes.placed_shape import HalfSpace, PointCloud, Shape
from quasistatic_ref.shapes.shape import CHUNK
from quasistatic_ref.tolerances import FACING, SAME_NORMAL

TURNED = cos_sin(FACING)[0]
"""Least cosine of the angle between the pair's normal and that of a face or corner that bears."""


Surface = tuple[Array, Array, Indices]
"""What N points have on a solid, in its frame: phi, (N,) [m]; the normal, (N, 3) [-]; and how that
was chosen, (N,)."""


def faces_apart(heights: Array, normals: Array, within: float | Array) -> tuple[Indices, Mask]:
    """The highest face of each point, and all faces as high that have another normal.

    Parameters
    ----------
    heights : ndarray, shape (N, F)
        As of :meth:`~quasistatic_ref.shapes.shape.Shape.faces`, F > 0 [m].
    normals : ndarray, shape (N, F, 3)
        [-].
    within : float or ndarray, shape (N,)
        Largest difference of heights that are equal [m].

    Returns
    -------
    highest : ndarray of int, shape (N,)
    rivals : ndarray of bool, shape (N, F)
    """
    every = np.arange(len(heights))
    highest = heights.argmax(axis=1)
    level = heights >= (heights[every, highest] - within)[:, None]
    away = np.abs(normals - normals[every, highest][:, None]).max(axis=2)
    return highest, level & (away > SAME_NORMAL)


def corner_surface(
    shape: Shape, x: Array, n: Array, within: float | Array, near: float | Array
) -> Surface:
    """Distances and normals of another solid's corners on a solid.

    Parameters
    ----------
    shape : Shape
    x : ndarray, shape (N, 3)
        In its frame [m].
    n : ndarray, shape (3,) or (N, 3)
        The pair's normal out of the solid, in its frame [-].
    within, near : float or ndarray, shape (N,)
        What is rounding, and how far above a face a corner is over it [m].
    """
    phi, normal = shape.signed_distance(x)
    tie = np.full(len(x), UNIQUE_NORMAL)
    if isinstance(shape, HalfSpace):
        return phi, normal, tie
    # Another corner is outside, and nearest to a face that faces n: nothing else to choose.
    within = within + np.zeros(len(x))
    near = near + np.zeros(len(x))
    undecided = np.flatnonzero((phi <= near) | (dot(normal, n) < TURNED))
    reach = shape.support_value(np.atleast_2d(n)) + np.zeros(len(x))
    n = np.broadcast_to(n, x.shape)
    phi = phi.copy()
    before = normal
    normal = normal.copy()
    block = max(1, CHUNK // max(1, shape.at_points(slice(1)).faces(x[:1])[0].size))
    for start in range(0, len(undecided), block):
        some = undecided[start : start + block]
        known = phi[some], normal[some]
        there = shape.at_points(some)
        over, phi[some], normal[some] = _facing(
            there, x[some], n[some], *known, within[some], near[some]
        )
        edge = some[~over]
        gap = dot(x[edge], n[edge]) - reach[edge]
        on_edge = _over(shape.at_points(edge), x[edge], gap, n[edge], near[edge])
        phi[edge[on_edge]] = gap[on_edge]
        normal[edge[on_edge]] = n[edge[on_edge]]
    tie[dot(before, normal) < 1 - SAME_NORMAL] = OF_PAIR
    return phi, normal, tie


def _facing(
    shape: Shape, x: Array, n: Array, phi: Array, normal: Array, within: Array, near: Array
) -> tuple[Mask, Array, Array]:
    """Mask of points over a face that faces n, and their normals, gaps and feet there."""
    heights, normals = shape.faces(x)
    if not heights.size:
        return np.zeros(len(x), dtype=bool), phi, normal
    heights = np.where(dot(normals, n[:, None]) >= TURNED, heights, -np.inf)
    face, rivals = faces_apart(heights, normals, within)
    chosen = np.arange(len(x)), face
    height = heights[chosen]
    facing = normals[chosen]
    over = _over(shape, x, height, facing, near) & ~rivals.any(axis=1)
    return over, np.where(over, height, phi), np.where(over[:, None], facing, normal)


def _over(shape: Shape, x: Array, height: Array, normal: Array, near: Array) -> Mask:
    """Mask of points at most at a plane's height whose feet on the plane lie on the shape."""
    over = (height <= near) & np.isfinite(height)
    if over.any():
        foot = x[over] - height[over, None] * normal[over]
        over[over] = shape.at_points(over).signed_distance(foot)[0] <= near[over]
    return over


def cloud_surface(
    name: str,
    solid: ShapeInWorld,
    cloud: ShapeInWorld,
    relative: Array,
    x: Array,
    phi: Array,
    normal: Array,
) -> Surface:
    """Distances and normals of a cloud's points on a solid, where several faces may tie.

    Parameters
    ----------
    name : str
        Of the pair, for messages.
    solid, cloud : ShapeInWorld
    relative : ndarray, shape (3, 4)
        [R, t] from the cloud's frame to the solid's.
    x : ndarray, shape (k, 3)
        Some of its points, in the solid's frame [m].
    phi : ndarray, shape (k,)
        Their signed distances [m].
    normal : ndarray, shape (k, 3)
        The normals that these have.

    Raises
    ------
    ContactError
        If the cloud is as deep along two of the normals that a point has.
    """
    tie = np.full(len(x), UNIQUE_NORMAL)
    within = rounding(solid, cloud)
    near = np.flatnonzero(phi <= within)
    if not near.size:
        return phi, normal, tie
    heights, normals = solid.shape.faces(x[near])
    if not heights.size:
        return phi, normal, tie
    highest, rivals = faces_apart(heights, normals, within)
    undecided = np.flatnonzero(rivals.any(axis=1))
    if not len(undecided):
        return phi, normal, tie
    normal = normal.copy()
    decided: dict[bytes, tuple[Array, int]] = {}
    for i in undecided.tolist():
        ways = distinct([normals[i, highest[i]], *normals[i, rivals[i]]])
        if ways.tobytes() not in decided:
            decided[ways.tobytes()] = _of_cloud(name, solid, cloud, relative, ways, within)
        normal[near[i]], tie[near[i]] = decided[ways.tobytes()]
    return phi, normal, tie


def _of_cloud(
    name: str, solid: ShapeInWorld, cloud: ShapeInWorld, relative: Array, ways: Array, within: float
) -> tuple[Array, int]:
    """The one of several normals along which a cloud is farthest out."""
    assert isinstance(cloud.shape, PointCloud)
    points = moved(relative, cloud.shape.points)
    out = np.array([dot(points, way).min() for way in ways]) - solid.shape.support_value(ways)
    level = out >= out.max() - within
    if np.count_nonzero(level) == 1:
        return ways[level][0], OF_CLOUD
    refuse_unless_touching(name, out.max(), product(ways[level], solid.R.T), within)
    return mean_direction(ways[level]), BISECTOR
