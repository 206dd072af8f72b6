"""Fields of frozen dataclasses, checked and made read-only."""

import math
from collections.abc import Callable
from typing import Any, Final

from quasistatic_ref.errors import ModelError
from quasistatic_ref.numbers.arrays import Array, check_and_freeze, checked_numbers

SHORT: Final = 1e-15
"""Smallest length of a shape [m], about a proton's; quotients of lengths stay in float64's range.
"""


def finite_number(value: Any, key: str) -> float:
    """A finite float [the field's unit]; ModelError naming the field otherwise."""
    try:
        number = math.nan if isinstance(value, str | bool) else float(value)
    except (TypeError, ValueError, OverflowError):
        number = math.nan
    if not math.isfinite(number):
        raise ModelError("must be a finite number", field=key, value=value)
    return number


def set_half(
    owner: object,
    key: str,
    half: object,
    name: str,
    whole: object,
    checked: Callable[..., Any],
) -> None:
    """Set a field to half of a length, checked, that is given by either name.

    Raises
    ------
    ModelError
        Unless it is given by one of them, and is as `checked` wants it; it names that one.
    """
    if (half is None) == (whole is None):
        problem = f"must be given, or {name}, twice as long, and not both"
        raise ModelError(problem, field=key)
    if whole is None:
        size = checked(half, key, f", half of its {name}")
    else:
        size = checked(checked(whole, name) / 2, key)
    object.__setattr__(owner, key, size)


def freeze_array(owner: object, key: str, shape: tuple[int, ...]) -> None:
    """Replace a field by a read-only float64 copy; ModelError unless finite and of that shape."""
    check_and_freeze(owner, {key: shape}, error=ModelError)


def positive_length(value: Any, key: str, more: str = "") -> float:
    """A float; ModelError, which names the field, unless it is a length [m]."""
    number = finite_number(value, key)
    _check_lengths([number], key, f"a positive length{more}", value)
    return number


def positive_lengths(value: Any, key: str, more: str = "") -> Array:
    """Numbers, shape (3,); ModelError, which names the field, unless they are lengths [m]."""
    lengths = checked_numbers(value, key, ModelError)
    three = lengths.tolist() if lengths.shape == (3,) else []
    _check_lengths(three, key, f"three positive lengths{more}", lengths.tolist())
    return lengths


def _check_lengths(lengths: list[float], key: str, what: str, value: object) -> None:
    # Twice the size is what coal is given. Of Python's floats: NumPy's warn where it overflows.
    if not lengths or not all(length > 0 and math.isfinite(2 * length) for length in lengths):
        raise ModelError(f"must be {what}", field=key, value=value)
    if min(lengths) < SHORT:
        raise ModelError(f"must be at least {SHORT:g} m", field=key, value=value)
