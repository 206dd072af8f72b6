"""Signed distance of a point to an ellipsoid: the largest root of a sextic, enclosed.

The closest point x of p has p = x + t grad, x_i = e_i^2 p_i / (t + e_i^2), and t is the largest
root of F(t) = sum (e_i p_i / (t + e_i^2))^2 - 1. (D. Eberly, "Distance from a point to an ellipse,
an ellipsoid, or a hyperellipsoid".)
"""

from collections.abc import Sequence

from flint import arb, ctx, fmpq

from quasistatic_ref.lab.vectors.exact.algebra import Vector, dot
from quasistatic_ref.lab.vectors.exact.precision import Real, Undecided, ball, root, sign


def distance_to_ellipsoid(half_axes: Sequence[Real], p: Vector) -> tuple[Real, Vector, bool]:
    """Signed distance, outward unit normal, and whether that is unique.

    Parameters
    ----------
    half_axes, p : list of fmpq, length 3
        The point in the ellipsoid's own frame.
    """
    squares = [e * e for e in half_axes]
    least = min(squares)
    inner = [k for k in range(3) if squares[k] == least]
    if not any(p[k] for k in inner):
        # On the plane of the medial axis: t may be the pole -e^2, where x leaves the plane.
        x = [s * y / (s - least) if s > least else fmpq(0) for s, y in zip(squares, p, strict=True)]
        left = 1 - sum((x[k] * x[k] / squares[k] for k in range(3)), fmpq(0))
        if left >= 0:
            x[inner[0]] = root(left * least)
            return *_from_closest(squares, p, x), left == 0
    t = _largest_root(squares, p, -least)
    x = [s * y / (t + s) for s, y in zip(squares, p, strict=True)]
    return *_from_closest(squares, p, x), True


def _from_closest(squares: Sequence[Real], p: Vector, x: Vector) -> tuple[Real, Vector]:
    normal = [y / s for s, y in zip(squares, x, strict=True)]
    length = root(dot(normal, normal))
    normal = [y / length for y in normal]
    return dot([a - b for a, b in zip(p, x, strict=True)], normal), normal


def _largest_root(squares: Sequence[Real], p: Vector, pole: Real) -> Real:
    """Ball around the root of F beyond its last pole, where F falls and is convex."""

    def F(t: Real) -> Real:
        terms = (s * y * y / (t + s) ** 2 for s, y in zip(squares, p, strict=True))
        return sum(terms, fmpq(-1))

    def slope(t: Real) -> Real:
        terms = (-2 * s * y * y / (t + s) ** 3 for s, y in zip(squares, p, strict=True))
        return sum(terms, fmpq(0))

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
