"""Fractions, and tolerances made of them."""

from decimal import ROUND_UP, Context, Decimal
from fractions import Fraction
from typing import Any, Final

from flint import fmpq

from quasistatic_ref.lab.vectors.expected import Tolerance

UNIT: Final = Fraction(1, 2**53)
"""Relative error of one rounding in float64."""


def fraction(value: fmpq) -> Fraction:
    """The same number of the other kind."""
    return Fraction(int(value.p), int(value.q))


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
