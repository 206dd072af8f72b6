"""Roots of increasing functions, enclosed by bisection."""

from __future__ import annotations

from collections.abc import Callable

from flint import arb, ctx, fmpq

from quasistatic_ref.vectors.precision import Real, sign

SHORT = fmpq(1, 1 << 100)
"""Bracket below which a zero is no longer taken to be the root itself."""

SPARED = 24
"""Bits of a root that are left open: the function is not known better."""


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
    if sign(function(low)) >= 0 or sign(function(high)) <= 0:
        return None
    least = (high - low) / (1 << (ctx.prec - SPARED))
    while high - low > least:
        middle = (low + high) / 2
        side = sign(function(middle))
        if side == 0:
            if high - low > SHORT:
                return middle
            break
        low, high = (middle, high) if side < 0 else (low, middle)
    return arb((low + high) / 2) + arb(0, 1) * arb(high - low)
