"""Arrays of a step: what is said of all their numbers at once."""

import pytest

from quasistatic_ref import StepDataError
from quasistatic_ref.step.arrays import checked_numbers


@pytest.mark.parametrize("value", [True, [True], [0.5, True], [[1.0, 0.0], [0.0, False]]])
def test_true_is_no_number(value):
    with pytest.raises(StepDataError, match="x: must be numbers"):
        checked_numbers(value, "x")
