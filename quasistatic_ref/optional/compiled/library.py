"""The compiled library, loaded by cffi with the declarations of ``source/fast.h``."""

from collections.abc import Mapping
from functools import cache
from typing import Any

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
