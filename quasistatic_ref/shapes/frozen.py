"""Fields of frozen dataclasses, checked and made read-only."""

from typing import Any

import numpy as np

from quasistatic_ref.errors import ModelError
from quasistatic_ref.step.arrays import freeze, numbers
from quasistatic_ref.tolerances import SHORT


def finite(value: Any, key: str) -> float:
    """A finite float [the field's unit]; ModelError naming the field otherwise."""
    try:
        number = float(value)
    except (TypeError, ValueError, OverflowError):
        raise ModelError("must be a finite number", field=key, value=value) from None
    if not np.isfinite(number):
        raise ModelError("must be a finite number", field=key, value=value)
    return number


def halved(owner: Any, key: str, half: Any, name: str, whole: Any) -> None:
    """Set a field to half of a length that is given by either name; ModelError unless by one."""
    if (half is None) == (whole is None):
        problem = f"must be given, or {name}, twice as long, and not both"
        raise ModelError(problem, field=key)
    object.__setattr__(owner, key, numbers(whole, name, ModelError) / 2 if half is None else half)


def freeze_size(owner: Any, key: str) -> None:
    """Replace a field by a float; ModelError unless it is positive."""
    value = getattr(owner, key)
    number = finite(value, key)
    # Twice the size is what coal is given.
    if not (number > 0 and np.isfinite(2 * number)):
        raise ModelError("must be a positive length", field=key, value=value)
    if number < SHORT:
        raise ModelError(f"must be at least {SHORT:g} m", field=key, value=value)
    object.__setattr__(owner, key, number)


def freeze_array(owner: Any, key: str, shape: tuple[int, ...]) -> None:
    """Replace a field by a read-only float64 copy; ModelError unless finite and of that shape."""
    freeze(owner, {key: shape}, error=ModelError)


def freeze_lengths(owner: Any, key: str) -> None:
    """Replace a field by three positive lengths, read-only; ModelError if they are not."""
    freeze_array(owner, key, (3,))
    lengths = getattr(owner, key)
    # Of Python's floats: NumPy's warn where twice a length overflows.
    if not all(length > 0 and np.isfinite(2 * length) for length in lengths.tolist()):
        raise ModelError("must be three positive lengths", field=key, value=lengths.tolist())
    if not (lengths >= SHORT).all():
        raise ModelError(f"must be at least {SHORT:g} m", field=key, value=lengths.tolist())
