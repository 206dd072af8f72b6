r"""How near corners of another solid are at least, where they may bear on a solid.

Let n point out of the solid, which reaches :math:`r = \max n^T v`. The signed distance of a corner
x is at least :math:`n^T x - r`. So is its height over a face whose normal is within an angle t of
n, on which its foot is, but where it is negative: there :math:`1 / \cos t` of that.

A corner bears only where its normal m is that near to n. Its foot is then farthest of the solid
along such an m. A vertex v is not, if for some vertex p

.. math:: n^T (p - v) > \tan t \, |p - v|_\perp,

where the length is taken across n. The other vertices are the *top*, above which bearing corners
are: with the height h over its lowest vertex, at most h tan t beyond it in any direction across n.
"""

from typing import Final

import numpy as np

from quasistatic_ref.contact.normals import TURNED
from quasistatic_ref.contact.shape_in_world import ShapeInWorld
from quasistatic_ref.numbers.arrays import Array, Mask
from quasistatic_ref.numbers.ordered import norm
from quasistatic_ref.shapes.convex_mesh import ConvexMesh
from quasistatic_ref.shapes.placed_shape import Box, HalfSpace, Shape
from quasistatic_ref.tolerances import FACING, ON_RIM, SAME_NORMAL, UPRIGHT

FEW_CORNERS: Final = 16
"""Corners of which all are looked at: bounds would take as long."""
STEEP = np.tan(FACING + SAME_NORMAL)
"""The tangent of t, or a little more [-]."""
EIGHTHS = np.arange(8) * (np.pi / 4)
AROUND = np.column_stack([np.cos(EIGHTHS), np.sin(EIGHTHS)])
"""Directions across the normal in which tops are bounded [-]."""


def least_distances(shape: Shape, x: Array, n: Array, near: float) -> Array:
    """Lower bounds of the distances of corners; infinity for a corner that is no candidate.

    Parameters
    ----------
    shape : Shape
    x : ndarray, shape (N, 3)
        Corners of another solid in its frame [m].
    n : ndarray, shape (3,)
        The pair's normal out of the shape, in its frame [-].
    near : float
        How far above a face a corner is over it [m].

    Returns
    -------
    ndarray, shape (N,)
        [m].
    """
    if len(x) <= FEW_CORNERS:
        return np.full(len(x), -np.inf)
    if isinstance(shape, HalfSpace):
        height, _ = shape.signed_distance(x)
        return height
    gives = near + (shape.facets.margin(x) if isinstance(shape, ConvexMesh) else 0.0)
    height = x @ n - shape.support_value(n[None])[0]
    least = height - gives
    least = np.where(least < 0, least / TURNED, least)
    if isinstance(shape, Box | ConvexMesh):
        vertices, _ = shape.corners(n)
        least[(height > 2 * gives) & ~_above_top(vertices, x, n, gives)] = np.inf
    return np.asarray(least)


def _above_top(vertices: Array, x: Array, n: Array, gives: float) -> Mask:
    """Which points (N, 3) may be above the top of a polytope."""
    frame = np.linalg.svd(n[None])[2][1:]
    across = AROUND @ frame
    top = np.ones(len(vertices), dtype=bool)
    for way in (n, *(n + STEEP * across)):
        away = vertices[(vertices @ way).argmax()] - vertices
        top &= away @ n <= STEEP * norm(away @ frame.T) + gives
    above = x @ n - (vertices[top] @ n).min()
    beyond = x @ across.T - (vertices[top] @ across.T).max(axis=0)
    return np.asarray(beyond.max(axis=1) <= STEEP * above + gives)


def towards(body: ShapeInWorld, nearest: Array, n: Array) -> Array:
    """A direction from this body to the other, in this body's frame, (3,), of any length.

    Where the closest point is on a rim, the point itself gives this direction more accurately than
    the normal does: near contact the normal is computed from a difference that cancels.

    Parameters
    ----------
    body : ShapeInWorld
    nearest : ndarray, shape (3,)
        Its closest point to the other body, in the world frame [m].
    n : ndarray, shape (3,)
        The way to the other body, in the world frame [-].
    """
    local = body.pose.local(nearest)
    way = body.pose.local_direction(n)
    radius = body.shape.rim_radius
    if radius is None:
        return way
    on_rim = norm(local[:2]) >= (1 - ON_RIM) * radius
    return local if on_rim and norm(way[:2]) > UPRIGHT else way
