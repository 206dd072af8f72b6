"""Sines, cosines and angles, correctly rounded.

Those of the C library are not (glibc 2.36 rounds 286 of 200,000 the wrong way): they differ in the
last bit from one processor, and from one version of the library, to another. So do NumPy's. Balls
of 128 bits decide nearly always; a larger precision decides the rest.
"""

import math
from collections.abc import Callable, Sequence

from flint import arb, fmpq

from quasistatic_ref.numbers.precision import working_precision

PRECISIONS = (128, 512, 2048)
"""Bits, tried in turn. Of 128 a number is too near to the middle between two float64 numbers once
in 2^70; 2,048 suffice for the largest float64: 1,024 before the point, and as many as decide nearly
always after it."""


def cos_sin(angle: float) -> tuple[float, float]:
    """Cosine and sine [-] of an angle [rad]; NaN of an infinite one."""
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


def angle_of(y: float, x: float) -> float:
    """The angle of the vector (x, y), in [-pi, pi] [rad]; 0 of the zero vector."""
    (angle,) = _rounded(lambda: [arb.atan2(arb(y), arb(x))])
    return angle


def _rounded(balls: Callable[[], Sequence[arb]]) -> list[float]:
    """The numbers in balls that are formed with the precision of each turn; NaN if undecided."""
    for precision in PRECISIONS:
        with working_precision(precision):
            formed = balls()
            least = [float(ball.lower()) for ball in formed]
            if least == [float(ball.upper()) for ball in formed]:
                return least
    return [math.nan] * len(formed)
