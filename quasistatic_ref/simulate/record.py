"""What a record of a run holds, and whether a header and arrays are one."""

from collections.abc import Callable, Iterable, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from quasistatic_ref.errors import InputError, about_field
from quasistatic_ref.formats.quoting import suggestion
from quasistatic_ref.formats.table_reader import TableReader
from quasistatic_ref.simulate.finding import finding_read
from quasistatic_ref.simulate.law import CONVEX, COULOMB, ITERATED, LAWS
from quasistatic_ref.step.cones import cone

RECORDS = ("full", "light", "forces")
CONSTANT = ("mu_v", "mu_omega", "rows")
"""Arrays without a step axis."""
PER_STEP = (
    "t", "delta_q", "q_bar_a", "phi", "alpha", "beta", "n", "d1", "d2", "point", "lam", "wrench",
    "certificate", "worst_residual", "digits",
)  # fmt: skip
PROGRAM = ("H", "g", "A", "b", "J", "K_q", "M_u", "tau_a", "tau_u", "delta_q_bar_a")
"""What a full record adds, step by step."""
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


def check_arrays(top: TableReader, arrays: Mapping[str, NDArray[Any]]) -> None:
    """Refuse a header and arrays that do not belong together.

    Parameters
    ----------
    top : TableReader
        The header.
    arrays : mapping of str to ndarray
        Everything else in the file, of whatever shape [of the notation].

    Raises
    ------
    InputError
    """
    _check_present(arrays, ("t", "q", "delta_q", *CONSTANT))
    for name, array in arrays.items():
        if array.ndim == 0:
            raise InputError("must have an entry a step, not a single number", field=name)
    steps = top.integer("steps", least=0)
    record = top.text("record", choices=RECORDS)
    full = record == "full"
    top.number("h", above=0.0)
    _unless_null(top, "failed", top.text)
    for name in ("quasi_dynamic_number", "largest_boundary_layer"):
        _unless_null(top, name, top.number)
    top.text("backend")
    with about_field("cone"):
        friction = cone(top.text("cone"))
    n_v = top.integer("n_a", least=0) + top.integer("n_u", least=0)
    if len(top.words("coordinates")) != n_v:
        raise InputError(f"must have {n_v} entries", field="coordinates")
    for name, count in (("units", n_v), ("positions", arrays["q"].shape[-1])):
        if len(top.words(name, [""] * count)) != count:  # files from before there were any
            raise InputError(f"must have {count} entries", field=name)
    top.words("slots", [])
    extra = top.words("extra")
    iterated = ITERATED if top.text("law", CONVEX, LAWS) == COULOMB else ()
    if steps:
        needed = (*PER_STEP, *PROGRAM, *(EXTRA if extra else ())) if full else PER_STEP
        _check_present(arrays, (*needed, *(FORCES if record == "forces" else ()), *iterated))
    if any(name in arrays for name in COST):
        _check_present(arrays, COST)
    of_record = {"full": (*PROGRAM, *COST, "forces"), "forces": FORCES}.get(record, ())
    known = ("q", *CONSTANT, *PER_STEP, *of_record, *(EXTRA if extra else ()), *iterated)
    for name in arrays:
        if name not in known:
            raise InputError(f"is unknown{suggestion(name, known)}", field=name)
    for name, array in arrays.items():
        if array.dtype.kind not in ("U" if name == "certificate" else "fiu"):
            raise InputError("must contain numbers", field=name, value=str(array.dtype))
        numbers = array[~np.isnan(array)] if name in NOT_KNOWN else array
        if array.dtype.kind == "f" and not np.isfinite(numbers).all():
            raise InputError("must contain finite numbers only", field=name)
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
    if steps and full:  # an extension may have coordinates of its own
        shapes["J"] = (steps, n_c, 4, max(n_v, arrays["g"].shape[-1]))
    for name, shape in shapes.items():
        if name in arrays and arrays[name].shape != shape:
            problem = f"must have shape {shape}"
            raise InputError(problem, field=name, value=arrays[name].shape)
    multipliers = sum(friction.counts(arrays["rows"]).tolist())
    if steps and arrays["lam"][0].size < multipliers:
        problem = f"must have {multipliers} multipliers a step, as the rows of contacts say"
        raise InputError(problem, field="lam", value=arrays["lam"].shape)
    contacts = top.sequence("contacts")
    if full and len(contacts) != steps:
        raise top.error_about("contacts", f"must have {steps} entries", len(contacts))
    if not all(isinstance(names, list) for names in contacts):
        raise top.error_about("contacts", "must be lists of names", contacts)
    top.words("warnings", [])  # of files from before there were findings
    for i, table in enumerate(top.sequence("findings", [])):
        finding_read(table, f"findings[{i}]")
    top.text("not_looked_at", "")
    top.boolean("alone", True)
    top.sequence("unanswered", [])
    top.take("scene", None)  # the account reads it
    top.close()


def _unless_null(top: TableReader, name: str, read: Callable[[str], Any]) -> None:
    if top.is_null(name):
        top.take(name)
    else:
        read(name)


def _check_present(arrays: Mapping[str, NDArray[Any]], names: Iterable[str]) -> None:
    missing = sorted(set(names) - set(arrays))
    if missing:
        raise InputError(f"has no array named {missing[0]!r}")
