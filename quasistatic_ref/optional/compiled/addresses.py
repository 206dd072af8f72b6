"""Addresses of arrays, as C takes them: imported where there is a library to call, by its cffi."""

from collections.abc import Iterable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from quasistatic_ref.optional.compiled.declared import ffi

_address = ffi.from_buffer


def addresses(read: Iterable[NDArray[Any]], written: Iterable[NDArray[Any]] = ()) -> list[Any]:
    """Addresses of arrays, as C takes them, which keep these alive.

    Parameters
    ----------
    read, written : iterable of ndarray [any unit]
        Of numbers of 64 bits or truth values, of any shape and unit. Those that are read are copied
        where they are not contiguous.
    """
    return [*map(_address, map(np.ascontiguousarray, read)), *map(_address, written)]
