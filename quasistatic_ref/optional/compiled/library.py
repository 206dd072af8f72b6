"""The compiled library, which is called by cffi."""

import ctypes
import os
from collections.abc import Callable, Iterable
from functools import cache
from typing import Any, Final

import numpy as np
from _cffi_backend import FFI  # cffi itself imports a parser of C, which takes longer than a step
from numpy.typing import NDArray

from quasistatic_ref.optional.compiled.build import LIBRARY, PROBLEM, VARIABLE, digest

ARGUMENTS: Final = {
    "cloud_contacts": 14,
    "plus": 6,
    "change": 6,
    "frames": 11,
    "pyramid_rows": 10,
    "step_sizes": 9,
}
"""Numbers of arguments of each function, all of them addresses of arrays."""

_ffi = FFI()
_address = _ffi.from_buffer


def addresses(read: Iterable[NDArray[Any]], written: Iterable[NDArray[Any]] = ()) -> list[Any]:
    """Addresses of arrays, as C takes them, which keep these alive.

    Parameters
    ----------
    read, written : iterable of ndarray [any unit]
        Of numbers of 64 bits or truth values, of any shape and unit. Those that are read are copied
        where they are not contiguous.
    """
    return [*map(_address, map(np.ascontiguousarray, read)), *map(_address, written)]


def missing() -> str | None:
    """Why no compiled code is used, in words; None if it is."""
    loaded = _loaded()
    return loaded if isinstance(loaded, str) else None


def function(name: str) -> Callable[..., int]:
    """A function of the library by its name, where nothing is :func:`missing`."""
    arguments = ", ".join(["const void *"] * ARGUMENTS[name])
    found: Callable[..., int] = _of_type(_loaded(), name, f"int64_t(*)({arguments})")
    return found


@cache
def _loaded() -> Any:
    if os.environ.get(VARIABLE) == "0":
        return f"{VARIABLE} is 0"
    if not LIBRARY.exists():
        why = PROBLEM.read_text("utf-8") if PROBLEM.exists() else "the package was copied"
        return f"it was not compiled when the package was installed: {why}"
    try:
        library = ctypes.CDLL(str(LIBRARY))
        sources = _ffi.string(_of_type(library, "digest", "const char *(*)(void)")()).decode()
    except (OSError, AttributeError) as failure:  # another machine's; without the function
        return f"it cannot be loaded: {failure}"
    if sources != digest():
        return "it was compiled from other sources than those here; install the package again"
    return library


def _of_type(library: ctypes.CDLL, name: str, written: str) -> Any:
    """A function of a library by its name, of a type as it is written in C."""
    return _ffi.cast(written, ctypes.cast(getattr(library, name), ctypes.c_void_p).value)
