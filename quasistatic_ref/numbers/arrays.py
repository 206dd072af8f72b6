"""Arrays of a step, checked: real numbers of the right shape, read-only."""

import math
from collections.abc import Callable, Iterable, Mapping
from contextlib import suppress
from contextvars import Context, ContextVar, copy_context
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from quasistatic_ref.errors import InputError, StepDataError

Array = NDArray[np.float64]
Indices = NDArray[np.int64]
Mask = NDArray[np.bool_]

Result = TypeVar("Result")
Scalar = TypeVar("Scalar", bound=np.generic)

_QUIET = copy_context()
_QUIET.run(np.seterr, all="ignore")

_CALLER: ContextVar[Context | None] = ContextVar("_CALLER", default=None)
"""The context around :func:`without_warnings`; None outside of it."""


def without_warnings(function: Callable[..., Result], *arguments: object) -> Result:
    """Call a function where NumPy does not warn, and return its result.

    An overflow shows in the result, and the flags of the processor, on which NumPy's warnings
    depend, get lost between BLAS's threads. (To call ``np.seterr`` each time takes longer.)
    """
    caller = _CALLER.get()
    caller = copy_context() if caller is None else caller
    return _QUIET.copy().run(_called_from, caller, function, arguments)


def _called_from(
    caller: Context, function: Callable[..., Result], arguments: tuple[object, ...]
) -> Result:
    _CALLER.set(caller)
    return function(*arguments)


def as_caller(function: Callable[..., Result], *arguments: object) -> Result:
    """Call a user's function in the context around :func:`without_warnings`."""
    caller = _CALLER.get()
    return function(*arguments) if caller is None else caller.run(function, *arguments)


def read_only(array: NDArray[Scalar]) -> NDArray[Scalar]:
    """An array itself, of any shape and unit [-], which cannot be written any more."""
    array.setflags(write=False)
    return array


def checked_numbers(value: object, name: str, error: type[InputError] = StepDataError) -> Array:
    """Real numbers as a float64 array of the same shape; a float64 array is returned itself.

    Raises
    ------
    InputError
        Of the type `error`, for strings, booleans and ragged lists.
    """
    if type(value) is np.ndarray and value.dtype == np.float64:
        return value
    try:
        array = np.array(value)
        numbers = array.dtype.kind in "fiu" or (array.dtype.kind == "O" and array.size == 0)
        if numbers and not _has_truth(value):
            return array.astype(np.float64)
    except (TypeError, ValueError, OverflowError):
        pass
    raise error("must be numbers, in lists of equal length", field=name, value=value)


def positive_number(value: object, field: str) -> float:
    """A number greater than 0 [any unit]; InputError of anything else, such as a string."""
    number = np.array(np.nan)
    with suppress(InputError):
        number = checked_numbers(value, field, InputError)
    if number.shape != () or not number > 0:
        raise InputError("must be a number greater than 0", field=field, value=value)
    return float(number)


def _has_truth(value: object) -> bool:
    """Whether nested lists contain True or False, which NumPy would take for 1 and 0."""
    if isinstance(value, list | tuple):
        return any(map(_has_truth, value))
    return isinstance(value, bool | np.bool_)


def all_finite(x: Array) -> bool:
    """Whether all numbers of a vector are finite: one product if they are, which may overflow."""
    return math.isfinite(x.dot(x)) or bool(np.isfinite(x).all())


def column_count(value: object, name: str, ndim: int) -> int:
    """Number of columns of a matrix or a stack of matrices; StepDataError of anything else."""
    shape = checked_numbers(value, name).shape
    if len(shape) != ndim:
        raise StepDataError(f"must have {ndim} dimensions, n_v columns", field=name, value=shape)
    return int(shape[-1])


def checked_names(value: object, name: str) -> tuple[str, ...]:
    """A tuple of strings; StepDataError of anything else, such as a single string."""
    if isinstance(value, Iterable) and not isinstance(value, str):
        names = tuple(value)
        if all(isinstance(one, str) for one in names):
            return names
    raise StepDataError("must be a sequence of strings", field=name, value=value)


def with_shape(
    value: object, name: str, shape: tuple[int, ...], error: type[InputError] = StepDataError
) -> Array:
    """Real numbers as a float64 array of a shape; no numbers have each shape that holds none.

    Raises
    ------
    InputError
        Of the type `error`, if it is none or of another shape.
    """
    array = checked_numbers(value, name, error)
    if array.shape != shape and (array.size or 0 not in shape):
        raise error(f"must have shape {shape}", field=name, value=array.shape)
    return array.reshape(shape)


def checked_array(
    value: object, name: str, shape: tuple[int, ...], error: type[InputError] = StepDataError
) -> Array:
    """A read-only float64 copy of numbers of any unit [-], -0.0 becoming 0.0.

    Parameters
    ----------
    value : array_like
    name : str
        Of the field, in messages.
    shape : tuple of int
    error : type
        The :class:`~quasistatic_ref.errors.InputError` to raise.

    Returns
    -------
    ndarray, of that shape

    Raises
    ------
    InputError
        If the numbers are not finite, or not of that shape.
    """
    array = checked_numbers(value, name, error)
    if array.shape != shape:
        array = with_shape(value, name, shape, error)
    if not np.isfinite(array).all():
        raise error("must contain finite numbers only", field=name, value=array.tolist())
    copy: Array = array + 0.0
    copy.setflags(write=False)
    return copy


def check_and_freeze(
    owner: object,
    shapes: Mapping[str, tuple[int, ...]],
    prefix: str = "",
    error: type[InputError] = StepDataError,
) -> None:
    """Check named fields of a frozen dataclass for their shapes, and replace them."""
    for key, shape in shapes.items():
        array = checked_array(getattr(owner, key), prefix + key, shape, error)
        object.__setattr__(owner, key, array)


def freeze_copies(owner: object, *fields: str) -> None:
    """Replace fields of a frozen dataclass by read-only copies, which no caller can change."""
    for field in fields:
        object.__setattr__(owner, field, read_only(np.array(getattr(owner, field))))
