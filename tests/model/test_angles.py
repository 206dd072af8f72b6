"""Sines, cosines and angles against 60 digits: correctly rounded."""

import math

import mpmath
import numpy as np
import pytest

from quasistatic_ref.model.angles import angle_of, cos_sin

HARD = (0.0, 5e-324, 1e-310, 1e-8, math.pi / 2, math.pi, 1e22, 1e300, 1.7976931348623157e308)
"""Zero and subnormal numbers, cosines that cancel, and turns of 1,000 bits."""


def nearest(x):
    """The float64 nearest to a number of mpmath."""
    return float(mpmath.mpf(x))


def test_cosine_and_sine_are_the_nearest_float64():
    angles = [*HARD, *np.random.default_rng(1).normal(scale=10, size=300).tolist()]
    with mpmath.workdps(700):
        expected = [(nearest(mpmath.cos(a)), nearest(mpmath.sin(a))) for a in angles]
    assert [cos_sin(a) for a in angles] == expected
    assert [cos_sin(-a) for a in angles] == [(c, -s) for c, s in expected]


def test_the_angle_of_a_vector_is_the_nearest_float64():
    vectors = np.random.default_rng(2).normal(size=(300, 2)).tolist()
    vectors += [(0.0, -1.0), (0.0, 1.0), (1.0, 0.0), (5e-324, 1.0), (1e-200, -1e-200), (0.0, 0.0)]
    with mpmath.workdps(60):
        expected = [nearest(mpmath.atan2(*v)) for v in vectors]
    assert [angle_of(*v) for v in vectors] == expected


@pytest.mark.parametrize("angle", [math.inf, math.nan])
def test_no_angle_has_no_sine(angle):
    assert all(map(math.isnan, cos_sin(angle)))


def test_a_vector_that_is_no_number_has_no_angle():
    assert math.isnan(angle_of(math.nan, 1.0))
