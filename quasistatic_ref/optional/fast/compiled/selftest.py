"""Whether a compiled library is right: ``python -m ....selftest LIBRARY``, in a process of its own.

Two things are tried, and the first that is wrong is said on standard error, with exit status 1:

1. float64. A compiler may be told to change bits (``-ffast-math`` and its parts), by its command or
   by a wrapper. The library does each operation on numbers for which a change shows, and the bits
   must be those of Python, which must still be the same once the library is loaded.
2. Closest points of pairs for which a formula tells them (``known_pairs.py``).
"""

import ctypes
import math
import sys

from quasistatic_ref.optional.fast.compiled import library as compiled
from quasistatic_ref.optional.fast.compiled.cache import CompileError
from quasistatic_ref.optional.fast.compiled.known_pairs import wrong_points

COUNT = 61
"""Of roots that are summed: no multiple of the length of a vector register."""
LEAST = 5e-324
SPECIAL = (
    (2.0**-1022, 0.5, 0.0), (LEAST, 1.0, 0.0), (LEAST, LEAST, LEAST), (-0.0, 1.0, 0.0),
    (0.0, 1.0, -0.0), (math.inf, 1.0, 0.0), (math.nan, 1.0, 0.0),
)  # fmt: skip
"""Of x, y and z: subnormal numbers, signs of zero, and no numbers."""
NAMES = (
    "x y + z", "x + y - x", "x / y", "x / 3", "0.1 x", "0 - x", "sqrt(y)", "x == x",
)  # fmt: skip
SUMS_OF = ("the sum of x", "the sum of x y")


def operands() -> list[tuple[float, float, float]]:
    """Numbers x, y and z without unit: roots, z being -x y rounded; then those of ``SPECIAL``."""
    signed = [(math.sqrt(i + 2) * (-1 if i % 3 else 1), math.sqrt(3 * i + 7)) for i in range(COUNT)]
    return [*((x, y, -x * y) for x, y in signed), *SPECIAL]


def by_python() -> list[str]:
    """The results in words, which are different for any two float64 numbers."""
    of = operands()
    by = of[0][1]
    total = 0.0
    products = 0.0
    each = list[float]()
    for x, y, z in of:
        each += [x * y + z, x + y - x, x / by, x / 3.0]
        each += [x * 0.1, 0.0 - x, math.sqrt(y), float(x == x)]
    for x, y, _ in of[:COUNT]:
        total += x
        products += x * y
    return [repr(value) for value in [*each, total, products]]


def by_library(library: ctypes.CDLL) -> list[str]:
    """The results of the library, in the same words."""
    of = operands()
    given = (ctypes.c_double * (3 * len(of)))(*(value for triple in of for value in triple))
    found = (ctypes.c_double * (len(NAMES) * len(of) + len(SUMS_OF)))()
    library.arithmetic(given, ctypes.c_int64(len(of)), ctypes.c_int64(COUNT), found)
    return [repr(value) for value in found]


def wrong_bits(library: ctypes.CDLL, right: list[str]) -> str | None:
    """The first operation of float64 that is wrong, in words."""
    names = [*NAMES * len(operands()), *SUMS_OF]
    for name, one, other in zip(names, by_library(library), right, strict=True):
        if one != other:
            return f"its arithmetic is not that of float64: {name} is {one} in place of {other}"
    return None if by_python() == right else "loading it changes the arithmetic of the process"


def refusal(file: str) -> str | None:
    """Why a library must not be used; None if it is right."""
    right = by_python()
    compiled.chosen = file
    try:
        library = compiled.library()
    except CompileError as failure:
        return f"it cannot be loaded: {failure}"
    return wrong_bits(library, right) or wrong_points()


if __name__ == "__main__":
    sys.exit(refusal(*sys.argv[1:]))
