"""Eq. (12), slack o lam_j = 0. Under test: certify.residuals.optimality_residuals."""

import numpy as np

from quasistatic_ref import standard_form
from quasistatic_ref.certify.residuals import optimality_residuals
from tests.closeness import assert_relative
from tests.helpers import random_step, slacks
from tests.tolerances import ROUNDING


def test_the_residual_is_the_largest_product(rng):
    step = random_step(rng)
    delta_q, lam = rng.normal(size=7), rng.normal(size=16)
    expected = np.abs(slacks(step, delta_q) * lam).max()
    actual = optimality_residuals(standard_form(step), delta_q, lam).complementarity
    assert_relative(actual, expected, ROUNDING)
