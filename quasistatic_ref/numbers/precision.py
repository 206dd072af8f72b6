"""The arithmetic of proofs: FLINT's precision, float64 as it must be, and correct rounding.

FLINT has one precision for all threads. A processor can round in other directions than to nearest,
and flush subnormal numbers to zero (FTZ, DAZ). Both are set for each thread, and any library may
set them: many that are compiled with ``-ffast-math`` do when they are loaded. A step's numbers then
become others before they are exact, and an answer after it was proved.
"""

from collections.abc import Sequence
from threading import RLock
from typing import Final

from flint import arb, ctx, fmpq

from quasistatic_ref.errors import InputError

_TURN: Final = RLock()


class working_precision:
    """Compute with a number of bits, while other threads wait for their turn.

    FLINT has one precision for the whole process: a thread that changed it in the middle of
    another's sum would round what has to be exact.

    Parameters
    ----------
    bits : int
    """

    __slots__ = ("_before", "_bits")

    def __init__(self, bits: int) -> None:
        self._bits = bits

    def __enter__(self) -> None:
        _TURN.acquire()
        self._before = ctx.prec
        ctx.prec = self._bits

    def __exit__(self, *_: object) -> None:
        ctx.prec = self._before
        _TURN.release()


ONE = 1.0
ROUNDING_PROBE = 2.0**-60
"""Added to 1 or taken from it, it changes nothing, unless rounding is upwards or downwards."""
NORMAL = 2.0**-1022
HALF = 0.5
"""Half of the smallest normal number is subnormal: zero where it is flushed, written or read."""


def check_arithmetic() -> None:
    """Refuse to prove anything in a thread whose float64 numbers are not those of IEEE 754.

    Takes 0.1 us; stands before each search for a proof, after what a backend may have left behind,
    and before each check of a proof.

    Raises
    ------
    InputError
        If rounding is not to nearest, or subnormal numbers are flushed to zero.
    """
    if ONE + ROUNDING_PROBE == ONE - ROUNDING_PROBE and NORMAL * HALF > 0.0:
        return
    rounds = ONE + ROUNDING_PROBE != ONE - ROUNDING_PROBE
    what = "does not round to nearest" if rounds else "flushes subnormal numbers to zero"
    raise InputError(
        f"nothing can be proved in this thread: its arithmetic {what}, a mode of the processor "
        "that another library has set (one compiled with -ffast-math does so when it is loaded); "
        "use a process without that library, or reset the mode"
    )


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
