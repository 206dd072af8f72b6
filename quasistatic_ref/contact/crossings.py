"""Where edges, rims and lines of contact of two solids cross, seen along the pair's normal.

Faces that overlap in part have an area in common, whose corners are corners of both faces and
crossings of their edges: a body that lies on an edge of a table is borne there, too. Curves whose
angle has a sine of at most SKEW have no crossing. docs/conventions.md states the rule.
"""

from typing import NamedTuple

import numpy as np

from quasistatic_ref.contact.shape_in_world import ShapeInWorld
from quasistatic_ref.contact.solids.polytope import Polytope, polytope
from quasistatic_ref.model.angles import cos_sin
from quasistatic_ref.shapes.placed_shape import Capsule, Cone, Cylinder, Shape
from quasistatic_ref.step.data import Array, Indices
from quasistatic_ref.step.ordered import crossed, dot, norm, product, rotated
from quasistatic_ref.tolerances import FACING, OVER_FACE, SKEW

FACES, LEVEL = cos_sin(FACING)
"""Least cosine of the angle between a face's normal and the pair's, and of an edge's the largest
[-]."""
UP = np.array([0.0, 0.0, 1.0])
ROUND = 3
"""Curves of a solid of revolution: a line on its side and two rims."""


class Curves(NamedTuple):
    """Edges, lines of contact and rims of a solid where it touches another, in one frame.

    Parameters
    ----------
    ends : ndarray, shape (S, 2, 3)
        Of straight ones [m].
    centre, axis : ndarray, shape (C, 3)
        Of rims [m], [-].
    radius : ndarray, shape (C,)
        [m].
    number : ndarray of int, shape (S + C,)
        Of each among all curves of the solid.
    total : int
        Of those.
    """

    ends: Array
    centre: Array
    axis: Array
    radius: Array
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


def crossings(a: ShapeInWorld, b: ShapeInWorld, alpha: Array, beta: Array, n: Array) -> Crossings:
    """All crossings of two solids, in the world frame.

    Parameters
    ----------
    a, b : ShapeInWorld
    alpha, beta : ndarray, shape (3,)
        Their closest points [m].
    n : ndarray, shape (3,)
        The pair's normal [-].
    """
    on_a, on_b = touching(a, alpha, n), touching(b, beta, -n)
    found = [
        _edges(on_a, on_b, n),
        _edge_and_rim(on_a, on_b, n),
        _edge_and_rim(on_b, on_a, n, swapped=True),
        _rims(on_a, on_b, n, float(dot(beta - alpha, n))),
    ]
    return Crossings(*map(np.concatenate, zip(*found, strict=True)))


def touching(body: ShapeInWorld, x: Array, n: Array) -> Curves:
    """The curves of a solid that may bear, in the world frame.

    These are the edges of faces that hold its closest point x and have a normal within 0.25 rad of
    n; edges that hold x and are as level; the line of a round side that is, and the rim of a cap.

    Parameters
    ----------
    body : ShapeInWorld
    x : ndarray, shape (3,)
        [m].
    n : ndarray, shape (3,)
        The pair's normal out of the body [-].
    """
    shape, way = body.shape, product(body.R.T, n)
    ends, numbers, count = _straight(shape, product(body.R.T, x - body.t), way)
    rims = [(z, i) for z, i in _rim_heights(shape) if np.sign(z) * way[2] >= FACES]
    centre = np.array([[0.0, 0.0, z] for z, _ in rims]).reshape(-1, 3)
    radius = np.full(len(rims), shape.rim_radius or 0.0)
    number = np.array([*numbers, *(i for _, i in rims)], dtype=np.int64)
    axis = np.tile(rotated(body.R, UP), (len(rims), 1))
    return Curves(
        rotated(body.R, ends) + body.t,
        rotated(body.R, centre) + body.t,
        axis,
        radius,
        number,
        count,
    )


def _straight(shape: Shape, x: Array, way: Array) -> tuple[Array, list[int], int]:
    """Ends (S, 2, 3) [m] of straight curves in the solid's frame, numbers, and of all curves."""
    none: tuple[Array, list[int], int] = np.zeros((0, 2, 3)), [], ROUND
    if isinstance(shape, Capsule | Cylinder):
        above, up = shape.radius, 0.0
    elif isinstance(shape, Cone):
        above, up = 0.0, shape.radius
    else:
        flat = polytope(shape)
        return none if flat is None else _of_polytope(flat, shape.extent, x, way)
    side = np.array([2 * shape.half_length, up])  # its normal, radial and along the axis
    radial = norm(way[:2])
    if side[0] * radial + side[1] * way[2] < FACES * norm(side):
        return none
    outward, tip = way * [1.0, 1.0, 0.0] / radial, shape.half_length * UP
    return np.array([[shape.radius * outward - tip, above * outward + tip]]), [0], ROUND


def _of_polytope(
    flat: Polytope, extent: float, x: Array, way: Array
) -> tuple[Array, list[int], int]:
    """The same of a box or a convex mesh."""
    on = dot(flat.normals, x) >= flat.offsets - OVER_FACE * extent
    facing = on & (dot(flat.normals, way) >= FACES)
    ends = flat.vertices[flat.edges]
    along = ends[:, 1] - ends[:, 0]
    level = np.abs(dot(along, way)) <= LEVEL * norm(along)
    some = facing[flat.sides].any(axis=1) | on[flat.sides].all(axis=1) & level
    return ends[some], np.flatnonzero(some).tolist(), len(ends)


