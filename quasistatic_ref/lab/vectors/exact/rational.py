"""Algebra on float64 numbers without rounding, and its results rounded once."""

from decimal import ROUND_UP, Context, Decimal
from fractions import Fraction
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from quasistatic_ref.certify.rounding import decimal_string
from quasistatic_ref.lab.vectors.expected import Json, Tolerance

Exact = NDArray[np.object_]
"""An array of fractions; sums and products of such arrays are exact."""

UNIT: Final = Fraction(1, 2**53)
"""Relative error of one rounding in float64."""
DIGITS: Final = 30
LONGEST: Final = 200
"""Most numbers of a field that is also written in 30 digits: more would fill the files."""

_fractions = np.frompyfunc(Fraction, 1, 1)
_floats = np.frompyfunc(float, 1, 1)  # integers are divided with correct rounding
_decimals = np.frompyfunc(lambda x: decimal_string(Fraction(x), DIGITS), 1, 1)


def exact(value: Json) -> Exact:
    """Nested lists of float64 numbers as fractions."""
    return np.asarray(_fractions(np.array(value, dtype=np.float64)), dtype=object)


def rounded(array: Exact) -> Json:
    """Nested lists of the nearest float64 numbers, never -0.0."""
    return (np.asarray(_floats(array), dtype=np.float64) + 0.0).tolist()


def digits(**fields: Exact) -> dict[str, Json]:
    """Nested lists of 30-digit strings of each field that is not too large for them."""
    small = {name: array for name, array in fields.items() if 0 < array.size <= LONGEST}
    return {name: np.asarray(_decimals(array)).tolist() for name, array in small.items()}


def tolerance(bound: Any, reason: str) -> Tolerance:
    """A bound, rounded up to one decimal digit.

    Parameters
    ----------
    bound : Fraction
        In the field's own unit.
    reason : str
    """
    bound = Fraction(bound)
    context = Context(prec=1, rounding=ROUND_UP)
    up = context.divide(Decimal(bound.numerator), Decimal(bound.denominator))
    return Tolerance(float(up), reason)


def largest(array: Exact) -> Fraction:
    """Largest absolute value, 0 of none."""
    return max((abs(v) for v in array.ravel().tolist()), default=Fraction(0))
