"""Eq. (10), A_j delta_q >= b_j. Under test: certify.residuals.optimality_residuals."""

import numpy as np

from tests.closeness import assert_relative
from tests.helpers import random_step, residuals_of, slacks


def test_the_residual_is_the_deepest_violation(rng):
    step = random_step(rng)
    delta_q = rng.normal(size=7)
    deepest = -slacks(step, delta_q).min()
    assert deepest > 0
    assert_relative(residuals_of(step, delta_q, np.zeros(16)).primal, deepest)
