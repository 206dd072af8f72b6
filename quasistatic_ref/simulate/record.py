"""The arrays of a record of a run, and whether a header and arrays are one."""

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from quasistatic_ref.errors import InputError
from quasistatic_ref.formats.quoting import suggestion
from quasistatic_ref.simulate.header import Header
from quasistatic_ref.simulate.law import COULOMB, ITERATED
from quasistatic_ref.step.cones import cone

CONSTANT = ("mu_v", "mu_omega", "rows")
"""Arrays without a step axis."""
PER_STEP = (
    "t", "delta_q", "q_bar_a", "phi", "alpha", "beta", "n", "d1", "d2", "point", "lam", "wrench",
    "certificate", "worst_residual", "digits",
)  # fmt: skip
PROGRAM = ("H", "g", "A", "b", "J", "K_q", "M_u", "tau_a", "tau_u", "delta_q_bar_a")
"""What a full record adds, step by step."""
LOADS = PROGRAM[-3:]
"""Fields of a step that are no matrices."""
OF_MANY = ("column", *PROGRAM[4:])
"""What it adds of a `fast` step of many bodies: of J and M_u what can differ from zero."""
LARGEST = 1_000_000
"""Entries of J from which a step is one of many bodies; beyond those of one step, no more are kept
before they become arrays."""
NOT_KNOWN = ("worst_residual", "digits", "forces", "imbalance")
"""Arrays that hold NaN where nothing was certified, or no forces were found; all others are finite.
"""
FORCES = ("forces", "imbalance", "motion")
"""What a record of forces adds to a light one."""
EXTRA = ("lam_extra", "extra_A", "extra_b")
"""What the rows of an extension add: the multipliers, and to a full record the rows."""
OF_STEP = ("t", "certificate", "worst_residual", "digits", "imbalance")
"""Arrays with one entry a step."""
OF_CONTACT = {
    **dict.fromkeys(("phi", "point"), ()),
    **dict.fromkeys(("alpha", "beta", "n", "d1", "d2"), (3,)),
    **dict.fromkeys(("wrench", "forces", "motion"), (4,)),
}
"""Shape of an entry of arrays that have one for each contact in each step."""
COST = ("extra_H", "extra_g")
"""What a quadratic cost of an extension adds to a full record."""


def check_needed(arrays: Mapping[str, NDArray[Any]]) -> None:
    """Refuse `arrays`, of whatever shape [of the notation], without which no file is a record.

    Raises
    ------
    InputError
    """
    _check_present(arrays, ("t", "q", "delta_q", *CONSTANT))
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
    n_v = header.n_a + header.n_u
    counts = {"coordinates": n_v, "units": n_v, "positions": arrays["q"].shape[-1]}
    for name, count in counts.items():
        names = getattr(header, name)
        if len(names) != count:
            raise InputError(f"must have {count} entries", field=name, value=len(names))
    _check_names(header, arrays)
    for name, array in arrays.items():
        if array.dtype.kind not in ("U" if name == "certificate" else "fiu"):
            raise InputError("must contain numbers", field=name, value=str(array.dtype))
        numbers = array[~np.isnan(array)] if name in NOT_KNOWN else array
        if array.dtype.kind == "f" and not np.isfinite(numbers).all():
            raise InputError("must contain finite numbers only", field=name)
    _check_shapes(header, arrays)
    steps = header.steps
    multipliers = sum(cone(header.cone).counts(arrays["rows"]).tolist())
    if steps and arrays["lam"][0].size < multipliers:
        problem = f"must have {multipliers} multipliers a step, as the rows of contacts say"
        raise InputError(problem, field="lam", value=arrays["lam"].shape)
    if header.record == "full" and len(header.contacts) != steps:
        problem = f"must have {steps} entries"
        raise InputError(problem, field="contacts", value=len(header.contacts))


def _check_names(header: Header, arrays: Mapping[str, NDArray[Any]]) -> None:
    """Refuse a record with an array too many or too few."""
    full = header.record == "full"
    extra = EXTRA if header.extra else ()
    iterated = ITERATED if header.law == COULOMB else ()
    program = OF_MANY if "column" in arrays else PROGRAM
    own = {"full": program, "forces": FORCES}.get(header.record, ())
    if header.steps:
        _check_present(arrays, (*PER_STEP, *own, *(extra if full else ()), *iterated))
    if any(name in arrays for name in COST):
        _check_present(arrays, COST)
    more = (*COST, "forces") if full else ()
    known = ("q", *CONSTANT, *PER_STEP, *own, *more, *extra, *iterated)
    for name in arrays:
        if name not in known:
            raise InputError(f"is unknown{suggestion(name, known)}", field=name)


def _check_shapes(header: Header, arrays: Mapping[str, NDArray[Any]]) -> None:
    """Refuse an array of another length or shape than the header and the other arrays say."""
    steps = header.steps
    n_v = header.n_a + header.n_u
    lengths = {name: steps for name in arrays if name not in ("q", *CONSTANT)}
    for name, length in {**lengths, "q": steps + 1}.items():
        if len(arrays[name]) != length:
            problem = f"must have {length} entries, as the header says"
            raise InputError(problem, field=name, value=arrays[name].shape)
    n_c = arrays["rows"].size
    of_steps = {name: (steps, n_c, *shape) for name, shape in OF_CONTACT.items()}
    of_steps |= dict.fromkeys(OF_STEP, (steps,)) | {"delta_q": (steps, n_v)}
    shapes: dict[str, tuple[int, ...]] = dict.fromkeys(CONSTANT, (n_c,))
    if steps:
        shapes |= of_steps | {n: (steps, arrays[n].shape[-1]) for n in ("q_bar_a", "lam")}
    if "column" in arrays:
        column = arrays["column"]
        width = column.shape[-1]
        size = max(1, arrays["M_u"].shape[-1])
        shapes |= {"column": (steps, n_c, width), "J": (steps, n_c, 4, width)}
        shapes["M_u"] = (steps, header.n_u // size, size, size)
        if column.dtype.kind == "f" or ((column < 0) | (column > n_v)).any():
            raise InputError(f"must contain whole numbers of 0 to {n_v}", field="column")
    elif steps and header.record == "full":  # an extension may have coordinates of its own
        shapes["J"] = (steps, n_c, 4, max(n_v, arrays["g"].shape[-1]))
    for name, shape in shapes.items():
        if name in arrays and arrays[name].shape != shape:
            problem = f"must have shape {shape}"
            raise InputError(problem, field=name, value=arrays[name].shape)


def _check_present(arrays: Mapping[str, NDArray[Any]], names: Iterable[str]) -> None:
    missing = sorted(set(names) - set(arrays))
    if missing:
        raise InputError(f"has no array named {missing[0]!r}")
