"""Arrays of a step, checked: real numbers of the right shape, read-only."""

from __future__ import annotations

import math
from collections.abc import Mapping
from contextvars import copy_context
from typing import Any

import numpy as np
from numpy.typing import NDArray

from quasistatic_ref.errors import StepDataError
from quasistatic_ref.tolerances import DEFINITE, SYMMETRIC

Array = NDArray[np.float64]

QUIET = copy_context()
"""Where NumPy does not warn: what overflows shows in the result, and the processor's flags, which
NumPy warns of, get lost between BLAS's threads. (np.errstate sets a variable that every call of
NumPy then looks up anew: 9 us a step.)"""
QUIET.run(np.seterr, all="ignore")


def read_only(array: NDArray[Any]) -> NDArray[Any]:
    """The same array, of any shape and unit [-], which cannot be written any more."""
    array.setflags(write=False)
    return array


def numbers(value: Any, name: str) -> Array:
    """Real numbers as a float64 array, of the same shape; not a copy if they are one already.

    Raises
    ------
    StepDataError
        Of strings, booleans and ragged lists.
    """
    if type(value) is np.ndarray and value.dtype == np.float64:
        return value
    try:
        array = np.array(value)
        if array.dtype.kind in "fiu" or (array.dtype.kind == "O" and array.size == 0):
            return array.astype(np.float64)
    except (TypeError, ValueError, OverflowError):
        pass
    raise StepDataError("must be numbers, in lists of equal length", field=name, value=value)


def finite(x: Array) -> bool:
    """Whether all numbers of a vector are finite: one product if they are, which may overflow."""
    return math.isfinite(x.dot(x)) or bool(np.isfinite(x).all())


def columns(value: Any, name: str, ndim: int) -> int:
    """Number of columns that a matrix, or a stack of matrices, has; StepDataError if it is none."""
    shape = numbers(value, name).shape
    if len(shape) != ndim:
        raise StepDataError(f"must have {ndim} dimensions, n_v columns", field=name, value=shape)
    return int(shape[-1])


def names(value: Any, name: str) -> tuple[str, ...]:
    """A tuple of strings; StepDataError of anything else, such as a single string."""
    if isinstance(value, str) or not all(isinstance(one, str) for one in value):
        raise StepDataError("must be a sequence of strings", field=name, value=value)
    return tuple(value)


def frozen(given: Mapping[str, tuple[Any, tuple[int, ...]]], prefix: str = "") -> dict[str, Array]:
    """Read-only float64 copies of numbers of any units [-], -0.0 becoming 0.0.

    They share one piece of memory, so that one look tells whether all of them are finite.

    Parameters
    ----------
    given : mapping of str to (numbers, shape)
        By the name of the field, which messages show behind the prefix.
    prefix : str

    Returns
    -------
    dict of str to ndarray
        By field, each of its shape.

    Raises
    ------
    StepDataError
        If some are no finite numbers, or not of that shape.
    """
    flat = []
    for key, (value, shape) in given.items():
        array = numbers(value, prefix + key)
        if array.shape != shape and (array.size or 0 not in shape):
            problem = f"must have shape {shape}"
            raise StepDataError(problem, field=prefix + key, value=array.shape)
        flat.append(array.ravel())
    whole = read_only(np.concatenate(flat) + 0.0)
    if np.count_nonzero(np.isfinite(whole)) < whole.size:
        for key, array in zip(given, flat, strict=True):
            if not np.isfinite(array).all():
                value = array.reshape(given[key][1]).tolist()
                problem = "must hold finite numbers only"
                raise StepDataError(problem, field=prefix + key, value=value)
    found, start = {}, 0
    for (key, (_, shape)), array in zip(given.items(), flat, strict=True):
        found[key] = whole[start : start + array.size].reshape(shape)
        start += array.size
    return found


def freeze(owner: Any, shapes: Mapping[str, tuple[int, ...]], prefix: str) -> None:
    """Replace fields of a frozen dataclass, of those shapes, by :func:`frozen` of them."""
    given = {key: (getattr(owner, key), shape) for key, shape in shapes.items()}
    for key, array in frozen(given, prefix).items():
        object.__setattr__(owner, key, array)


def definite(name: str, matrix: Any, n: int) -> Array:
    """A read-only copy, shape (n, n) [any unit], of a symmetric positive definite matrix.

    Raises
    ------
    StepDataError
        If it is none, not finite or of another shape.
    """
    return positive_definite(name, frozen({name: (matrix, (n, n))})[name])


def positive_definite(key: str, S: Array) -> Array:
    """Return S, of shape (n, n) [any unit], made exactly symmetric from its lower triangle.

    Raises
    ------
    StepDataError
        About the field `key`, if S is not symmetric or not positive definite.
    """
    scale = np.abs(S).max(initial=0.0)
    if np.abs(S - S.T).max(initial=0.0) > SYMMETRIC * scale:
        raise StepDataError("must be symmetric", field=key, value=S.tolist())
    S = np.tril(S) + np.tril(S, -1).T
    try:
        pivots = np.diag(np.linalg.cholesky(S)) ** 2
    except np.linalg.LinAlgError:
        pivots = np.full(len(S), -np.inf)
    # A pivot is what is left of its diagonal entry: a comparison that units cannot change.
    if (pivots <= DEFINITE * np.diag(S)).any():
        raise StepDataError(
            "must be positive definite (no zero stiffness, no massless link)",
            field=key,
            value=S.tolist(),
        )
    return read_only(S)
