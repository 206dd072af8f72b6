"""From exact numbers and from balls to float64, rounded correctly (half to even)."""

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
    float64 numbers. Rounding keeps the order, so that both ends decide (FLINT rounds the midpoint
    of a ball correctly).
    """
    low = float(ball.lower()) + 0.0  # never -0.0
    return low if low == float(ball.upper()) else None
