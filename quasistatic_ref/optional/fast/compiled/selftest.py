"""Whether a compiled library is right: ``python -m ....selftest LIBRARY``, in a process of its own.

Four things are tried, and the first that is wrong is said on standard error, with exit status 1:

1. float64. A compiler may be told to change bits (``-ffast-math`` and its parts), by its command or
   by a wrapper. The library does each operation on numbers for which a change shows, and the bits
   must be those of Python, which must still be the same once the library is loaded.
2. Integers of fixed point, on which proofs stand. Products, sums, carries, quotients and roundings
   of numbers of all sizes must have the digits that Python's integers have.
3. Functions that are tried alone: which rows others combine, bounds from an inverse, sizes of
   forces, and closest points (``known_functions.py``, ``known_pairs.py``).
4. The prover. Steps whose exact optima are stored are proved on right and wrong guesses, and again
   after other data.
"""

import ctypes
import itertools
import math
import sys
from fractions import Fraction

from quasistatic_ref.optional.fast.compiled import library as compiled
from quasistatic_ref.optional.fast.compiled.cache import CompileError
from quasistatic_ref.optional.fast.compiled.known_functions import (
    wrong_bound,
    wrong_span,
)
from quasistatic_ref.optional.fast.compiled.known_pairs import wrong_points
from quasistatic_ref.optional.fast.compiled.known_steps import known_steps, stale, wrong

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

BITS = 56
DIGITS = 20
FRACTION = 16
GRID = 440
"""Of fixed_point.h and proof.h: bits of a digit, digits, those behind the point, and where cut."""
AGAIN = range(0, 60, 2)
"""Known steps that are proved again, after other data."""
ZERO = Fraction(0)
TERMS = 6
"""Products in a sum. Fewer than three, and no carry goes beyond a digit."""
STEP = 0.01
"""By which sums are divided."""
SIZES = (0, 0, 30, -60, 44, -200, 110, -840)
"""Powers of two of the factors of a sum."""
SUMS = 160
EXTREME = (
    (2.0**100, 2.0**100, 2.0**52),
    (2.0**100, 2.0**100, 2.0**23),
    (2.0**53, 2.0**80, 1.0, -(2.0**80), 1.0, 1.0, 2.0**50, 1.0, 1.0),
    (2.0**53, 2.0**80, 1.0, -(2.0**80), 1.0, 1.0, -(2.0**50), 1.0, 1.0),
)
"""Factors of sums: a product and a carry beyond the last digit, and numbers next to the middle of
two float64 numbers, by less than the first two digits show."""
MIDDLE = 2.0**-930
"""By which the even neighbour of a middle is multiplied, so that some are too small."""
NORMAL = 2.0**-900
LOST = 46
"""Of these sums, those with digits beyond the last or below the first."""


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


