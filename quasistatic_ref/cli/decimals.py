"""Exact numbers in decimal digits."""

from collections.abc import Sequence
from decimal import Decimal, localcontext
from fractions import Fraction

from quasistatic_ref.certify.form import ExactForm
from quasistatic_ref.certify.minimiser import fraction_solution


def decimal_strings(
    form: ExactForm, working_set: Sequence[int], digits: int = 30
) -> tuple[str, ...]:
    """Each delta_q of an optimum in decimal digits, correctly rounded.

    Parameters
    ----------
    form : ExactForm
    working_set : sequence of int
        That of the optimum.
    digits : int
        Significant digits.

    Returns
    -------
    tuple of str
    """
    values = fraction_solution(form, working_set).point
    return tuple(decimal_string(Fraction(int(v.p), int(v.q)), digits) for v in values)


def decimal_string(x: Fraction, digits: int) -> str:
    """A number in `digits` significant decimal digits, correctly rounded, half to even.

    Examples
    --------
    >>> decimal_string(Fraction(-1, 3), 5)
    '-3.3333e-01'
    """
    with localcontext(prec=digits):
        value = Decimal(x.numerator) / Decimal(x.denominator)
    sign = "-" if x < 0 else ""
    figures = "".join(map(str, value.as_tuple().digits)).ljust(digits, "0")
    return f"{sign}{figures[0]}.{figures[1:]}e{value.adjusted():+03d}"
