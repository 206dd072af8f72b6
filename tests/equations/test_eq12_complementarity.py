"""Eq. (12), slack o lam_j = 0. Under test: certify.residuals.optimality_residuals."""

import numpy as np

from tests.closeness import assert_relative
from tests.helpers import random_step, residuals_of, slacks


def test_the_residual_is_the_largest_product(rng):
    step = random_step(rng)
    delta_q, lam = rng.normal(size=7), rng.normal(size=16)
    expected = np.abs(slacks(step, delta_q) * lam).max()
    actual = residuals_of(step, delta_q, lam).complementarity
    assert_relative(actual, expected)
