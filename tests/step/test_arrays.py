"""Arrays of a step: what is said of all their numbers at once."""

import math
from fractions import Fraction

import numpy as np
import pytest

from quasistatic_ref.errors import StepDataError
from quasistatic_ref.step.arrays import largest, numbers


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


def test_numbers_are_float64_and_no_copy_where_they_are_already():
    given = np.array([1.0, 2.0])
    assert numbers(given, "x") is given
    for value in (np.array([1, 2]), np.array([1, 2], dtype=np.float32), [1, 2]):
        assert numbers(value, "x").dtype == np.float64
        assert numbers(value, "x").tolist() == [1.0, 2.0]


def test_an_empty_array_of_objects_holds_no_number_that_is_none():
    assert numbers(np.array([], dtype=object), "x").dtype == np.float64
    with pytest.raises(StepDataError, match="must be numbers"):
        numbers([Fraction(1, 2)], "x")
