"""Roots of increasing functions, enclosed."""

from collections.abc import Callable

from flint import arb, ctx, fmpq

from quasistatic_ref.lab.vectors.exact.precision import (
    Real,
    Undecided,
    rational_near,
    sign,
)

SHORT = fmpq(1, 1 << 100)
"""A function that is zero on so long an interval is zero there without rounding."""

WIDER = 1 << 16
"""By how much a bracket grows that is too narrow to be shown."""

STEPS = 60
"""Secants that are tried."""

SPARED = 24
"""Bits of a root that are left open: the function is not known better."""


def minimum(slope: Callable[[Real], Real], low: fmpq, high: fmpq) -> Real | None:
    """Where a convex distance is least between two numbers; None if at one of them.

    None too if that is a kink, which no ball decides: distances have kinks inside solids only,
    where no closest point is.
    """
    try:
        return increasing_root(slope, low, high)
    except Undecided:
        return None


def increasing_root(function: Callable[[Real], Real], low: fmpq, high: fmpq) -> Real | None:
    """Where a function that increases from low to high is zero; None if it is not between.

    Parameters
    ----------
    function : callable
        Takes a rational number.
    low, high : fmpq

    Returns
    -------
    fmpq or arb or None
        Exact where a zero was hit: a function that is zero on an interval has one in it.
    """
    f_low = function(low)
    f_high = function(high)
    if sign(f_low) >= 0 or sign(f_high) <= 0:
        return None
    least = (high - low) / (1 << (ctx.prec - SPARED))
    last = high
    for count in range(1, STEPS + ctx.prec):
        # The secant of the Illinois method settles in about ten steps; halving is the fallback.
        at = rational_near(low - f_low * (high - low) / (f_high - f_low))
        if count > STEPS or not low < at < high:
            at = (low + high) / 2
        value = function(at)
        side = sign(value)
        if side == 0 or abs(at - last) < least:
            around = _root_ball(function, at, least)
            if around is not None or side == 0:
                return at if around is None else around
        if high - low <= least:
            break
        if side < 0:
            f_high = f_high / 2 if last == low else f_high
            low = at
            f_low = value
        else:
            f_low = f_low / 2 if last == high else f_low
            high = at
            f_high = value
        last = at
    return arb((low + high) / 2) + arb(0, 1) * arb(high - low)


def _root_ball(function: Callable[[Real], Real], at: fmpq, width: fmpq) -> arb | None:
    """A ball about a number that shows to hold the root; None where the function stays zero."""
    while width <= SHORT:
        if sign(function(at - width)) < 0 < sign(function(at + width)):
            return arb(at) + arb(0, 1) * arb(width)
        width *= WIDER
    return None
