"""Eq. (11), lam_j >= 0. Under test: certify.residuals.optimality_residuals."""

import numpy as np
import pytest

from quasistatic_ref import solve_step, standard_form
from quasistatic_ref.certify.residuals import optimality_residuals
from tests.closeness import assert_within
from tests.helpers import planted_step, random_step
from tests.tolerances import MULTIPLIERS


@pytest.mark.parametrize("seed", range(2))
def test_the_residual_is_the_most_negative_multiplier(seed):
    rng = np.random.default_rng(seed)
    lam = rng.normal(size=16)
    expected = 0.0
    for entry in lam:
        expected = max(expected, -entry)
    actual = optimality_residuals(standard_form(random_step(rng)), np.zeros(7), lam).dual
    np.testing.assert_array_equal(actual, expected)


def test_the_multipliers_that_come_back_are_the_planted_positive_ones(rng):
    # One active row per contact: lam is unique, so it can be compared entry by entry.
    step, _, lam = planted_step(rng)
    actual = solve_step(step).lam
    assert lam.max() > 0
    assert_within(actual, lam, MULTIPLIERS * lam.max())
