"""From exact numbers and from balls to float64, rounded correctly (half to even)."""

from collections.abc import Sequence

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


def all_nearest(balls: Sequence[arb]) -> list[float] | None:
    """The float64 nearest to every number in a ball, of each; None if one has no such float64.

    This mostly means that the ball has a radius and holds zero, or a number half-way between two
    float64 numbers. Rounding keeps the order, so that both ends decide (FLINT rounds the midpoint
    of a ball correctly).
    """
    lows = [float(ball.lower()) + 0.0 for ball in balls]  # never -0.0
    return lows if lows == [float(ball.upper()) for ball in balls] else None
