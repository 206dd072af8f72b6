"""Eq. (10), A_j delta_q >= b_j. Under test: certify.residuals.optimality_residuals."""

import numpy as np

from quasistatic_ref import standard_form
from quasistatic_ref.certify.residuals import optimality_residuals
from tests.closeness import assert_relative
from tests.helpers import random_step, slacks
from tests.tolerances import ROUNDING


def test_the_residual_is_the_deepest_violation(rng):
    step = random_step(rng)
    delta_q = rng.normal(size=7)
    deepest = -slacks(step, delta_q).min()
    assert deepest > 0
    residuals = optimality_residuals(standard_form(step), delta_q, np.zeros(16))
    assert_relative(residuals.primal, deepest, ROUNDING)
