"""Which float64 is nearest to a number of fixed point, by its first two digits alone."""

import ctypes
from fractions import Fraction

import numpy as np
import pytest

from tests.optional.fast.compiled.changed_c import changed_sources, library_of
from tests.optional.fast.compiled.test_fast import needs_compiler

pytestmark = needs_compiler
CASES = 4000
EXPOSED = """
#include "rounding.c"
_Thread_local int lost;
int shown(int64_t first, int64_t second, int64_t third, int place, double e, double *c)
{
    Number x = {third ? place - 2 : second ? place - 1 : place, place + 1, {0}};
    for (int j = 0; j < DIGITS; j++)
        x.d[j] = 0x5555555555555; /* nothing may depend on what is not set */
    x.d[place] = first;
    if (x.low < place)
        x.d[place - 1] = second;
    if (x.low < place - 1)
        x.d[place - 2] = third;
    return nearest_of_two(&x, e, c);
}
int shown_quotient(const double *factors, int n, double h, double *c)
{
    Sum sum = EMPTY;
    Number x, one;
    for (int i = 0; i < n; i++) {
        one = number(exact(factors[2 * i]));
        add_product(&sum, &one, exact(factors[2 * i + 1]), 1);
    }
    carried(&sum, &x);
    return nearest_quotient(&x, 0.0, h, c);
}
"""


def library(folder, text="", other=""):
    """The function by itself, with one text of rounding.c replaced; it calls no other file."""
    changed_sources(folder, "rounding.c", text, other)
    (folder / "exposed.c").write_text(EXPOSED)
    found = library_of(folder, "exposed.c", "-O0")
    found.shown.argtypes = [*[ctypes.c_int64] * 3, ctypes.c_int, ctypes.c_double, ctypes.c_void_p]
    found.shown_quotient.argtypes = [
        ctypes.c_void_p,
        ctypes.c_int,
        ctypes.c_double,
        ctypes.c_void_p,
    ]
    return found


def cases():
    """Digits, place and error, many of them near a number half-way between two float64 ones."""
    rng = np.random.default_rng(6)
    for k in range(CASES):
        place = int(rng.integers(6, 14))
        first = int(rng.integers(1, 2 ** int(rng.integers(1, 56)))) * int(rng.choice([-1, 1]))
        gap = 2 ** max((abs(first) << 56).bit_length() - 53, 1)  # of two neighbours, in seconds
        second = int(rng.integers(-(2**55), 2**55 + 1))
        if k % 2:
            near = (first * 2**56 + second) // gap * gap + gap // 2 + int(rng.integers(-2, 3))
            if abs(near - first * 2**56) <= 2**55:
                second = near - first * 2**56
        third = int(rng.choice([0, -(2**55), 2**55, int(rng.integers(-(2**55), 2**55))]))
        second *= bool(rng.integers(8)) or third != 0
        unit = Fraction(2) ** (56 * (place - 1 - 16))  # of the second digit
        yield first, second, third, place, unit, float(unit) * rng.choice([0.0, 0.3, 0.9, 1.7, gap])


def holds(made):
    """Whether each number that is said to be nearest is, at both ends; and how many are."""
    count = 0
    c = ctypes.c_double()
    for first, second, third, place, unit, e in cases():
        if not made.shown(first, second, third, place, e, ctypes.byref(c)):
            continue
        x = (first * 2**56 + second + Fraction(third, 2**56)) * unit
        if any(float(end) != c.value for end in (x - Fraction(e), x + Fraction(e))):
            return False, count
        count += 1
    return True, count


def test_a_number_that_is_said_to_be_nearest_is(tmp_path):
    right, count = holds(library(tmp_path))
    assert right
    assert count > CASES // 4


def quotients():
    """Factors of the products that add up to a number, and its divisor: x / h is near a tie."""
    rng = np.random.default_rng(7)
    for k in range(CASES):
        h = float(rng.uniform(0.5, 1.0)) * 2.0 ** int(rng.integers(-8, 9))
        c = 2.0 ** int(rng.integers(-9, 9)) * (float(rng.uniform(1.0, 2.0)) if k % 2 else 1.0)
        gap = (np.nextafter(c, np.inf if k % 4 < 2 else 0.0) - c) / 2
        off = h * gap * 2.0 ** -int(rng.integers(1, 70)) * int(rng.choice([-1, 1]))
        yield [(h, c), (h, gap), (1.0, off)], h
    h = float.fromhex("0x1.ffffffffffff9p+45")  # candidates are 8 and its neighbour, by turns
    yield [(h, -8.0), (h, 2.0**-51), (1.0, float.fromhex("0x1.ffffffffffffep-60"))], h


def test_a_quotient_that_is_said_to_be_nearest_is(tmp_path):
    made = library(tmp_path)
    count = 0
    c = ctypes.c_double()
    for factors, h in quotients():
        given = np.array(factors)
        if not made.shown_quotient(given.ctypes.data, len(given), h, ctypes.byref(c)):
            continue
        count += 1
        x = sum(Fraction(a) * Fraction(b) for a, b in factors)
        assert c.value == float(x / Fraction(h))
    assert count > CASES // 4


MUTANTS = {
    "the digits that follow": ("rest * unit, e + unit, 1.0)", "rest * unit, e, 1.0)"),
    "the error": ("rest * unit, e + unit, 1.0)", "rest * unit, unit, 1.0)"),
    "the rest": ("rest * unit, e + unit, 1.0)", "0.0, e + unit, 1.0)"),
    "the side of the rest": ("rest > 0.0 ? rest * UP", "rest < 0.0 ? rest * UP"),
    "what is not set": ("last < x->low ? 0 : x->d[last]", "x->d[last]"),
    "half of the gap": ("h * below / 2 * DOWN", "h * below * DOWN"),
}


@pytest.mark.parametrize("name", MUTANTS)
def test_each_part_of_the_proof_is_needed(tmp_path, name):
    assert not holds(library(tmp_path, *MUTANTS[name]))[0]
