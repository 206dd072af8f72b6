"""The one definition of error, on a step whose H is a multiple of the identity."""

import math

import numpy as np
import pytest

from quasistatic_ref.certify.digits import digits_of_error
from quasistatic_ref.certify.exact import exact_step
from quasistatic_ref.certify.norm import energy_norm
from quasistatic_ref.lab.digits import correct_digits
from quasistatic_ref.step.data import Extra
from tests.certify.test_farkas import EAST, point_between_walls
from tests.tolerances import ROUNDING

HALF_DIGIT = 0.5
"""Rounding in the norms moves a digit count by far less."""


@pytest.mark.parametrize(
    ("error", "digits"),
    [(0.0, 16.0), (1e-20, 16.0), (1e-7, 7.0), (1.0, 0.0), (5.0, 0.0), (math.nan, 0.0)],
)
def test_digits_are_clipped(error, digits):
    assert digits_of_error(error) == pytest.approx(digits, abs=1e-12)


@pytest.mark.parametrize("k", [2, 6, 11])
def test_relative_error_of_ten_to_minus_k_is_k_digits(k):
    step = point_between_walls([EAST], [1.0], force=(0.0, 3.0, 4.0))
    exact = exact_step(step)
    free = np.linalg.norm(exact.delta_q)
    off = exact.delta_q + free * 10.0**-k * np.array([0.0, 0.6, 0.8])
    found = correct_digits(step, off, exact.delta_q)
    assert found.delta_q == pytest.approx(k, abs=HALF_DIGIT)
    assert found.net_impulse is None
    assert found.slack == 16.0  # the wall looks east, the error does not


@pytest.mark.parametrize("scale", [1e-3, 1.0, 1e4])
def test_slack_is_measured_as_a_displacement_for_rows_of_any_length(scale):
    """A row scale * y >= -1 and an error of 1e-7 along y: seven digits."""
    step = point_between_walls([EAST], [1.0], force=(0.0, 3.0, 4.0))
    step = step.replace(extra=Extra(("y",), scale * np.eye(3)[1:2], np.array([-1.0])))
    exact = exact_step(step).delta_q
    off = exact + np.linalg.norm(exact) * 1e-7 * np.eye(3)[1]
    assert correct_digits(step, off, exact).slack == pytest.approx(7, abs=1e-6)


def test_without_forces_only_the_exact_answer_has_digits():
    step = point_between_walls([EAST], [1.0])
    zero, nearly = np.zeros(3), np.array([1e-300, 0, 0])
    assert correct_digits(step, zero, zero).delta_q == 16.0
    assert correct_digits(step, nearly, zero).delta_q == 0.0


@pytest.mark.parametrize("scale", [1e-200, 1.0, 1e200])
def test_norms_neither_underflow_nor_overflow(scale):
    """H = 4: ||H^-1 p||_H = ||p|| / 2, and 3, 4, 5 is a right triangle."""
    norm, p = energy_norm(4 * np.eye(2)), scale * np.array([3.0, 4.0])
    assert norm.impulses(p[None]) == pytest.approx([2.5 * scale], rel=ROUNDING)
    assert norm.impulse(p) == pytest.approx(2.5 * scale, rel=ROUNDING)
    assert norm.displacement(p) == pytest.approx(10 * scale, rel=ROUNDING)
