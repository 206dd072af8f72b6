"""From exact numbers and from balls to float64, rounded correctly (half to even)."""

import math

from flint import arb, fmpq


def nearest(p: int, q: int) -> float:
    """The float64 nearest to p / q [-], ties to even; subnormals too, and never -0.0.

    Parameters
    ----------
    p, q : int
        q > 0.

    Returns
    -------
    float
    """
    try:
        return p / q + 0.0  # Python divides integers with correct rounding
    except OverflowError:
        return float("inf") if p > 0 else float("-inf")


def nearest_fraction(x: fmpq) -> float:
    """The float64 nearest to a fraction [-]."""
    return nearest(int(x.p), int(x.q))


def nearest_in(ball: arb) -> float | None:
    """The float64 nearest to every number in a ball, or None if there is no such float64.

    None mostly means that the ball has a radius and holds zero, or a number half-way between two
    float64 numbers.
    """
    x = float(ball) + 0.0  # of its midpoint: a candidate, never -0.0
    below = math.nextafter(x, -math.inf)
    above = math.nextafter(x, math.inf)
    if not (math.isfinite(below) and math.isfinite(above)):
        return None
    if 2 * ball > arb(below) + x and 2 * ball < arb(above) + x:
        return x
    low = _exact(ball.lower())
    high = _exact(ball.upper())
    return low if low == high else None


def nearest_above(ball: arb) -> float:
    """A float64 that no number in a ball exceeds [of the unit of the ball]."""
    top = ball.upper()
    if not top.is_finite():
        return float("inf")
    return math.nextafter(_exact(top), math.inf) if top != 0 else 0.0


def _exact(point: arb) -> float:
    """Return the float64 nearest to a ball without radius; NaN if the ball is not finite."""
    if not point.is_finite():
        return float("nan")  # unequal to itself: never taken for an answer
    m, e = point.man_exp()
    return nearest(int(m) << max(int(e), 0), 1 << max(-int(e), 0))
