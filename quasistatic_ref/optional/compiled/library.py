"""The compiled library, loaded by cffi with the declarations of ``source/fast.h``."""

import os
from collections.abc import Callable, Mapping
from functools import cache
from typing import Any, Final

import numpy as np
from cffi import FFI
from numpy.typing import NDArray

from quasistatic_ref.optional.compiled.build import LIBRARY, PROBLEM, SOURCE, digest

ffi = FFI()
ffi.cdef((SOURCE / "fast.h").read_text("utf-8"))


def missing() -> str | None:
    """Why there is no library, in words; None if there is one.

    The simulator then says so once and takes the plain path, with the same certified bits.
    """
    loaded = _loaded()
    return loaded if isinstance(loaded, str) else None


def library() -> Any:
    """The functions of ``source/fast.h``, where nothing is :func:`missing`."""
    return _loaded()


@cache
def _loaded() -> Any:
    if not LIBRARY.exists():
        why = PROBLEM.read_text("utf-8") if PROBLEM.exists() else "the package was copied"
        return f"it was not compiled when the package was installed: {why}"
    try:
        functions = ffi.dlopen(str(LIBRARY))
        sources = ffi.string(functions.digest()).decode()
    except (OSError, AttributeError) as failure:  # another machine's; without the function
        return f"it cannot be loaded: {failure}"
    if sources != digest():
        return "it was compiled from other sources than those here; install the package again"
    return functions


class Structure:
    """A structure of ``source/fast.h``, and the arrays that it refers to.

    Parameters
    ----------
    name : str
    fields : mapping of str to int or ndarray
        Arrays of float64, of int64, or of addresses, of any shape [any unit], copied if not
        contiguous; of an array that is kept elsewhere, its address.

    Attributes
    ----------
    pointer : object
        What functions take.
    """

    def __init__(self, name: str, fields: Mapping[str, int | NDArray[Any]]) -> None:
        self.pointer = ffi.new(f"{name} *")
        self._arrays: dict[str, NDArray[Any]] = {}
        types = dict(ffi.typeof(name).fields)
        for field, value in fields.items():
            if isinstance(value, int):
                number = value
            else:
                array = np.ascontiguousarray(value)
                assert array.dtype in (np.float64, np.int64)
                self._arrays[field] = array
                number = array.ctypes.data
            setattr(self.pointer, field, ffi.cast(types[field].type, number))

    def __getitem__(self, field: str) -> NDArray[Any]:
        """An array of the structure by its field, which C may write."""
        return self._arrays[field]


VARIABLE: Final = "QUASISTATIC_REF_COMPILED"
"""The variable of the environment that turns compiled code off, if it is 0."""

ARGUMENTS: Final = {"cloud_contacts": 14, "plus": 5, "change": 5}
"""Numbers of arguments of each function, all of them addresses of arrays; it returns whether it
has answered."""

address = ffi.from_buffer
"""The address of a contiguous array, as C takes it; what is returned keeps the array alive."""


@cache
def turned_off() -> bool:
    """Whether the user wants no compiled code."""
    return os.environ.get(VARIABLE) == "0"


@cache
def function(name: str) -> Callable[..., int]:
    """A function of the library by its name, where nothing is :func:`missing`."""
    found: Callable[..., int] = getattr(_functions(), name)
    return found


@cache
def _functions() -> Any:
    declared = [
        f"int64_t {name}({', '.join(['const void *'] * count)});"
        for name, count in ARGUMENTS.items()
    ]
    ffi.cdef("\n".join(declared))
    return ffi.dlopen(str(LIBRARY))


def addresses(*arrays: NDArray[Any]) -> list[Any]:
    """Addresses of arrays that stay, of numbers of 64 bits, copied where not contiguous."""
    contiguous = [np.ascontiguousarray(array) for array in arrays]
    assert all(array.dtype in (np.float64, np.int64) for array in contiguous)
    return [address(array) for array in contiguous]