def factors() -> list[list[float]]:
    """Factors of sums of products, three of each product, of all sizes, signs and lengths.

    In every third sum the first two products cancel but for their last bits, in every fifth the
    third factors are powers of two, and in every seventh all bits of the factors are ones. Some
    sums lie in the middle of two float64 numbers, or next to it.
    """
    found = []
    for k in range(SUMS):
        size = SIZES[k % len(SIZES)]
        one = [
            math.ldexp(math.sqrt(2 + 18 * k + i) * (-1) ** (i * k % 3), size + (i * 7 + k) % 9 - 4)
            for i in range(3 * TERMS)
        ]
        if k % 3 == 0:
            one[3:6] = one[0], one[1], one[2] * (1 + 2.0**-52)
        if k % 5 == 0:
            one[2::3] = [math.ldexp(1.0, (k * i) % 50 - 25) for i in range(TERMS)]
        if k % 7 == 0:
            one = [math.ldexp(2.0**53 - 1, size - 53 + (k + i) % 4) for i in range(3 * TERMS)]
        if k % 4 == 3:
            one[6:] = [0.0] * len(one[6:])
        if k % 16 == 9:
            one[3:] = [0.0] * len(one[3:])
            one[:3] = math.ldexp(1.0, 11 * (k % 32) - 200), 1.0, 1.0
        if k % 16 in (1, 13):
            unit = math.ldexp(1.0, 7 * (k // 16) - 40)
            by = STEP if k % 32 == 1 else 1.0
            one = [2.0**53 + k // 32 * 2, unit, by, -unit, 1.0, by, *[0.0] * (3 * TERMS - 6)]
            if k % 16 == 13:
                one[6:9] = (-1) ** (k // 16) * 2.0**-20, unit, 1.0
        if k % 16 == 5:
            few = EXTREME[k // 16 % len(EXTREME)]
            one = [*few, *[0.0] * (3 * TERMS - len(few))]
        found.append(one)
    return found


def cut_numbers() -> list[float]:
    """Numbers of which some lie below the grid, at all distances from it and of all lengths."""
    return [
        math.ldexp(math.sqrt(k + 2) if k % 3 else 5.0, -GRID + k - 60) * (-1) ** k
        for k in range(SUMS)
    ]


def edges() -> list[float]:
    """What is no number, numbers at the ends of what fits, and numbers of all sizes between."""
    large = [math.ldexp(1.5, k) for k in range(155, 170)]
    small = [math.ldexp(one, -k) for one in (1.0, 1.0 + 2.0**-52) for k in range(840, 900, 2)]
    between = [math.ldexp(-math.sqrt(2), k) for k in range(-890, 164, 16)]
    return [*itertools.chain(*SPECIAL), *large, *small, *between][:SUMS]


def fits(x: float) -> bool:
    """Whether all bits of a number lie among the digits, and those of a factor below the last two.

    The last bit of a normal float64 of exponent e, as frexp has it, is 2^(e - 53).
    """
    if x == 0.0:
        return True
    if not math.isfinite(x) or abs(x) < sys.float_info.min:
        return False
    lowest = 2 ** (BITS * FRACTION)
    whole = (Fraction(x) * lowest).denominator == 1
    return whole and math.frexp(x)[1] - 53 + BITS * FRACTION < BITS * (DIGITS - 2)


def wrong_digits(library: ctypes.CDLL) -> str | None:
    """What fixed point makes of the sums and numbers that is wrong, in words."""
    every = factors()
    cut = cut_numbers()
    edge = edges()
    given = (ctypes.c_double * (SUMS * 3 * TERMS))(*itertools.chain(*every))
    numbers = (ctypes.c_double * SUMS)(*cut), (ctypes.c_double * SUMS)(*edge)
    digits = (ctypes.c_int64 * (SUMS * 3 * DIGITS))()
    found = (ctypes.c_double * (SUMS * 13))()
    sizes = ctypes.c_int64(SUMS), ctypes.c_int64(TERMS)
    library.fixed_point(given, *numbers, *sizes, ctypes.c_double(STEP), digits, found)
    lost = 0
    for k, one in enumerate(every):
        of_sum, of_cut, of_middle = (
            digits[DIGITS * j : DIGITS * (j + 1)] for j in range(3 * k, 3 * k + 3)
        )
        was_lost, near, *nearest = found[13 * k : 13 * k + 6]
        not_cut, beyond, worth_edge, *middles = found[13 * k + 6 : 13 * (k + 1)]
        kept = Fraction(math.trunc(Fraction(cut[k]) * 2**GRID), 2**GRID)
        if worth(of_cut) != kept or bool(not_cut) != (kept != Fraction(cut[k])):
            return f"{cut[k]}, cut, has the digits {of_cut}"
        if bool(beyond) == fits(edge[k]):
            return f"whether {edge[k]} fits is {not beyond}"
        if not beyond and abs(worth_edge - edge[k]) > abs(edge[k]) / 2**50:
            return f"the value of {edge[k]} is {worth_edge}"
        if was_lost:
            lost += 1
            continue
        x = sum(((-1) ** i * exact_product(one[3 * i : 3 * i + 3]) for i in range(TERMS)), ZERO)
        if worth(of_sum) != x or max(map(abs, of_sum)) > 2 ** (BITS - 1):
            return f"a sum of products has the digits {of_sum}"
        if abs(Fraction(near) - x) > abs(x) / 2**50:
            return f"the value of a sum is {near}"
        quotients = zip(nearest[::2], nearest[1::2], (x, x / Fraction(STEP)), strict=True)
        for shown, rounded, right in quotients:
            if shown != (not is_tie(right)) or (shown and rounded != float(right)):
                return f"a quotient is rounded to {rounded} in place of {float(right)}"
        quotients = zip(middles[::2], middles[1::2], (x, x / Fraction(STEP)), strict=True)
        for shown, even, right in quotients:
            small = float(right) * MIDDLE
            if shown != (is_tie(right) and abs(small) > NORMAL) or (shown and even != small):
                return f"the even neighbour of a middle is {even} in place of {small}"
        if middles[2] and worth(of_middle) != x:
            return f"a middle has the digits {of_middle}"
    return None if lost == LOST else f"{lost} sums do not fit in place of {LOST}"


def is_tie(x: Fraction) -> bool:
    """Whether a number lies in the middle of two float64 numbers."""
    near = float(x)
    return 2 * abs(x - Fraction(near)) == Fraction(math.ulp(near))


def worth(digits: list[int]) -> Fraction:
    """The number of which these are the digits."""
    return sum(
        (digit * Fraction(2) ** (BITS * (j - FRACTION)) for j, digit in enumerate(digits)), ZERO
    )


def exact_product(numbers: list[float]) -> Fraction:
    """The product of `numbers` [-], without rounding."""
    return math.prod(map(Fraction, numbers), start=Fraction(1))


def wrong_bits(library: ctypes.CDLL, right: list[str]) -> str | None:
    """The first operation of float64 that is wrong, in words."""
    names = [*NAMES * len(operands()), *SUMS_OF]
    for name, one, other in zip(names, by_library(library), right, strict=True):
        if one != other:
            return f"its arithmetic is not that of float64: {name} is {one} in place of {other}"
    return None if by_python() == right else "loading it changes the arithmetic of the process"


def wrong_proof() -> str | None:
    """The first proof of a stored step that is wrong, in words."""
    for k, known in enumerate(known_steps()):
        found = wrong(known) or (stale(known) if k in AGAIN else None)
        if found is not None:
            return f"its proofs are wrong: of known step {k}, {found}"
    return None


def refusal(file: str) -> str | None:
    """Why a library must not be used; None if it is right."""
    return wrong_parts(file) or wrong_proof()


def wrong_parts(file: str) -> str | None:
    """What is wrong with the numbers and functions of a library, in words."""
    right = by_python()
    compiled.chosen = file
    try:
        library = compiled.library()
    except CompileError as failure:
        return f"it cannot be loaded: {failure}"
    return (
        wrong_bits(library, right)
        or wrong_digits(library)
        or wrong_span(library)
        or wrong_bound(library)
        or wrong_points()
    )


if __name__ == "__main__":
    sys.exit(refusal(*sys.argv[1:]))
