"""Sums of products in fixed point are exact, or known not to fit."""

import ctypes
from fractions import Fraction

import numpy as np

from tests.optional.fast.compiled.changed_c import changed_sources, library_of
from tests.optional.fast.compiled.test_fast import needs_compiler

pytestmark = needs_compiler
SUMS = 600
EXPOSED = """
#include "fixed_point.h"
_Thread_local int lost;
int added(const double *factors, int n, int64_t *digits, double *near)
{
    Sum sum = EMPTY;
    Number found;
    lost = 0;
    for (int again = 0; again < 2; again++) { /* in a sum that is empty once more */
        for (int i = 0; i < n; i++) {
            Number x = number(exact(factors[3 * i]));
            product(&x, exact(factors[3 * i + 1]), &x);
            add_product(&sum, &x, exact(factors[3 * i + 2]), i % 2 ? -1 : 1);
        }
        carried(&sum, &found);
    }
    for (int j = 0; j < DIGITS; j++)
        digits[j] = j >= found.low && j < found.high ? found.d[j] : 0;
    *near = value(&found);
    return lost;
}
"""


def library(folder):
    changed_sources(folder, "fixed_point.h", "", "")
    (folder / "exposed.c").write_text(EXPOSED)
    found = library_of(folder, "exposed.c")
    found.added.argtypes = [ctypes.c_void_p, ctypes.c_int, ctypes.c_void_p, ctypes.c_void_p]
    return found


def cases():
    """Factors of up to twelve products, and whether these surely fit.

    Some factors and products come near the least and the largest that fit, where a sum may be given
    up though it fits.
    """
    sizes = [(0, 0, 0), (74, 74, 74), (-245, -245, -245), (-843, 70, 70)]
    rng = np.random.default_rng(12)
    for k in range(SUMS):
        n = int(rng.integers(1, 13))
        size = np.array(sizes[k % 4])
        width = 8 if size.any() else 40
        factors = rng.normal(size=(n, 3)) * 2.0 ** (size + rng.integers(-width, width, (n, 3)))
        factors[rng.random((n, 3)) < 0.1] = 2.0 ** int(rng.integers(-40, 40))
        factors[rng.random((n, 3)) < 0.1] = 0.0
        if k % 3 == 0 and n > 1:  # products that cancel, all but their last bits
            factors[1] = factors[0] * [1.0, 1.0, 1 + 2.0**-52]
        yield factors, not size.any()


def test_a_sum_of_products_is_exact_or_does_not_fit(tmp_path):
    added = library(tmp_path).added
    counts = [0, 0]
    for factors, fits in cases():
        digits = np.zeros(20, np.int64)
        near = ctypes.c_double()
        lost = added(factors.ctypes.data, len(factors), digits.ctypes.data, ctypes.byref(near))
        assert not (lost and fits)
        counts[lost] += 1
        if lost:
            continue
        x = sum(
            (-1) ** i * Fraction(a) * Fraction(b) * Fraction(c)
            for i, (a, b, c) in enumerate(factors.tolist())
        )
        found = sum(d * Fraction(2) ** (56 * (j - 16)) for j, d in enumerate(digits.tolist()))
        assert found == x
        assert (np.abs(digits) <= 2**55).all()
        assert abs(Fraction(near.value) - x) <= abs(x) / 2**50
    assert min(counts) > SUMS // 10