def _rim_heights(shape: Shape) -> list[tuple[float, int]]:
    """Heights [m] and numbers of the rims of a solid."""
    match shape:
        case Cylinder():
            return [(-shape.half_length, 1), (shape.half_length, 2)]
        case Cone():
            return [(-shape.half_length, 1)]
    return []


def _edges(on_a: Curves, on_b: Curves, n: Array) -> Crossings:
    """Crossings of straight curves."""
    i, j = _every(len(on_a.ends), len(on_b.ends))
    tail, start = on_a.ends[i, 0], on_b.ends[j, 0]
    u, v, w = on_a.ends[i, 1] - tail, on_b.ends[j, 1] - start, start - tail
    # tail + s u + phi n = start + t v
    steep = dot(crossed(u, v), n)
    crossing = np.abs(steep) > SKEW * norm(u) * norm(v)
    steep = np.where(crossing, steep, 1.0)
    s, t = dot(crossed(w, v), n) / steep, dot(crossed(w, u), n) / steep
    crossing &= (s >= 0) & (s <= 1) & (t >= 0) & (t <= 1)
    alpha, beta = tail + s[:, None] * u, start + t[:, None] * v
    number = _number(on_a.number[i], on_b.number[j], on_b.total)
    return Crossings(alpha[crossing], beta[crossing], number[crossing])


def _edge_and_rim(on_a: Curves, on_b: Curves, n: Array, swapped: bool = False) -> Crossings:
    """Crossings of straight curves with the other's rims; alpha's are straight, unless swapped."""
    i, j = _every(len(on_a.ends), len(on_b.centre))
    tail, axis = on_a.ends[i, 0], on_b.axis[j]
    u, w, up = on_a.ends[i, 1] - tail, tail - on_b.centre[j], dot(axis, n)
    # |w + s u + phi n| = radius, in the rim's plane.
    lift, lifts = -dot(axis, w) / up, -dot(axis, u) / up
    w, u_in = w + lift[:, None] * n, u + lifts[:, None] * n
    square, half = dot(u_in, u_in), dot(u_in, w)
    inside = half * half - square * (dot(w, w) - on_b.radius[j] ** 2)
    crossing = inside > SKEW**2 * square * on_b.radius[j] ** 2
    root, square = np.sqrt(np.where(crossing, inside, 0.0)), np.where(crossing, square, 1.0)
    rims = on_b.number[len(on_b.ends) :][j]
    number = _number(on_a.number[i], rims, on_b.total)
    if swapped:
        number = _number(rims, on_a.number[i], on_a.total)
    found = []
    for which, sign in enumerate((-1.0, 1.0)):
        s = (-half + sign * root) / square
        good = crossing & (s >= 0) & (s <= 1)
        ends = [tail + s[:, None] * u, tail + s[:, None] * u + (lift + s * lifts)[:, None] * n]
        alpha, beta = reversed(ends) if swapped else ends
        found.append(Crossings(alpha[good], beta[good], number[good] + which))
    return Crossings(*map(np.concatenate, zip(*found, strict=True)))


def _rims(on_a: Curves, on_b: Curves, n: Array, least: float) -> Crossings:
    """Crossings of rims, as circles in a plane across n; the points are in the planes of both.

    A rim that is not across n is narrower than its circle. Gaps below the pair's, `least` [m], are
    of points outside of the bodies.
    """
    i, j = _every(len(on_a.centre), len(on_b.centre))
    r, s, away = on_a.radius[i], on_b.radius[j], on_b.centre[j] - on_a.centre[i]
    away = away - dot(away, n)[:, None] * n
    square = dot(away, away)
    apart = square > (SKEW * np.minimum(r, s)) ** 2
    square = np.where(apart, square, 1.0)
    along = (square + r**2 - s**2) / (2 * square)  # share of the way
    across = r**2 / square - along**2
    crossing = apart & (across * square**2 > (SKEW * r * s) ** 2)
    across = np.sqrt(np.where(crossing, across, 0.0))
    aside = crossed(np.broadcast_to(n, away.shape), away)
    rims = on_a.number[len(on_a.ends) :][i], on_b.number[len(on_b.ends) :][j]
    number = _number(*rims, on_b.total)
    found = []
    for which, sign in enumerate((-1.0, 1.0)):
        x = on_a.centre[i] + along[:, None] * away + sign * across[:, None] * aside
        ends = [
            x + (dot(on.axis[k], on.centre[k] - x) / dot(on.axis[k], n))[:, None] * n
            for on, k in ((on_a, i), (on_b, j))
        ]
        good = crossing & (dot(ends[1] - ends[0], n) >= least - OVER_FACE * (r + s))
        found.append(Crossings(ends[0][good], ends[1][good], number[good] + which))
    return Crossings(*map(np.concatenate, zip(*found, strict=True)))


def _number(first: Indices, second: Indices, count: int) -> Indices:
    """The number of the first crossing of two curves, (N,) each, of `count` on beta's side."""
    return np.asarray(2 * (first * count + second))


def _every(first: int, second: int) -> tuple[Indices, Indices]:
    """Numbers of every two of some things and others, each of shape (first * second,)."""
    i, j = np.indices((first, second)).reshape(2, -1)
    return i, j
