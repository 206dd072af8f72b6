"""Fields of frozen dataclasses, checked and made read-only."""

import math
from typing import Any, Final

import numpy as np

from quasistatic_ref.errors import ModelError
from quasistatic_ref.numbers.arrays import check_and_freeze, checked_numbers

SHORT: Final = 1e-15
"""Smallest length of a shape [m], about a proton's; quotients of lengths stay in float64's range.
"""


def finite_number(value: Any, key: str) -> float:
    """A finite float [the field's unit]; ModelError naming the field otherwise."""
    try:
        number = float(value)
    except (TypeError, ValueError, OverflowError):
        number = math.nan
    if not math.isfinite(number):
        raise ModelError("must be a finite number", field=key, value=value)
    return number


def halved(owner: object, key: str, half: object, name: str, whole: object) -> None:
    """Set a field to half of a length that is given by either name; ModelError unless by one."""
    if (half is None) == (whole is None):
        problem = f"must be given, or {name}, twice as long, and not both"
        raise ModelError(problem, field=key)
    size = checked_numbers(whole, name, ModelError) / 2 if half is None else half
    object.__setattr__(owner, key, size)


def freeze_array(owner: object, key: str, shape: tuple[int, ...]) -> None:
    """Replace a field by a read-only float64 copy; ModelError unless finite and of that shape."""
    check_and_freeze(owner, {key: shape}, error=ModelError)


def freeze_size(owner: object, key: str) -> None:
    """Replace a field by a float; ModelError unless it is positive."""
    value = getattr(owner, key)
    number = finite_number(value, key)
    _check_lengths([number], key, "a positive length", value)
    object.__setattr__(owner, key, number)


def freeze_lengths(owner: object, key: str, what: str = "three positive lengths") -> None:
    """Replace a field by three positive lengths, read-only; ModelError if they are not `what`."""
    value = getattr(owner, key)
    if np.shape(checked_numbers(value, key, ModelError)) != (3,):
        raise ModelError(f"must be {what}", field=key, value=value)
    freeze_array(owner, key, (3,))
    lengths = getattr(owner, key).tolist()
    _check_lengths(lengths, key, what, lengths)


def _check_lengths(lengths: list[float], key: str, what: str, value: object) -> None:
    # Twice the size is what coal is given. Of Python's floats: NumPy's warn where it overflows.
    if not all(length > 0 and np.isfinite(2 * length) for length in lengths):
        raise ModelError(f"must be {what}", field=key, value=value)
    if min(lengths) < SHORT:
        raise ModelError(f"must be at least {SHORT:g} m", field=key, value=value)
