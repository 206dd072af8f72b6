"""Sines, cosines and angles, correctly rounded.

Those of the C library are not (glibc 2.36 rounds 286 of 200,000 the wrong way): they differ in the
last bit from one processor, and from one version of the library, to another. So do NumPy's. Near
zero, where half turns of most steps are, a series in float64 decides, unless a midpoint between two
float64 numbers is within its error. Otherwise balls of 128 bits decide nearly always; a larger
precision decides the rest.
"""

import math

from flint import arb, ctx

SMALL = 2.0**-7
"""Largest angle [rad], or tangent [-], of the series."""

SERIES = 2.0**-49
"""More than the relative error of the sums: 7 roundings of 2^-53, and 3 times that for what is left
out: higher powers, and in an angle the square of the tangent times the remainder of y / x."""

SPLIT = 2.0**27 + 1
"""A product with it separates the upper 26 bits of a float64 from the others (Dekker 1971)."""

LEAST = 2.0**-400
"""Of larger numbers y, errors of products are float64 numbers [any unit]."""

PRECISION = 128
"""Bits: a number is so near to the middle between two float64 numbers once in 2^70."""

MOST = 1 << 11
"""Bits that suffice for the largest float64: 1,024 before the point, and as many as decide nearly
always after it."""


def cos_sin(angle: float) -> tuple[float, float]:
    """Cosine and sine [-] of an angle [rad]; NaN of an infinite one."""
    if abs(angle) <= SMALL:
        c, s = _series_cos_sin(angle)
        if c is not None and s is not None:
            return c, s
    precision = PRECISION
    while precision <= MOST:
        with ctx.workprec(precision):
            sine, cosine = arb(angle).sin_cos()
            s = float(sine.lower())
            c = float(cosine.lower())
            if s == float(sine.upper()) and c == float(cosine.upper()):
                return c, s
        precision *= 4
    return math.nan, math.nan


def angle_of(y: float, x: float) -> float:
    """The angle of the vector (x, y), in [-pi, pi] [rad]; 0 of the zero vector."""
    if (y == 0 or abs(y) >= LEAST) and abs(y) < SMALL * x < 1:
        near = _series_angle_of(y, x)
        if near is not None:
            return near
    precision = PRECISION
    while precision <= MOST:
        with ctx.workprec(precision):
            ball = arb.atan2(arb(y), arb(x))
            angle = float(ball.lower())
            if angle == float(ball.upper()):
                return angle
        precision *= 4
    return math.nan


def _series_cos_sin(angle: float) -> tuple[float | None, float | None]:
    """Cosine and sine of an angle up to SMALL; None where their rounding is open.

    Where z is subnormal or 0, the sums are wrong, and too small to change a rounding.
    """
    z = angle * angle
    to_cos = -z * (1 / 2 - z * (1 / 24 - z / 720))
    to_sin = -angle * z * (1 / 6 - z * (1 / 120 - z / 5040))
    c = _rounded_sum(1.0, to_cos, SERIES * to_cos)
    s = _rounded_sum(angle, to_sin, SERIES * to_sin)
    return c, s


def _series_angle_of(y: float, x: float) -> float | None:
    """The angle of a vector (x, y) whose tangent is at most SMALL; None where rounding is open."""
    t = y / x
    rest = _remainder(y, t, x) / x  # of the tangent
    z = t * t
    to_angle = -t * z * (1 / 3 - z * (1 / 5 - z * (1 / 7 - z / 9)))
    return _rounded_sum(t, rest + to_angle, SERIES * (abs(rest) + abs(to_angle)))


def _rounded_sum(large: float, small: float, error: float) -> float | None:
    """A number plus a small one with an error, correctly rounded; None where that is open."""
    lower = large + (small - error)
    return lower if lower == large + (small + error) else None


def _remainder(y: float, t: float, x: float) -> float:
    """The number y - t x, exactly, of the rounded quotient t = y / x."""
    t_upper, t_lower = _halves(t)
    x_upper, x_lower = _halves(x)
    product = t * x
    error = t_lower * x_lower - (
        ((product - t_upper * x_upper) - t_lower * x_upper) - t_upper * x_lower
    )
    return (y - product) - error


def _halves(number: float) -> tuple[float, float]:
    """A number as the sum of its upper 26 bits and the others."""
    scaled = SPLIT * number
    upper = scaled - (scaled - number)
    return upper, number - upper
