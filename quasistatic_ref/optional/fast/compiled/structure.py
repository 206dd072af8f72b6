"""Structures of C: numbers, and addresses of arrays that are kept as long as they are."""

import ctypes
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray


class Structure:
    """A structure that C reads and writes.

    Parameters
    ----------
    numbers, arrays : sequence of str
        Names of its fields in their order: 64-bit integers, then pointers.
    size : callable
        The C function that says how large the structure is there.
    """

    def __init__(self, numbers: Sequence[str], arrays: Sequence[str], size: Any) -> None:
        fields = [*((name, ctypes.c_int64) for name in numbers)]
        kinds = [*fields, *((name, ctypes.c_void_p) for name in arrays)]
        self._fields = type("Fields", (ctypes.Structure,), {"_fields_": kinds})()
        size.restype = ctypes.c_int64
        assert size() == ctypes.sizeof(self._fields)
        self._arrays: dict[str, NDArray[Any]] = {}
        self.address = ctypes.addressof(self._fields)

    def __getitem__(self, name: str) -> NDArray[Any]:
        """One of its arrays, which C may write."""
        return self._arrays[name]

    def number(self, name: str) -> int:
        """One of its integers."""
        return int(getattr(self._fields, name))

    def put(self, values: Mapping[str, Any]) -> None:
        """Set some fields: integers, and arrays of float64 or int64, copied if not contiguous."""
        for name, value in values.items():
            if isinstance(value, int):
                setattr(self._fields, name, value)
                continue
            array = np.ascontiguousarray(value)
            assert array.dtype in (np.float64, np.int64)
            self._arrays[name] = array
            setattr(self._fields, name, array.ctypes.data)
