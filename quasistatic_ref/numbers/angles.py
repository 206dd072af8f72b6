"""Sines, cosines and angles, correctly rounded, of single numbers and of arrays.

Those of the C library are not (glibc 2.36 rounds 286 of 200,000 the wrong way): they differ in the
last bit from one processor, and from one version of the library, to another. So do NumPy's. But in
numbers of 64 bits they are wrong by less than 2^-60 of themselves: where that leaves one float64,
it is the nearest. Balls of 128 bits decide nearly all others; a larger precision the rest.
"""

import math
from collections.abc import Callable, Sequence
from typing import Any, Final, TypeAlias

import numpy as np
from flint import arb, fmpq
from numpy.typing import NDArray

from quasistatic_ref.numbers.arrays import Array, Mask
from quasistatic_ref.numbers.precision import working_precision

PRECISIONS = (128, 512, 2048)
"""Bits, tried in turn. Of 128 a number is too near to the middle between two float64 numbers once
in 2^70; 2,048 suffice for the largest float64: 1,024 before the point, and as many as decide nearly
always after it."""

ONE: Final = np.longdouble(1)
HAS_64_BITS: Final = bool(ONE + np.ldexp(ONE, -63) != ONE == ONE + np.ldexp(ONE, -65))
"""Whether NumPy's long double is a number of 64 bits here."""
MARGIN: Final = np.ldexp(ONE, -60)
"""More than by how much of itself a sine or angle of the C library in such numbers is wrong [-]."""
LARGEST: Final = 1e6
"""Largest angle whose sine is taken of the C library [rad]: of larger ones it has other ways."""

WideArray = NDArray[np.longdouble]

Number: TypeAlias = Any
"""A float, or a vector of them of which each is treated as one is: what comes is what goes."""


def root(x: Number) -> Number:
    """Square roots of numbers that are not negative [any unit]."""
    return np.sqrt(x) if isinstance(x, np.ndarray) else math.sqrt(x)


def chosen(where: bool | Mask, one: Number, other: Number) -> Number:
    """One number where a condition holds, the other elsewhere [any unit]."""
    if isinstance(where, np.ndarray):
        return np.where(where, one, other)
    return one if where else other


def cos_sin(angle: Number) -> tuple[Number, Number]:
    """Cosine and sine [-] of an angle [rad], or of each of N; NaN of an infinite one."""
    if isinstance(angle, np.ndarray):
        known = np.abs(angle) < LARGEST
        each = np.where(known, angle + 0.0, 0.0).astype(np.longdouble)
        cosines, sure = _nearest_of_each(np.cos(each))
        sines, sure_too = _nearest_of_each(np.sin(each))
        for i in np.flatnonzero(~(known & sure & sure_too)).tolist():
            cosines[i], sines[i] = cos_sin(float(angle[i]))
        return cosines, sines
    if HAS_64_BITS and abs(angle) < LARGEST:
        wide = np.longdouble(angle + 0.0)
        nearest = _nearest(np.cos(wide)), _nearest(np.sin(wide))
        if None not in nearest:
            return nearest
    sine, cosine = _rounded(lambda: arb(angle).sin_cos())
    return cosine, sine


def cos_sin_of_turn(k: int, K: int) -> tuple[float, float]:
    """Cosine and sine [-] of k / K of a turn.

    Quarter turns and reflections are exact.

    Examples
    --------
    >>> cos_sin_of_turn(1, 4), cos_sin_of_turn(4, 8)
    ((0.0, 1.0), (-1.0, 0.0))
    """
    sine, cosine = _rounded(lambda: arb.sin_cos_pi_fmpq(fmpq(2 * k, K)))
    return cosine, sine


def angle_of(y: Number, x: Number) -> Number:
    """The angle of the vector (x, y), or of each of N, in [-pi, pi] [rad]; 0 of the zero vector."""
    if isinstance(y, np.ndarray):
        known = np.isfinite(y) & np.isfinite(x)
        each = [np.where(known, v + 0.0, 0.0).astype(np.longdouble) for v in (y, x)]
        angles, sure = _nearest_of_each(np.arctan2(*each))
        for i in np.flatnonzero(~(known & sure)).tolist():
            angles[i] = angle_of(float(y[i]), float(x[i]))
        return angles
    if HAS_64_BITS and math.isfinite(y) and math.isfinite(x):
        nearest = _nearest(np.arctan2(np.longdouble(y + 0.0), np.longdouble(x + 0.0)))
        if nearest is not None:
            return nearest
    (angle,) = _rounded(lambda: [arb.atan2(arb(y), arb(x))])
    return angle


def _nearest(wide: Any) -> float | None:
    """The float64 nearest to what a number of 64 bits stands for; None where that is open."""
    margin = wide * MARGIN
    low = float(wide - margin)
    return low if low == float(wide + margin) else None


def _nearest_of_each(wide: WideArray) -> tuple[Array, Mask]:
    """The same of an array, and where it is sure."""
    margin = wide * MARGIN
    low = (wide - margin).astype(np.float64)
    return low, (low == (wide + margin).astype(np.float64)) & HAS_64_BITS


def _rounded(balls: Callable[[], Sequence[arb]]) -> list[float]:
    """The numbers in balls that are formed with the precision of each turn; NaN if undecided."""
    for precision in PRECISIONS:
        with working_precision(precision):
            formed = balls()
            least = [float(ball.lower()) for ball in formed]
            if least == [float(ball.upper()) for ball in formed]:
                return least
    return [math.nan] * len(formed)
