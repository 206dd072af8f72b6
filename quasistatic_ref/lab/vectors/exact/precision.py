"""Numbers of the vectors: rational while they can be, balls beyond, float64 at the end.

Every float64 is entered exactly. Sums, products and quotients of rational numbers stay rational,
and so do roots of perfect squares: zeros, ties and midpoints between two float64 numbers are then
decided exactly. Other roots, sines and cosines are balls; where a ball leaves a sign or a rounding
open, everything is done again at twice the precision. A ball of radius < 2^-200 that contains 0
is 0, and one of relative radius < 2^-200 that contains a midpoint is that midpoint: both come from
rational answers on the way to which a root or a sine cancelled.
"""

from collections.abc import Callable
from fractions import Fraction
from functools import lru_cache
from math import inf, isqrt, nextafter
from typing import Any, TypeAlias

import numpy as np
from flint import arb, fmpq

from quasistatic_ref.certify.rounding import nearest_fraction
from quasistatic_ref.cli.decimals import decimal_string
from quasistatic_ref.lab.program import number as kinds
from quasistatic_ref.lab.vectors.trees import mapped
from quasistatic_ref.numbers.precision import working_precision
from quasistatic_ref.optional.gap import nearest_in

Real: TypeAlias = Any
"""An fmpq or an arb. They mix freely, which their type hints cannot say."""
PRECISION = 320
"""Bits of a ball's midpoint at first."""

HIGHEST = 16 * PRECISION
"""Bits at which raising ends; no case of the families needs it."""

DIGITS = 30
"""Significant decimal digits of the strings that stand with the float64 numbers."""
LONGEST = 200
"""Most numbers of a field that is also written in them: more would fill the files."""


class Undecided(ArithmeticError):
    """A ball was too wide for a sign or a rounding: more precision is needed."""


def number(x: float | Real) -> Real:
    """A float64 or whole number, exactly; what is exact or a ball already, as it is."""
    return x if isinstance(x, (fmpq, arb)) else fmpq(*x.as_integer_ratio())


def ball(x: Real) -> arb:
    """A number as a ball, at the present precision."""
    return x if isinstance(x, arb) else arb(x)


def root(x: Real) -> Real:
    """Square root; rational where it is, and 0 for a ball that counts as 0."""
    if isinstance(x, fmpq):
        p = int(x.p)
        q = int(x.q)
        if p >= 0 and isqrt(p) ** 2 == p and isqrt(q) ** 2 == q:
            return fmpq(isqrt(p), isqrt(q))
        return arb(x).sqrt()
    return x.sqrt() if sign(x) else fmpq(0)


def sign(x: Real) -> int:
    """-1, 0 or 1.

    Raises
    ------
    Undecided
        If the ball is too wide to tell.
    """
    if x > 0:
        return 1
    if x < 0:
        return -1
    if isinstance(x, fmpq) or x.rad() < _threshold():
        return 0
    raise Undecided


def cos_sin(angle: Real) -> tuple[Real, Real]:
    """Cosine and sine of an angle; of zero, exactly."""
    if angle == 0:
        return fmpq(1), fmpq(0)
    sine, cosine = ball(angle).sin_cos()
    return cosine, sine


def _coefficients(t: Real) -> tuple[Real, Real, Real]:
    if t == 0:
        return fmpq(1), fmpq(1, 2), fmpq(1, 6)
    sinc = ball(t).sinc()
    half = ball(t / 2).sinc()
    return sinc, half * half / 2, (1 - sinc) / (t * t)


def _part_of_turn(like: Real, k: int, K: int) -> tuple[Real, Real]:
    (sine, cosine), _ = rounded_results(lambda: arb(fmpq(2 * k, K)).sin_cos_pi())
    return number(cosine), number(sine)


for _kind in (fmpq, arb):
    kinds.root.register(_kind, root)
    kinds.cos_sin.register(_kind, cos_sin)
    kinds.coefficients.register(_kind, _coefficients)
    kinds.part_of_turn.register(_kind, _part_of_turn)


def rounded_results(function: Callable[[], Any]) -> tuple[Any, Any]:
    """What a function returns, in float64 and in 30 digits, each rounded correctly.

    Parameters
    ----------
    function : callable
        Returns dicts and lists of numbers; called again at higher precision where needed. It
        must make all its balls itself: one made before has the precision of that time.
        Booleans, integers, strings and None are passed on.

    Returns
    -------
    tuple
        The same nesting of float64 numbers, half to even and never -0.0, and of strings.

    Raises
    ------
    Undecided
        If the highest precision does not decide a digit.
    """
    precision = PRECISION
    while precision <= HIGHEST:
        with working_precision(precision):
            try:
                tree = function()
                return mapped(tree, _each(_nearest)), mapped(tree, _each(_decimal))
            except Undecided:
                precision *= 2
    raise Undecided(f"{HIGHEST} bits do not decide a sign or a rounding: the case is ill-posed")


def short(digits: dict[str, Any]) -> dict[str, Any]:
    """The fields that are not too large for their digits to stand in a file as well."""

    def fits(value: Any) -> bool:
        return bool(value) if isinstance(value, dict) else 0 < np.size(value) <= LONGEST

    return {name: value for name, value in digits.items() if fits(value)}


def _each(leaf: Callable[[Real], Any]) -> Callable[[Any], Any]:
    """The same of each number of an array; what is no number is passed on."""

    def of(value: Any) -> Any:
        if isinstance(value, np.ndarray):  # its whole numbers are constants of the program
            return np.frompyfunc(lambda x: leaf(number(x)), 1, 1)(value).tolist()
        return leaf(value) if isinstance(value, (fmpq, arb)) else value

    return of


def _nearest(x: Real) -> float:
    if isinstance(x, fmpq):
        return nearest_fraction(x)
    if _is_zero(x):
        return 0.0
    value = nearest_in(x)
    if value is not None:
        return value
    middle = float(x)
    for other in (nextafter(middle, inf), nextafter(middle, -inf)):
        halfway = (number(middle) + number(other)) / 2
        if _is(x, halfway):
            return nearest_fraction(halfway)
    raise Undecided


def _decimal(x: Real) -> str:
    if isinstance(x, fmpq):
        return decimal_string(Fraction(int(x.p), int(x.q)), DIGITS)
    if _is_zero(x):
        return decimal_string(Fraction(0), DIGITS)
    low, high = (decimal_string(dyadic_fraction(end), DIGITS) for end in (x.lower(), x.upper()))
    if low == high:
        return low
    halfway = Fraction(decimal_string(dyadic_fraction(x.mid()), DIGITS + 1))
    if _is(x, fmpq(halfway.numerator, halfway.denominator)):
        return decimal_string(halfway, DIGITS)
    raise Undecided


def _is(x: arb, halfway: fmpq) -> bool:
    """Whether a ball is narrow enough to be taken for the midpoint in it."""
    return bool(x.contains(halfway) and x.rad() < _threshold() * abs(arb(halfway)))


def _is_zero(x: Real) -> bool:
    """Whether a number counts as 0: exactly, or a ball of radius < 2^-200 around it."""
    if isinstance(x, fmpq):
        return x == 0
    return bool(x.contains(0)) and bool(x.rad() < _threshold())


@lru_cache(maxsize=1)
def _threshold() -> arb:
    return arb(fmpq(1, 1 << 200))


def dyadic_fraction(point: arb) -> Fraction:
    """The number that a point of a ball is."""
    m, e = (int(part) for part in point.man_exp())
    return Fraction(m) * Fraction(2) ** e
