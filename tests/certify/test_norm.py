"""The one definition of error, on a step whose H is a multiple of the identity."""

import math

import numpy as np
import pytest

from quasistatic_ref.certify.exact import step_optimum
from quasistatic_ref.certify.norm import digits_of_error, energy_norm
from quasistatic_ref.lab.digits import correct_digits
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
    exact = step_optimum(step)
    free = np.linalg.norm(exact.delta_q)
    off = exact.delta_q + free * 10.0**-k * np.array([0.0, 0.6, 0.8])
    assert correct_digits(step, off, exact.delta_q) == pytest.approx(k, abs=HALF_DIGIT)


def test_without_forces_only_the_exact_answer_has_digits():
    step = point_between_walls([EAST], [1.0])
    zero = np.zeros(3)
    nearly = np.array([1e-300, 0, 0])
    assert correct_digits(step, zero, zero) == 16.0
    assert correct_digits(step, nearly, zero) == 0.0


@pytest.mark.parametrize("scale", [1e-200, 1.0, 1e200])
def test_norms_neither_underflow_nor_overflow(scale):
    """H = 4: ||H^-1 p||_H = ||p|| / 2, and 3, 4, 5 is a right triangle."""
    norm = energy_norm(4 * np.eye(2))
    p = scale * np.array([3.0, 4.0])
    assert norm.of_impulses(p[None]) == pytest.approx([2.5 * scale], rel=ROUNDING)
    assert norm.of_impulse(p) == pytest.approx(2.5 * scale, rel=ROUNDING)
    assert norm.of_displacement(p) == pytest.approx(10 * scale, rel=ROUNDING)
