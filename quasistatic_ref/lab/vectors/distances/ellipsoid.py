"""Signed distance of a point to an ellipsoid: the largest root of a sextic, enclosed.

The closest point x of p has p = x + t grad, x_i = e_i^2 p_i / (t + e_i^2), and t is the largest
root of F(t) = sum (e_i p_i / (t + e_i^2))^2 - 1. (D. Eberly, "Distance from a point to an ellipse,
an ellipsoid, or a hyperellipsoid".)
"""

import numpy as np
from flint import arb, ctx, fmpq

from quasistatic_ref.lab.vectors.exact.algebra import Vector, length
from quasistatic_ref.lab.vectors.exact.precision import Real, Undecided, ball, root, sign


def distance_to_ellipsoid(half_axes: Vector, p: Vector) -> tuple[Real, Vector, bool]:
    """Signed distance, outward unit normal, and whether that is unique.

    Parameters
    ----------
    half_axes, p : ndarray of fmpq, shape (3,)
        The point in the ellipsoid's own frame.
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
            return *_from_closest(squares, p, x), left == 0
    t = _largest_root(squares, p, -least)
    return *_from_closest(squares, p, squares * p / (t + squares)), True


def _from_closest(squares: Vector, p: Vector, x: Vector) -> tuple[Real, Vector]:
    normal = x / squares
    normal = normal / length(normal)
    return (p - x) @ normal, normal


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
        if sign_at(F(t - width)) > 0 > sign_at(F(t + width)):
            return t + width * arb(0, 1)
    raise Undecided


def sign_at(value: Real) -> int:
    """Sign of F at a bound: 0 where the ball is open, which proves nothing."""
    return 0 if value.contains(0) else sign(value)
