"""Whether the arrays of a file are those of a trajectory, and belong to its header."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from quasistatic_ref.errors import InputError
from quasistatic_ref.quoting import suggestion
from quasistatic_ref.simulate.record.header import Header
from quasistatic_ref.simulate.record.table import (
    ARRAYS,
    FORCES,
    FULL,
    lengths_of,
    names_of,
    no_steps,
    shape_of,
)
from quasistatic_ref.step.cones import cone

NEEDED = ("t", "q", "delta_q", "mu_v", "mu_omega", "rows")
"""Without these no file is a record."""


def check_needed(arrays: Mapping[str, NDArray[Any]]) -> None:
    """Refuse `arrays`, of whatever shape [of the notation], without which no file is a record.

    Raises
    ------
    InputError
    """
    for name in NEEDED:
        _check_present(arrays, name)
    for name, array in arrays.items():
        if array.ndim == 0:
            raise InputError("must have an entry a step, not a single number", field=name)


def check_arrays(header: Header, arrays: Mapping[str, NDArray[Any]]) -> None:
    """Refuse a header and arrays that do not belong together.

    Parameters
    ----------
    header : Header
    arrays : mapping of str to ndarray
        Everything else in the file, of whatever shape [of the notation].

    Raises
    ------
    InputError
    """
    lengths = lengths_of(header)
    n_v = lengths["n_v"]
    n_c = arrays["rows"].size
    counts = {"coordinates": n_v, "units": n_v, "positions": arrays["q"].shape[-1], "slots": n_c}
    for name, count in counts.items():
        if len(getattr(header, name)) != count:
            problem = f"must have {count} entries"
            raise InputError(problem, field=name, value=len(getattr(header, name)))
    own_cost = "extra_H" in arrays or "extra_g" in arrays
    wanted = names_of(header.record, header.law, bool(header.extra), own_cost)
    known = [*wanted, FORCES] if header.record == FULL else wanted
    for name in arrays:
        if name not in known:
            raise InputError(f"is unknown{suggestion(name, known)}", field=name)
    for name in wanted:
        _check_present(arrays, name)
    _check_array("rows", arrays["rows"], lengths)
    multipliers = int(cone(header.cone).counts(arrays["rows"]).sum())
    lengths |= {"m": multipliers, "M": multipliers + lengths["e"]}
    for name in arrays:
        _check_array(name, arrays[name], lengths)
    if header.record != FULL:
        return
    if lengths["N"] < n_v or lengths["N_u"] != lengths["N"] - header.n_a:
        problem = f"must have at least {n_v} columns, those of g and as many as tau_a and tau_u"
        raise InputError(problem, field="J", value=arrays["J"].shape)
    if len(header.contacts) != header.steps:
        problem = f"must have {header.steps} entries"
        raise InputError(problem, field="contacts", value=len(header.contacts))
    for k, names in enumerate(header.contacts):
        if len(names) != n_c or not all(isinstance(name, str) for name in names):
            raise InputError(f"must be {n_c} names", field=f"contacts[{k}]", value=list(names))


def without_steps(header: Header, arrays: Mapping[str, NDArray[Any]]) -> dict[str, NDArray[Any]]:
    """The arrays of a file of no steps, with the arrays that older files lack.

    Parameters
    ----------
    header : Header
    arrays : mapping of str to ndarray
        Of the file, of whatever shape [of the notation].

    Returns
    -------
    dict of str to ndarray, of shape (0, ...) but q and what is constant
    """
    n_c = len(header.slots)
    rows = arrays["rows"] if arrays["rows"].shape == (n_c,) else np.full(n_c, 6)
    given = {
        name: array
        for name, array in arrays.items()
        if name not in ARRAYS or array.ndim == len(ARRAYS[name].shape.split())
    }
    constant = {name: array for name, array in given.items() if array.shape == (n_c,)}
    of_steps = {name: array for name, array in given.items() if not _constant(name)}
    return {**no_steps(header, rows), "rows": rows, **constant, **of_steps}


def _constant(name: str) -> bool:
    """Whether an array has no axis of steps."""
    return name in ARRAYS and not ARRAYS[name].shape.startswith("T")


def _check_array(name: str, array: NDArray[Any], lengths: dict[str, int]) -> None:
    """Refuse an array of the wrong type or shape; a letter's length is set by its first use."""
    kept = ARRAYS[name]
    if array.dtype.kind not in ("U" if kept.dtype is np.str_ else "fiu"):
        raise InputError("must contain numbers", field=name, value=str(array.dtype))
    letters = kept.shape.split()
    if letters[0].startswith("T") and len(array) != lengths[letters[0]]:
        problem = f"must have {lengths[letters[0]]} entries, as the header says"
        raise InputError(problem, field=name, value=array.shape)
    if array.ndim == len(letters):
        for letter, length in zip(letters, array.shape, strict=True):
            lengths.setdefault(letter, length)
    shape = shape_of(kept.shape, lengths)
    if array.shape != shape:
        problem = f"must have shape {kept.shape.replace(' ', ' x ')}, here {shape}"
        raise InputError(problem, field=name, value=array.shape)
    if array.dtype.kind == "f":
        numbers = array[~np.isnan(array)] if kept.nan else array
        if not np.isfinite(numbers).all():
            raise InputError("must contain finite numbers only", field=name)


def _check_present(arrays: Mapping[str, NDArray[Any]], name: str) -> None:
    if name not in arrays:
        raise InputError(f"has no array named {name!r}; write it again")
