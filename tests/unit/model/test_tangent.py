"""The series of (+) and the rates of the entries of q, against closed forms."""

import numpy as np
import pytest

from quasistatic_ref.model.coordinates import Joint
from quasistatic_ref.model.tangent import entry_rates, half_turns, right_jacobian
from tests.tolerances import FOUR_ULP, ROUNDING

FREE = Joint("free", "floating", False, slice(0, 7), slice(0, 6))
FLAT = Joint("flat", "planar", False, slice(0, 4), slice(0, 3))


@pytest.mark.parametrize("angle", [1e-3, 1.1, 3.0])
def test_the_series_of_a_turn_is_summed_to_its_last_digits(angle):
    # About z: J_xx = J_yy = sin(a) / a, J_xy = -J_yx = (1 - cos(a)) / a = 2 sin(a / 2)^2 / a.
    along, across = np.sin(angle) / angle, 2 * np.sin(angle / 2) ** 2 / angle
    turn = np.array([[along, across, 0], [-across, along, 0], [0, 0, 1]])
    found = right_jacobian(np.array([0, 0, 0, 0, 0, angle]))
    expected = np.kron(np.eye(2), turn)
    np.testing.assert_allclose(found, expected, rtol=0, atol=FOUR_ULP)


@pytest.mark.parametrize("length", [0.5, 1.0, 3.0])
def test_a_base_moves_along_its_own_axes_whatever_the_length_of_its_turn(length):
    # Position entries move by R(q) e, and R does not depend on the length of what it is made of.
    angle = 0.7
    R = np.array([
        [np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1]
    ])  # fmt: skip
    turn = length * np.array([0, 0, np.sin(angle / 2), np.cos(angle / 2)])
    E = entry_rates([FREE], np.concatenate([[0.1, 0.2, 0.3], turn]))
    np.testing.assert_allclose(E[:3, :3], R, atol=ROUNDING)
    turn = length * np.array([np.cos(angle), np.sin(angle)])
    E = entry_rates([FLAT], np.concatenate([[0.1, 0.2], turn]))
    np.testing.assert_allclose(E[:2, :2], R[:2, :2], atol=ROUNDING)


@pytest.mark.parametrize("axis", np.eye(3))
def test_half_a_turn_about_any_axis_is_one_but_no_shift_is(axis):
    assert half_turns([FREE], np.pi * np.concatenate([np.zeros(3), axis]), 0.0) == ["free"]
    assert half_turns([FREE], np.pi * np.concatenate([axis, np.zeros(3)]), 1e-9) == []
