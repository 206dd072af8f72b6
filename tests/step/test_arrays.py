"""Arrays of a step: what is said of all their numbers at once."""

from fractions import Fraction

import numpy as np
import pytest

from quasistatic_ref import StepDataError
from quasistatic_ref.step.arrays import checked_numbers


def test_numbers_are_float64_and_no_copy_where_they_are_already():
    given = np.array([1.0, 2.0])
    assert checked_numbers(given, "x") is given
    for value in (np.array([1, 2]), np.array([1, 2], dtype=np.float32), [1, 2]):
        assert checked_numbers(value, "x").dtype == np.float64
        assert checked_numbers(value, "x").tolist() == [1.0, 2.0]


def test_an_empty_array_of_objects_holds_no_number_that_is_none():
    assert checked_numbers(np.array([], dtype=object), "x").dtype == np.float64
    with pytest.raises(StepDataError, match="must be numbers"):
        checked_numbers([Fraction(1, 2)], "x")


@pytest.mark.parametrize("value", [True, [True], [0.5, True], [[1.0, 0.0], [0.0, False]]])
def test_true_is_no_number(value):
    with pytest.raises(StepDataError, match="x: must be numbers"):
        checked_numbers(value, "x")
