"""Where edges and lines of contact of two solids cross, seen along the pair's normal.

Faces that overlap in part have an area in common, whose corners are corners of both faces and
crossings of their edges: a body that lies on an edge of a table is borne there, too. Curves whose
angle has a sine of at most SKEW have no crossing. docs/conventions.md states the rule. Crossings of
rims are in ``optional/curved``.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from quasistatic_ref.contact.normals import TURNED
from quasistatic_ref.contact.outlines import outlines
from quasistatic_ref.contact.shape_in_world import ShapeInWorld
from quasistatic_ref.contact.solids.polytope import Polytope, polytope
from quasistatic_ref.numbers.angles import cos_sin
from quasistatic_ref.numbers.arrays import Array, Indices, Mask
from quasistatic_ref.numbers.ordered import crossed, dot, norm, rotated
from quasistatic_ref.parts import part
from quasistatic_ref.shapes.convex_mesh import ConvexMesh
from quasistatic_ref.shapes.placed_shape import Capsule, Cone, Cylinder
from quasistatic_ref.shapes.revolved import Revolved
from quasistatic_ref.tolerances import FACING, OVER_FACE, SKEW

EDGE_COSINE = cos_sin(FACING)[1]
"""Largest cosine of the angle between the pair's normal and an edge that counts by itself [-]."""
UP = np.array([0.0, 0.0, 1.0])
ROUND = 3
"""Curves of a solid of revolution: a line on its side and two rims."""


class Edges(NamedTuple):
    """Edges and lines of contact of a solid where it touches another, in one frame.

    Parameters
    ----------
    ends : ndarray, shape (S, 2, 3)
        [m].
    number : ndarray of int, shape (S,)
        Of each among all curves of the solid.
    total : int
        Of those.
    """

    ends: Array
    number: Indices
    total: int


class Crossings(NamedTuple):
    """Points of both solids of which one is along the pair's normal from the other.

    Parameters
    ----------
    alpha, beta : ndarray, shape (N, 3)
        [m].
    number : ndarray of int, shape (N,)
        By the numbers of both curves: the same two cross under the same number in every step.
    """

    alpha: Array
    beta: Array
    number: Indices


CurveCrossings = Callable[[ShapeInWorld, ShapeInWorld, Array, Array, Array], Crossings]
"""As :func:`crossings`, of solids with rims."""


def crossings(
    a: ShapeInWorld, b: ShapeInWorld, alpha: Array, beta: Array, n: Array, grain: float = 0.0
) -> Crossings:
    """All crossings of two solids, in the world frame.

    Parameters
    ----------
    a, b : ShapeInWorld
    alpha, beta : ndarray, shape (3,)
        Their closest points [m].
    n : ndarray, shape (3,)
        The pair's normal [-].
    grain : float
        Of faces that lie on each other; 0 of others [m].
    """
    flat = [polytope(solid.shape) is not None for solid in (a, b)]
    if all(flat):
        return edge_crossings(edges(a, alpha, n, grain), edges(b, beta, -n, grain), n, grain)
    rimmed = [isinstance(solid.shape, Cylinder | Cone) for solid in (a, b)]
    if all(np.logical_or(flat, rimmed)):
        curve_crossings: CurveCrossings = part("curve_crossings")
        return curve_crossings(a, b, alpha, beta, n)
    return Crossings(np.zeros((0, 3)), np.zeros((0, 3)), np.zeros(0, dtype=np.int64))


def edges(body: ShapeInWorld, x: Array, n: Array, grain: float = 0.0) -> Edges:
    """The edges of a polytope, or the line of a capsule, that may bear, in the world frame.

    These are the edges of faces that hold its closest point x and have a normal within 0.25 rad of
    n; edges that hold x and are as level; and the line of a capsule that is.

    Parameters
    ----------
    body : ShapeInWorld
    x : ndarray, shape (3,)
        [m].
    n : ndarray, shape (3,)
        The pair's normal out of the body [-].
    grain : float
        Of faces that lie on each other; 0 of others [m].
    """
    shape = body.shape
    way = body.pose.local_direction(n)
    flat = outlines(shape).flat if isinstance(shape, ConvexMesh) else polytope(shape)
    assert flat is not None
    if isinstance(shape, Capsule):
        ends, number = line(shape, shape.radius, way)
        total = ROUND
    else:
        out = flat.margin * way  # from the core to the surface
        at = body.pose.local(x) - out
        number = np.flatnonzero(bearing(flat, shape.extent, at, way, grain))
        ends = flat.vertices[flat.edges[number]] + out
        total = len(flat.edges)
    return Edges(rotated(body.R, ends) + body.t, number, total)


