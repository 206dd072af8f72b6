"""Structures of C: numbers, and addresses of arrays that are kept as long as they are."""

import ctypes
import math
import re
from collections.abc import Mapping, Sequence
from functools import cache
from typing import cast

import numpy as np
from numpy.typing import NDArray

from quasistatic_ref.optional.fast.compiled.library import SOURCE
from quasistatic_ref.step.arrays import Array, Indices

COMMENT = re.compile(r"/\*.*?\*/", re.DOTALL)


class Structure:
    """A structure that C reads and writes.

    Parameters
    ----------
    file, name : str
        Where C declares it, and its name there.
    """

    def __init__(self, file: str, name: str) -> None:
        self._fields = fields(file, name)()
        self._arrays: dict[str, Array] = {}
        self.address = ctypes.addressof(self._fields)

    def __getitem__(self, name: str) -> Array:
        """One of its arrays of float64, which C may write."""
        return self._arrays[name]

    def integers(self, name: str) -> Indices:
        """One of its arrays of int64, which C may write, too."""
        return self._arrays[name].view(np.int64)

    def number(self, name: str) -> int:
        """One of its integers."""
        return int(getattr(self._fields, name))

    def write(self, name: str, value: Array) -> None:
        """Write an array's numbers into one of its own: nothing broadcasts.

        Parameters
        ----------
        name : str
        value : ndarray
            Of the shape of that one [in its unit].

        Raises
        ------
        ValueError
            If it has another one.
        """
        array = self._arrays[name]
        if array.shape != value.shape:
            raise ValueError(f"{name} has shape {value.shape} in place of {array.shape}")
        array[...] = value

    def zeros(self, shapes: Mapping[str, tuple[int, ...]], kind: type = np.float64) -> None:
        """Give some fields arrays of zeros, of 8 bytes a number, in one block of memory."""
        sizes = [math.prod(shape) for shape in shapes.values()]
        block: Array = np.zeros(sum(sizes), kind)
        address = address_of(block)
        for (name, shape), size in zip(shapes.items(), sizes, strict=True):
            self._arrays[name] = block[:size].reshape(shape)
            setattr(self._fields, name, address)
            block = block[size:]
            address += 8 * size

    def share(self, other: "Structure", names: Sequence[str]) -> None:
        """Have some arrays in common with another structure, in fields of the same names."""
        for name in names:
            self._arrays[name] = other[name]
            setattr(self._fields, name, getattr(other._fields, name))

    def put(self, values: Mapping[str, int | Array | Indices]) -> None:
        """Set some fields.

        Parameters
        ----------
        values : mapping of str to int or ndarray
            Arrays of float64 or int64, of any shape [any unit], copied if not contiguous.
        """
        for name, value in values.items():
            if isinstance(value, int):
                setattr(self._fields, name, value)
                continue
            array = np.ascontiguousarray(value)
            assert array.dtype in (np.float64, np.int64)
            self._arrays[name] = cast("Array", array)  # or of int64
            setattr(self._fields, name, address_of(array))


def address_of(array: NDArray[np.generic]) -> int:
    """Where a C-contiguous array begins in memory, of any shape [any unit]."""
    if array.flags.writeable and array.size:  # in a third of the time
        return ctypes.addressof(ctypes.c_char.from_buffer(array.data))
    return array.ctypes.data


@cache
def fields(file: str, name: str) -> type[ctypes.Structure]:
    """The fields that C declares: 64-bit integers, and pointers."""
    text = COMMENT.sub("", (SOURCE / file).read_text())
    declared = re.search(rf"typedef struct[^{{}}]*{{([^{{}}]*)}} {name};", text)
    assert declared is not None
    each = re.split("[;,]", declared.group(1).strip().rstrip(";"))
    kinds = [
        (re.findall(r"\w+", one)[-1], ctypes.c_void_p if "*" in one else ctypes.c_int64)
        for one in each
    ]
    return type(name, (ctypes.Structure,), {"_fields_": kinds})
