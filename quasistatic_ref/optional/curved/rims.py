"""Crossings of two solids, one of which is a cylinder or a cone: of edges, rims and lines.

As :mod:`~quasistatic_ref.contact.crossings`, whose rule it follows.
"""

from typing import NamedTuple

import numpy as np

from quasistatic_ref.contact.crossings import (
    ROUND,
    UP,
    Crossings,
    Edges,
    crossing_number,
    edge_crossings,
    edges,
    line,
)
from quasistatic_ref.contact.normals import TURNED
from quasistatic_ref.contact.shape_in_world import ShapeInWorld
from quasistatic_ref.numbers.arrays import Array, Indices, Mask
from quasistatic_ref.numbers.ordered import crossed, dot, rotated
from quasistatic_ref.shapes.placed_shape import Cone, Cylinder, Shape
from quasistatic_ref.tolerances import OVER_FACE, SKEW

BOTH = np.array([[-1.0], [1.0]])
"""Signs of the two roots."""


class Curves(NamedTuple):
    """Edges, lines of contact and rims of a solid where it touches another, in one frame.

    Parameters
    ----------
    straight : Edges
    centre, axis : ndarray, shape (C, 3)
        Of rims [m], [-].
    radius : ndarray, shape (C,)
        [m].
    rims : ndarray of int, shape (C,)
        Their numbers among all curves of the solid.
    """

    straight: Edges
    centre: Array
    axis: Array
    radius: Array
    rims: Indices


def curve_crossings(
    a: ShapeInWorld, b: ShapeInWorld, alpha: Array, beta: Array, n: Array
) -> Crossings:
    """All crossings of two solids, in the world frame.

    Parameters
    ----------
    a, b : ShapeInWorld
    alpha, beta : ndarray, shape (3,)
        Their closest points [m].
    n : ndarray, shape (3,)
        The pair's normal [-].
    """
    on_a = touching(a, alpha, n)
    on_b = touching(b, beta, -n)
    crossings = [
        edge_crossings(on_a.straight, on_b.straight, n),
        _edge_and_rim(on_a, on_b, n),
        _edge_and_rim(on_b, on_a, n, swapped=True),
        _rims(on_a, on_b, n, float(dot(beta - alpha, n))),
    ]
    return Crossings(*map(np.concatenate, zip(*crossings, strict=True)))


def touching(body: ShapeInWorld, x: Array, n: Array) -> Curves:
    """The curves of a solid that may bear: its edges or line, and the rim of a cap that faces n.

    Parameters
    ----------
    body : ShapeInWorld
    x : ndarray, shape (3,)
        Its closest point [m].
    n : ndarray, shape (3,)
        The pair's normal out of the body [-].
    """
    shape = body.shape
    way = body.pose.local_direction(n)
    if isinstance(shape, Cylinder | Cone):
        above = 0.0 if isinstance(shape, Cone) else shape.radius
        ends, number = line(shape, above, way)
        straight = Edges(rotated(body.R, ends) + body.t, number, ROUND)
    else:
        straight = edges(body, x, n)
    rims = [(z, i) for z, i in _rim_heights(shape) if np.sign(z) * way[2] >= TURNED]
    centre = np.array([[0.0, 0.0, z] for z, _ in rims]).reshape(-1, 3)
    return Curves(
        straight,
        rotated(body.R, centre) + body.t,
        np.tile(rotated(body.R, UP), (len(rims), 1)),
        np.full(len(rims), shape.rim_radius or 0.0),
        np.array([i for _, i in rims], dtype=np.int64),
    )


def _rim_heights(shape: Shape) -> list[tuple[float, int]]:
    """Heights [m] and numbers of the rims of a solid."""
    match shape:
        case Cylinder():
            return [(-shape.half_length, 1), (shape.half_length, 2)]
        case Cone():
            return [(-shape.half_length, 1)]
    return []


def _edge_and_rim(on_a: Curves, on_b: Curves, n: Array, swapped: bool = False) -> Crossings:
    """Crossings of straight curves with the other's rims; alpha's are straight, unless swapped."""
    i, j = every(len(on_a.straight.ends), len(on_b.centre))
    tail = on_a.straight.ends[i, 0]
    axis = on_b.axis[j]
    u = on_a.straight.ends[i, 1] - tail
    w = tail - on_b.centre[j]
    up = dot(axis, n)
    # |w + s u + phi n| = radius, in the rim's plane.
    lift = -dot(axis, w) / up
    lifts = -dot(axis, u) / up
    w = w + lift[:, None] * n
    u_in = u + lifts[:, None] * n
    square = dot(u_in, u_in)
    half = dot(u_in, w)
    inside = half * half - square * (dot(w, w) - on_b.radius[j] ** 2)
    crossing = inside > SKEW**2 * square * on_b.radius[j] ** 2
    root = np.sqrt(np.where(crossing, inside, 0.0))
    square = np.where(crossing, square, 1.0)
    s = (-half + BOTH * root) / square
    on_edge = tail + s[..., None] * u
    on_rim = on_edge + (lift + s * lifts)[..., None] * n
    good = crossing & (s >= 0) & (s <= 1)
    edge = on_a.straight.number[i]
    rim = on_b.rims[j]
    if swapped:
        number = crossing_number(rim, edge, on_a.straight.total)
        return _numbered(on_rim, on_edge, number, good)
    number = crossing_number(edge, rim, on_b.straight.total)
    return _numbered(on_edge, on_rim, number, good)


def _rims(on_a: Curves, on_b: Curves, n: Array, least: float) -> Crossings:
    """Crossings of rims, as circles in a plane across n; the points are in the planes of both.

    A rim that is not across n is narrower than its circle. Gaps below the pair's, `least` [m], are
    of points outside of the bodies.
    """
    i, j = every(len(on_a.centre), len(on_b.centre))
    r = on_a.radius[i]
    s = on_b.radius[j]
    away = on_b.centre[j] - on_a.centre[i]
    away = away - dot(away, n)[:, None] * n
    square = dot(away, away)
    apart = square > (SKEW * np.minimum(r, s)) ** 2
    square = np.where(apart, square, 1.0)
    along = (square + r**2 - s**2) / (2 * square)  # share of the way
    across = r**2 / square - along**2
    crossing = apart & (across * square**2 > (SKEW * r * s) ** 2)
    across = np.sqrt(np.where(crossing, across, 0.0))
    aside = crossed(np.broadcast_to(n, away.shape), away)
    x = on_a.centre[i] + along[:, None] * away + (BOTH * across)[..., None] * aside
    alpha, beta = (
        x + (dot(on.axis[k], on.centre[k] - x) / dot(on.axis[k], n))[..., None] * n
        for on, k in ((on_a, i), (on_b, j))
    )
    good = crossing & (dot(beta - alpha, n) >= least - OVER_FACE * (r + s))
    number = crossing_number(on_a.rims[i], on_b.rims[j], on_b.straight.total)
    return _numbered(alpha, beta, number, good)


def _numbered(alpha: Array, beta: Array, number: Indices, good: Mask) -> Crossings:
    """The crossings, of N pairs of two each, that a mask (2, N) calls good, with their numbers."""
    numbers = np.stack([number, number + 1])
    return Crossings(alpha[good], beta[good], numbers[good])


def every(first: int, second: int) -> tuple[Indices, Indices]:
    """Indices of all pairs of `first` and `second` things, each of shape (first * second,)."""
    i, j = np.indices((first, second)).reshape(2, -1)
    return i, j
