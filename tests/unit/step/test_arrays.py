"""Arrays of a step: what is said of all their numbers at once."""

import math

import numpy as np
import pytest

from quasistatic_ref.step.arrays import largest


@pytest.mark.parametrize(
    ("numbers", "expected"),
    [([], 0.0), ([-2.0, -1.0], 0.0), ([-0.0], 0.0), ([1.0, 5.0, 2.0], 5.0), ([math.inf], math.inf)],
)
def test_the_largest_number_is_never_below_zero(numbers, expected):
    found = largest(np.array(numbers))
    assert found == expected
    assert math.copysign(1.0, found) == 1.0


def test_a_number_that_is_none_is_the_largest():
    assert math.isnan(largest(np.array([1.0, math.nan, math.inf])))
