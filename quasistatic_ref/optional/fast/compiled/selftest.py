"""Whether a compiled library keeps to float64: ``python selftest.py LIBRARY``.

A compiler may be told to change bits (``-ffast-math`` and its parts), by its command or by a
wrapper. So the library does each operation on numbers for which a change shows, and the bits must
be those of Python; and Python's must still be the same once the library is loaded. If they are not:
exit status 1, and why on standard error. Nothing of the package is imported: this runs in a process
of its own.
"""

import ctypes
import math
import sys

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
SUMS = ("the sum of x", "the sum of x y")


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
    found = (ctypes.c_double * (len(NAMES) * len(of) + len(SUMS)))()
    library.arithmetic(given, ctypes.c_int64(len(of)), ctypes.c_int64(COUNT), found)
    return [repr(value) for value in found]


def refusal(file: str) -> str | None:
    """Why a library must not be used; None if its bits are right."""
    right = by_python()
    try:
        found = by_library(ctypes.CDLL(file))
    except (OSError, AttributeError) as failure:
        return f"it cannot be loaded: {failure}"
    names = [*NAMES * len(operands()), *SUMS]
    for name, one, other in zip(names, found, right, strict=True):
        if one != other:
            return f"its arithmetic is not that of float64: {name} is {one} in place of {other}"
    return None if by_python() == right else "loading it changes the arithmetic of the process"


if __name__ == "__main__":
    sys.exit(refusal(*sys.argv[1:]))
