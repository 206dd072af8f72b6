"""Exact numbers in decimal digits."""

from collections.abc import Sequence
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
    if not x:
        return f"0.{'0' * (digits - 1)}e+00"
    size = abs(x)
    exponent = len(str(size.numerator)) - len(str(size.denominator))
    exponent -= size < Fraction(10) ** exponent  # now 10**exponent <= size
    scaled = round(size / Fraction(10) ** (exponent - digits + 1))  # half to even
    if scaled == 10**digits:
        scaled = scaled // 10
        exponent = exponent + 1
    text = str(scaled)
    return f"{'-' if x < 0 else ''}{text[0]}.{text[1:]}e{exponent:+03d}"
