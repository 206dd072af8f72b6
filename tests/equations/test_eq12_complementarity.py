"""Eq. (12), slack o lam_j = 0. Under test: certify.residuals.optimality_residuals."""

import numpy as np
import pytest

from quasistatic_ref import standard_form
from quasistatic_ref.certify.residuals import optimality_residuals
from tests.closeness import assert_relative, assert_within
from tests.helpers import planted_step, random_step, slacks
from tests.tolerances import ROUNDING


@pytest.mark.parametrize("seed", range(2))
def test_the_residual_is_the_largest_product(seed):
    rng = np.random.default_rng(seed)
    step = random_step(rng)
    delta_q = rng.normal(size=7)
    lam = rng.normal(size=16)
    expected = np.abs(slacks(step, delta_q) * lam).max()
    actual = optimality_residuals(standard_form(step), delta_q, lam).complementarity
    assert_relative(actual, expected, ROUNDING)


def test_erratum_lam_without_its_index_does_not_fit_a_contact_of_several(rng):
    step, delta_q, lam = planted_step(rng, rows=(6, 4, 6))
    slack_of_the_second = slacks(step, delta_q)[6:10]
    assert len(slack_of_the_second) != len(lam)  # so (12) cannot mean the whole of lambda
    assert step.offsets.tolist() == [0, 6, 10, 16]
    own = lam[6:10]
    assert_within(np.multiply(slack_of_the_second, own), 0.0, ROUNDING)
    another = lam[0:4] + lam[10:14]  # another contact's multipliers do not complement this slack
    assert np.abs(slack_of_the_second).max() > 0
    assert np.flatnonzero(own).tolist() != np.flatnonzero(another).tolist()
