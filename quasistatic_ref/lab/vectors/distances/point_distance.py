"""Signed distance of a point to a box, cylinder, cone, ellipsoid or half-space, closed forms.

Everything is in the shape's own frame. Where the normal is not unique (the middle of a box, the
axis of a cylinder) one is taken, and the answer says so.
"""

from typing import NamedTuple

import numpy as np
from flint import arb, ctx, fmpq

from quasistatic_ref.lab.vectors.distances.shapes import Placed
from quasistatic_ref.lab.vectors.distances.witness import Witness
from quasistatic_ref.lab.vectors.exact.precision import (
    IDENTITY,
    Real,
    Undecided,
    Vector,
    ball,
    length,
    root,
    sign,
    vector,
)


class Surface(NamedTuple):
    """Signed distance [m], outward unit normal, and whether that is unique."""

    phi: Real
    normal: Vector
    unique: bool


def point_on_solid(solid: Placed, point: Vector) -> Witness:
    """Closest point of a solid to a point of the world, which is beta."""
    at = solid.local(point)
    match solid.kind:
        case "box":
            surface = _box(solid.sizes, at)
        case "cylinder":
            surface = _cylinder(solid.sizes, at)
        case "cone":
            surface = _cone(solid.sizes, at)
        case "ellipsoid":
            surface = _ellipsoid(solid.sizes, at)
        case _:
            normal = solid.sizes[:3]
            phi = (normal @ at - solid.sizes[3]) / length(normal)
            surface = Surface(phi, normal / length(normal), True)
    n = solid.world_direction(surface.normal)
    return Witness(surface.phi, point - surface.phi * n, point, n, surface.unique)


def _box(half: Vector, at: Vector) -> Surface:
    signs = vector(-1 if x < 0 else 1 for x in at)
    excess = abs(at) - half
    beyond = vector(max(x, 0) for x in excess)
    if any(beyond):
        outside = length(beyond)
        return Surface(outside, signs * beyond / outside, True)
    face = int(np.argmax(excess))
    unique = sum(excess == excess[face]) == 1 and bool(at[face])
    return Surface(excess[face], signs[face] * IDENTITY[face], unique)


def _cylinder(sizes: Vector, at: Vector) -> Surface:
    r, outward = _radial(at)
    up = sign(at[2]) or 1
    flat = _rectangle(np.array([r, abs(at[2])]) - sizes)
    normal = np.append(flat.normal[0] * outward, flat.normal[1] * up)
    lost = (sign(r) == 0 and sign(flat.normal[0]) != 0) or (
        sign(at[2]) == 0 and sign(flat.normal[1]) != 0
    )
    return Surface(flat.phi, normal, flat.unique and not lost)


def _rectangle(excess: Vector) -> Surface:
    """In the half-plane (r, |z|), from how far beyond its two sides a point is."""
    beyond = vector(x if sign(x) > 0 else 0 for x in excess)
    if any(sign(x) for x in beyond):
        return Surface(length(beyond), beyond / length(beyond), True)
    side = sign(excess[0] - excess[1])
    if side >= 0:
        return Surface(excess[0], IDENTITY[0, :2], side > 0)
    return Surface(excess[1], IDENTITY[1, :2], True)


