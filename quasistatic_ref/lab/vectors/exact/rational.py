"""Fractions, and tolerances made of them."""

from decimal import ROUND_UP, Context, Decimal
from fractions import Fraction
from typing import Any

import numpy as np
from flint import arb_mat, fmpq, fmpq_mat, fmpz_mat

from quasistatic_ref.certify.form import fraction as fraction_of
from quasistatic_ref.lab.vectors.expected import Tolerance

UNIT = Fraction(1, 2**53)
"""Relative error of one rounding in float64."""


def fraction(value: fmpq) -> Fraction:
    """The same number of the other kind."""
    return Fraction(int(value.p), int(value.q))


def rationals(values: Any) -> Any:
    """An array of rational numbers, of the shape of a matrix or a list of exact ones."""
    if isinstance(values, arb_mat):
        shape = values.nrows(), values.ncols()
        return rationals(map(fraction_of, values.entries())).reshape(shape)
    if isinstance(values, fmpz_mat):
        return rationals(values.entries()).reshape(values.nrows(), values.ncols())
    return np.array([fmpq(v) for v in values], dtype=object)


def inverse(M: Any) -> Any:
    """The inverse of an array of rational numbers."""
    return np.array(fmpq_mat(len(M), len(M), M.ravel().tolist()).inv().tolist()).reshape(M.shape)


def largest(values: Any) -> Fraction:
    """The largest size in an array; 0 of none."""
    sizes = np.abs(np.array(values, dtype=object)).ravel()
    return fraction(max(sizes, default=fmpq(0)))


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
