"""Sines, cosines and angles, correctly rounded.

Those of the C library are not (glibc 2.36 rounds 286 of 200,000 the wrong way): they differ in the
last bit from one processor, and from one version of the library, to another. So do NumPy's. Balls
of 128 bits decide nearly always; a larger precision decides the rest.
"""

import math
from collections.abc import Callable

from flint import arb, ctx

PRECISION = 128
"""Bits: a number is so near to the middle between two float64 numbers once in 2^70."""

MOST = 1 << 13
"""Bits that suffice for the largest float64."""


def cos_sin(angle: float) -> tuple[float, float]:
    """Cosine and sine [-] of an angle [rad]; NaN of an infinite one."""
    sine, cosine = _rounded(lambda: arb(angle).sin_cos())
    return cosine, sine


def angle_of(y: float, x: float) -> float:
    """The angle of the vector (x, y), in [-pi, pi] [rad]; 0 of the zero vector."""
    (angle,) = _rounded(lambda: (arb.atan2(arb(y), arb(x)),))
    return angle


def _rounded(balls: Callable[[], tuple[arb, ...]]) -> tuple[float, ...]:
    """The float64 numbers nearest to the numbers in balls; NaN where these are not finite."""
    precision = PRECISION
    while precision <= MOST:
        with ctx.workprec(precision):
            found = balls()
            low = tuple([float(ball.lower()) for ball in found])
            if low == tuple([float(ball.upper()) for ball in found]):
                return low
        precision *= 4
    return (math.nan,) * len(found)