def _cone(sizes: Vector, at: Vector) -> Surface:
    """In the half-plane (r, z) a cone is a triangle: rim, tip, and the axis, which is no side."""
    radius, half = sizes
    r, outward = _radial(at)
    slant = root(radius * radius + 4 * half * half)
    side = np.array([2 * half, radius]) / slant
    above_side = (r - radius) * side[0] + (at[2] + half) * side[1]
    above_base = -half - at[2]
    below = Surface(above_base, -IDENTITY[1, :2], True)
    # From the rim along the side to the tip, and along the base to the axis.
    up_side = (radius - r) * side[1] + (at[2] + half) * side[0]
    if sign(above_side) <= 0 and sign(above_base) <= 0:
        nearer = sign(above_side - above_base)
        flat = Surface(above_side, side, nearer > 0) if nearer >= 0 else below
    elif sign(above_side) > 0 and sign(up_side) >= 0 and sign(up_side - slant) <= 0:
        flat = Surface(above_side, side, True)
    elif sign(above_base) > 0 and sign(r - radius) <= 0:
        flat = below
    else:
        beyond_tip = sign(up_side - slant) > 0
        away = np.array([r, at[2] - half] if beyond_tip else [r - radius, at[2] + half])
        flat = Surface(length(away), away / length(away), True)
    lost = sign(r) == 0 and sign(flat.normal[0]) != 0
    normal = np.append(flat.normal[0] * outward, flat.normal[1])
    return Surface(flat.phi, normal, flat.unique and not lost)


def _radial(at: Vector) -> tuple[Real, Vector]:
    """Distance from the axis, and the direction away from it: x where there is none."""
    r = length(at[:2])
    return r, at[:2] / r if sign(r) else IDENTITY[0, :2]


def _ellipsoid(half_axes: Vector, p: Vector) -> Surface:
    """The largest root of a sextic, enclosed.

    The closest point x of p has p = x + t grad, x_i = e_i^2 p_i / (t + e_i^2), and t is the largest
    root of F(t) = sum (e_i p_i / (t + e_i^2))^2 - 1. (D. Eberly, "Distance from a point to an
    ellipse, an ellipsoid, or a hyperellipsoid".)
    """
    squares = half_axes * half_axes
    least = min(squares)
    inner = np.flatnonzero(squares == least)
    if not any(p[inner]):
        # On the plane of the medial axis: t may be the pole -e^2, where x leaves the plane.
        across = squares > least
        x = 0 * p
        x[across] = (squares * p)[across] / (squares[across] - least)
        left = 1 - x @ (x / squares)
        if left >= 0:
            x[inner[0]] = root(left * least)
            return _from_closest(squares, p, x, left == 0)
    t = _largest_root(squares, p, -least)
    return _from_closest(squares, p, squares * p / (t + squares), True)


def _from_closest(squares: Vector, p: Vector, x: Vector, unique: bool) -> Surface:
    normal = x / squares
    normal = normal / length(normal)
    return Surface((p - x) @ normal, normal, unique)


def _largest_root(squares: Vector, p: Vector, pole: Real) -> Real:
    """Ball around the root of F beyond its last pole, where F falls and is convex."""

    def F(t: Real) -> Real:
        return sum(squares * p * p / (t + squares) ** 2, fmpq(-1))

    def slope(t: Real) -> Real:
        return sum(-2 * squares * p * p / (t + squares) ** 3, fmpq(0))

    # Where one term of F alone is 1 the root is not yet reached; Newton's steps rise towards it.
    starts = [root(s * y * y) - s for s, y in zip(squares, p, strict=True) if y]
    t = ball(starts[0])
    for start in starts[1:]:
        t = t.max(ball(start))
    if not t > pole:
        raise Undecided
    t = t.mid()
    for _ in range(4 * ctx.prec):
        step = (-F(t) / slope(t)).mid()
        t = (t + step).mid()
        # Relative to the ellipsoid's own sizes: close to its surface t itself is close to zero.
        if abs(step) <= (abs(t) + ball(max(squares))) * arb(2) ** (16 - ctx.prec):
            break
    # As wide as it takes: a point that is itself a ball has no narrower root.
    for spared in range(32, ctx.prec // 2, 16):
        width = (abs(t) + ball(max(squares))) * arb(2) ** (spared - ctx.prec)
        if _sign_at(F(t - width)) > 0 > _sign_at(F(t + width)):
            return t + width * arb(0, 1)
    raise Undecided


def _sign_at(value: Real) -> int:
    """Sign of F at a bound: 0 where the ball is open, which proves nothing."""
    return 0 if value.contains(0) else sign(value)