def line(shape: Revolved, above: float, way: Array) -> tuple[Array, Indices]:
    """The line on the side of a solid of revolution that faces a direction, or None.

    Parameters
    ----------
    shape : Revolved
    above : float
        Radius of its upper end [m].
    way : ndarray, shape (3,)
        In the solid's frame [-].

    Returns
    -------
    ends : ndarray, shape (S, 2, 3)
        [m], with S 0 or 1.
    number : ndarray of int, shape (S,)
    """
    # The normal of the side, radial and along the axis.
    side = np.array([2 * shape.half_length, shape.radius - above])
    radial = norm(way[:2])
    if side[0] * radial + side[1] * way[2] < TURNED * norm(side):
        return np.zeros((0, 2, 3)), np.zeros(0, dtype=np.int64)
    outward = way * [1.0, 1.0, 0.0] / radial
    tip = shape.half_length * UP
    ends = np.array([[shape.radius * outward - tip, above * outward + tip]])
    return ends, np.zeros(1, dtype=np.int64)


def bearing(
    flat: Polytope, extent: float | Array, x: Array, way: Array, grain: float = 0.0
) -> Mask:
    """Which edges of a box or a convex mesh may bear, shape (E,); of P stacked ones (P, E).

    Parameters
    ----------
    flat : Polytope
    extent : float or ndarray, shape (P, 1)
        Of the shape [m].
    x, way : ndarray, shape (3,) or (P, 3)
        Its closest point [m] and the pair's normal out of it [-], in its frame.
    grain : float
        Of faces that lie on each other; 0 of others [m].
    """
    x = x[..., None, :]
    way = way[..., None, :]
    on = dot(flat.normals, x) >= flat.offsets - np.maximum(OVER_FACE * extent, grain)
    facing = on & (dot(flat.normals, way) >= TURNED)
    level = np.abs(dot(flat.ways, way)) <= EDGE_COSINE * norm(flat.ways)
    borne = facing[..., flat.sides].any(axis=-1) | on[..., flat.sides].all(axis=-1) & level
    return np.asarray(borne)


def edge_crossings(on_a: Edges, on_b: Edges, n: Array, grain: float = 0.0) -> Crossings:
    """Crossings of straight curves, seen along the pair's normal n, shape (3,) [-].

    Parameters
    ----------
    on_a, on_b : Edges
    n : ndarray, shape (3,)
    grain : float
        Of the pair [m].
    """
    i, j = overlapping(on_a.ends, on_b.ends, n)
    crossing, alpha, beta = lines_crossed(on_a.ends[i], on_b.ends[j], n, grain)
    number = crossing_number(on_a.number[i], on_b.number[j], on_b.total)
    return Crossings(alpha[crossing], beta[crossing], number[crossing])


def overlapping(on_a: Array, on_b: Array, n: Array) -> tuple[Indices, ...]:
    """Numbers of lines with ends (S, 2, 3) and (T, 2, 3) whose boxes meet, seen along n.

    Parameters
    ----------
    on_a, on_b : ndarray, shapes (S, 2, 3) and (T, 2, 3)
        [m].
    n : ndarray, shape (3,)
        [-].
    """
    axis = np.abs(n).argmax()
    a, b = (ends - ends[..., axis, None] * (n / n[axis]) for ends in (on_a, on_b))
    gives = SKEW * np.abs(np.concatenate([on_a, on_b])).max(initial=0.0)
    low = a.min(axis=1)[:, None] - b.max(axis=1)
    high = b.min(axis=1) - a.max(axis=1)[:, None]
    return np.nonzero((np.maximum(low, high) <= gives).all(axis=2))


def lines_crossed(
    on_a: Array, on_b: Array, n: Array, grain: float = 0.0
) -> tuple[Mask, Array, Array]:
    """Whether lines with ends (N, 2, 3) cross, and where on either: of shape (N, 3) [m].

    Parameters
    ----------
    on_a, on_b : ndarray, shape (N, 2, 3)
        [m].
    n : ndarray, shape (3,) or (N, 3)
        Along which they are seen [-].
    grain : float
        Of faces that lie on each other; 0 of others [m].
    """
    tail = on_a[:, 0]
    start = on_b[:, 0]
    u = on_a[:, 1] - tail
    v = on_b[:, 1] - start
    w = start - tail
    # tail + s u + phi n = start + t v
    steep = dot(crossed(u, v), n)
    crossing = np.abs(steep) > SKEW * norm(u) * norm(v)
    steep = np.where(crossing, steep, 1.0)
    s = dot(crossed(w, v), n) / steep
    t = dot(crossed(w, u), n) / steep
    crossing &= (s >= 0) & (s <= 1) & (t >= 0) & (t <= 1)
    if grain:  # each goes on by more than a grain on either side of the other
        beyond_v = np.minimum(s, 1 - s) * np.abs(steep) / norm(v)
        beyond_u = np.minimum(t, 1 - t) * np.abs(steep) / norm(u)
        crossing &= np.minimum(beyond_u, beyond_v) > grain
    return crossing, tail + s[:, None] * u, start + t[:, None] * v


def crossing_number(first: Indices, second: Indices, count: int) -> Indices:
    """The number of the first crossing of two curves, shape (N,), of `count` on beta's side.

    Parameters
    ----------
    first, second : ndarray of int, shape (N,)
        Their numbers.
    count : int
    """
    return np.asarray(2 * (first * count + second))
