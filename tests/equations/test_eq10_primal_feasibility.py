"""Eq. (10), A_j delta_q >= b_j. Under test: certify.residuals.optimality_residuals."""

import numpy as np
import pytest

from quasistatic_ref import standard_form
from quasistatic_ref.certify.residuals import optimality_residuals
from tests.closeness import assert_relative
from tests.helpers import random_step, slacks
from tests.tolerances import ROUNDING


@pytest.mark.parametrize("seed", range(2))
def test_the_residual_is_the_deepest_violation(seed):
    rng = np.random.default_rng(seed)
    step = random_step(rng)
    delta_q = rng.normal(size=7)
    expected = max(0.0, *-slacks(step, delta_q))
    actual = optimality_residuals(standard_form(step), delta_q, np.zeros(16)).primal
    assert expected > 0
    assert_relative(actual, expected, ROUNDING)
