"""What a record of a run holds, and whether a header and arrays are one."""

from collections.abc import Iterable, Mapping
from typing import Any

from numpy.typing import NDArray

from quasistatic_ref.errors import InputError
from quasistatic_ref.formats.fields import Fields

RECORDS = ("full", "light")
CONSTANT = ("mu_v", "mu_omega", "rows")
"""Arrays without a step axis."""
PER_STEP = (
    "t", "delta_q", "q_bar_a", "phi", "alpha", "beta", "n", "d1", "d2", "point", "lam", "wrench",
    "certificate", "worst_residual", "digits",
)  # fmt: skip
PROGRAM = ("H", "g", "A", "b", "J", "K_q", "M_u", "tau_a", "tau_u", "delta_q_bar_a")
"""What a full record adds, step by step."""
EXTRA = ("lam_extra", "extra_A", "extra_b")
"""What the rows of an extension add: the multipliers, and to a full record the rows."""


def check_arrays(top: Fields, arrays: Mapping[str, NDArray[Any]]) -> None:
    """Refuse a header and arrays that do not belong together.

    Parameters
    ----------
    top : Fields
        The header.
    arrays : mapping of str to ndarray
        Everything else in the file, of whatever shape [of the notation].

    Raises
    ------
    InputError
    """
    _check_present(arrays, ("t", "q", "delta_q", *CONSTANT))
    steps = top.integer("steps", least=0)
    full = top.text("record", choices=RECORDS) == "full"
    top.number("h", above=0.0)
    if not top.is_null("failed"):
        top.text("failed")
    extra = top.sequence("extra", [])
    needed: tuple[str, ...] = ("t", "delta_q")
    if steps:
        needed = (*PER_STEP, *PROGRAM, *(EXTRA if extra else ())) if full else PER_STEP
        _check_present(arrays, needed)
    for name, array in arrays.items():
        if array.dtype.kind not in ("U" if name == "certificate" else "fiu"):
            raise InputError("must hold numbers", field=name, value=str(array.dtype))
    for name, length in {**dict.fromkeys(needed, steps), "q": steps + 1}.items():
        if arrays[name].ndim == 0 or len(arrays[name]) != length:
            problem = f"must have {length} entries, as the header says"
            raise InputError(problem, field=name, value=arrays[name].shape)
    contacts = top.sequence("contacts")
    if full and len(contacts) != steps:
        raise top.fail("contacts", f"must have {steps} entries", len(contacts))
    if not all(isinstance(names, list) for names in contacts):
        raise top.fail("contacts", "must be lists of names", contacts)
    top.words("warnings", [])


def _check_present(arrays: Mapping[str, NDArray[Any]], names: Iterable[str]) -> None:
    missing = sorted(set(names) - set(arrays))
    if missing:
        raise InputError(f"holds no array named {missing[0]!r}")
