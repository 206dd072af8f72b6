"""Exact numbers in decimal digits."""

from decimal import Decimal, localcontext
from fractions import Fraction


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
