"""Eq. (11), lam_j >= 0. Under test: certify.residuals.optimality_residuals."""

import numpy as np

from quasistatic_ref import solve_step
from tests.closeness import assert_within
from tests.helpers import planted_step, random_step, residuals_of
from tests.tolerances import MULTIPLIERS


def test_the_residual_is_the_most_negative_multiplier(rng):
    step = random_step(rng)
    lam = rng.normal(size=16)
    assert residuals_of(step, np.zeros(7), lam).dual == -lam.min() > 0


def test_the_multipliers_that_come_back_are_the_planted_positive_ones(rng):
    # One active row per contact: lam is unique, so it can be compared entry by entry.
    step, _, lam = planted_step(rng)
    assert lam.max() > 0
    assert_within(solve_step(step).lam, lam, MULTIPLIERS * lam.max())
