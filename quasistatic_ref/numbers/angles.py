"""Sines, cosines and angles, correctly rounded.

Those of the C library are not (glibc 2.36 rounds 286 of 200,000 the wrong way): they differ in the
last bit from one processor, and from one version of the library, to another. So do NumPy's. Balls
of 128 bits decide nearly always; a larger precision decides the rest.
"""

import math

from flint import arb

from quasistatic_ref.numbers.precision import working_precision

PRECISIONS = (128, 512, 2048)
"""Bits, tried in turn. Of 128 a number is too near to the middle between two float64 numbers once
in 2^70; 2,048 suffice for the largest float64: 1,024 before the point, and as many as decide nearly
always after it."""


def cos_sin(angle: float) -> tuple[float, float]:
    """Cosine and sine [-] of an angle [rad]; NaN of an infinite one."""
    for precision in PRECISIONS:
        with working_precision(precision):
            sine, cosine = arb(angle).sin_cos()
            s = float(sine.lower())
            c = float(cosine.lower())
            if s == float(sine.upper()) and c == float(cosine.upper()):
                return c, s
    return math.nan, math.nan


def angle_of(y: float, x: float) -> float:
    """The angle of the vector (x, y), in [-pi, pi] [rad]; 0 of the zero vector."""
    for precision in PRECISIONS:
        with working_precision(precision):
            ball = arb.atan2(arb(y), arb(x))
            angle = float(ball.lower())
            if angle == float(ball.upper()):
                return angle
    return math.nan
