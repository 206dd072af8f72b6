"""Newton's method of the smoothed step: in any unit, and up to its last digit."""

import numpy as np
import pytest

from quasistatic_ref.solve.barrier import _newton, _share

H = np.array([[2.0, 0.3], [0.3, 1.0]])
G = np.array([-1.0, 0.5])
ROWS = np.array([[1.0, 0.2], [-0.1, 1.0], [0.5, -1.0]])
B = np.array([-0.1, 0.05, -0.2])
KAPPA = 1e-3
FACING = np.array([[1.0, 0.0], [-1.0, 0.0]])


@pytest.mark.parametrize("power", [-30, -10, 10, 30])
def test_the_minimiser_has_the_same_digits_in_any_unit_of_length(power):
    # With x, b and g by c and kappa by c^2 the objective is c^2 times as large: x and slack are
    # c times, lam is c times as large. Powers of two round nothing.
    c = 2.0**power
    one, other = _newton(H, G, ROWS, B, KAPPA), _newton(H, c * G, ROWS, c * B, c * c * KAPPA)
    for own, scaled in zip(one, other, strict=True):
        assert np.array_equal(c * own, scaled)


@pytest.mark.parametrize("power", [-30, 0, 30])
def test_rows_that_face_each_other_are_refused_in_any_unit_of_length(power):
    # x >= c and -x >= c.
    c = 2.0**power
    with np.errstate(all="ignore"):
        assert _newton(H, c * G, FACING, c * np.ones(2), c * c * KAPPA) is None


def test_only_what_falls_shortens_a_step():
    # 0.99 of the way to zero: 2 falls to it in half a step, 1 does not fall.
    assert _share(np.array([1.0, 2.0]), np.array([0.0, -4.0])) == 0.99 / 2
    assert _share(np.array([1.0, 2.0]), np.array([0.0, 1.0])) == 1.0
