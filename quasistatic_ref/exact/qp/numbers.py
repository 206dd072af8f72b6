"""Numbers as people have them: float64, whole numbers, fractions and decimals, none rounded."""

from __future__ import annotations

import re
from collections.abc import Mapping
from decimal import Decimal
from fractions import Fraction
from typing import Any, Final

import numpy as np
from flint import fmpq, fmpq_mat

from quasistatic_ref.errors import InputError
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.numbers.precision import nearest

DECIMAL: Final = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d{1,3})?", re.ASCII)
MOST_DIGITS: Final = 4300
"""Digits of a whole number that Python and others read from a text, by default."""
MOST_BITS: Final = int(MOST_DIGITS * 3.3219)
QUOTIENT: Final = re.compile(r"[+-]?\d+/\d*[1-9]\d*", re.ASCII)


def exact_numbers(value: Any, name: str) -> tuple[Array, dict[int, Fraction]]:
    """An array of the nearest float64 numbers, and what float64 does not hold, by flat place.

    The array has the shape (...) of the values.

    Parameters
    ----------
    value : array_like or sparse
        Of numbers, fractions, and texts as ``"0.1"``, a tenth, or ``"1/3"`` [any unit].
    name : str
        Of the array, in messages.

    Raises
    ------
    InputError
        If it is no such array.
    """
    if isinstance(value, np.ma.MaskedArray):
        raise InputError("is a masked array; fill what is masked", field=name)
    array = value.toarray() if hasattr(value, "toarray") else value
    if not isinstance(array, np.ndarray):
        array = (
            _objects(array, name) if isinstance(array, list | tuple | str) else np.asarray(array)
        )
    if array.dtype.kind == "f" and array.itemsize <= 8:
        return np.array(array, dtype=np.float64) + 0.0, {}
    if array.dtype.kind not in "iufOU":
        raise _no_numbers(name, value)
    flat = np.asarray(array).ravel()
    floats = np.zeros(flat.size)
    others = {}
    for place, v in enumerate(flat.tolist() if flat.dtype != np.longdouble else flat):
        number = v if type(v) is float else _number(v, name)
        if isinstance(number, float):
            floats[place] = number
            continue
        floats[place] = nearest(*number.as_integer_ratio())
        if floats[place] != number:
            if not floats[place] or abs(floats[place]) == np.inf:
                problem = "is beyond the range of float64; choose other units"
                raise InputError(problem, field=name, value=str(v))
            others[place] = number
    return floats.reshape(np.shape(array)) + 0.0, others


def _objects(value: Any, name: str) -> np.ndarray[Any, Any]:
    """Nested lists as an array of what they hold: NumPy would round it first."""
    try:
        plain = np.array(value)
        if plain.dtype == np.float64 and not _holds(value, (int, np.integer, np.longdouble)):
            return plain
        return np.array(value, dtype=object)
    except (TypeError, ValueError, OverflowError):
        raise _no_numbers(name, value) from None


def _holds(value: Any, kinds: tuple[type, ...]) -> bool:
    if isinstance(value, list | tuple):
        return any(_holds(v, kinds) for v in value)
    return isinstance(value, kinds)


def _number(v: Any, name: str) -> float | Fraction:
    """One number without rounding; InputError if it has more digits than files can hold."""
    if isinstance(v, str):
        if len(v) > MOST_DIGITS:
            raise _too_long(name)
        if DECIMAL.fullmatch(v) or QUOTIENT.fullmatch(v):
            return _short(Fraction(v), name)
    elif isinstance(v, Decimal):
        if not v.is_finite():
            return float(v)
        if abs(v.adjusted()) > MOST_DIGITS:
            raise _too_long(name)
        return _short(Fraction(v), name)
    elif isinstance(v, float | np.floating):
        return (
            float(v)
            if not isinstance(v, np.longdouble) or not np.isfinite(v)
            else Fraction(*v.as_integer_ratio())
        )
    elif isinstance(v, np.integer) or (isinstance(v, int) and not isinstance(v, bool)):
        return _short(Fraction(int(v)), name)
    elif hasattr(v, "as_integer_ratio") and not isinstance(v, bool):
        return _short(Fraction(*v.as_integer_ratio()), name)
    raise _no_numbers(name, v)


def _short(v: Fraction, name: str) -> Fraction:
    """A fraction that files can hold; InputError of a longer one."""
    if max(v.numerator.bit_length(), v.denominator.bit_length()) > MOST_BITS:
        raise _too_long(name)
    return v


def _too_long(name: str) -> InputError:
    problem = f"has a number of more than {MOST_DIGITS} digits, which other programs could not read"
    return InputError(problem, field=name)


def _no_numbers(name: str, value: Any) -> InputError:
    return InputError("must be numbers, in lists of equal length", field=name, value=value)


def texts(numbers: Array, others: Mapping[int, Fraction]) -> Any:
    """Nested lists of an array's numbers, what float64 does not hold as ``"p/q"``.

    `numbers` [any unit] has shape (n,).

    Infinite ones are None.
    """
    flat: list[Any] = [v if np.isfinite(v) else None for v in numbers.ravel().tolist()]
    for place, v in others.items():
        flat[place] = str(v)
    if numbers.ndim == 1:
        return flat
    width = numbers.shape[1]
    return [flat[k * width : (k + 1) * width] for k in range(len(numbers))]


def fraction_matrix(value: Any, name: str) -> fmpq_mat:
    """A matrix in fractions, from whatever holds its numbers; a vector is one row of it.

    InputError if an entry is no number.
    """
    floats, others = exact_numbers(value, name)
    if not np.isfinite(floats).all():
        raise InputError("must be finite numbers", field=name)
    entries = [fmpq(*v.as_integer_ratio()) for v in floats.ravel().tolist()]
    for place, v in others.items():
        entries[place] = fmpq(*v.as_integer_ratio())
    rows = floats.shape[0] if floats.ndim == 2 else 1
    return fmpq_mat(rows, floats.size // max(rows, 1), entries)


def as_fraction(v: fmpq) -> Fraction:
    """A fraction of FLINT's as one of Python's."""
    return Fraction(int(v.p), int(v.q))
