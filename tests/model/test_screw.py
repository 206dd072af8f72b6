"""Screw motions of bases against SciPy's exponential of the twist's matrix."""

import numpy as np
import pytest
from scipy.linalg import expm
from scipy.spatial.transform import Rotation

from quasistatic_ref.model.joints.floating import Floating
from tests.closeness import assert_close, assert_within
from tests.tolerances import ROUNDING

ANGLES = (0.0, 1e-9, 0.3, 3.0)
LINEAR = (0.3, -0.7, 1.1)
AXIS = np.array([2.0, -3.0, 6.0]) / 7
START = Rotation.from_rotvec(0.8 * np.array([1.0, 2.0, -2.0]) / 3)
"""How a base is turned before it moves."""
FLOATING = Floating("base", False, slice(0, 7), slice(0, 6))


def screw(v, w):
    """The exponential of the 4 x 4 matrix of a twist: its rotation matrix and its translation."""
    x, y, z = w
    moved = expm([[0, -z, y, v[0]], [z, 0, -x, v[1]], [-y, x, 0, v[2]], [0, 0, 0, 0]])
    return moved[:3, :3], moved[:3, 3]


@pytest.mark.parametrize("angle", ANGLES)
def test_a_floating_base_moves_by_its_twist_in_its_own_frame(angle):
    # position' = position + R t, where t is the translation of the screw
    at = np.array([0.5, -0.25, 2.0])
    w = angle * AXIS
    q = [*at, *START.as_quat()]
    delta_q = [*LINEAR, *w]
    expected = at + START.apply(screw(LINEAR, w)[1])
    q_next = FLOATING.integrated(q, delta_q)
    assert_within(q_next[:3], expected, ROUNDING * 4)
    assert_within(FLOATING.change(q, q_next), delta_q, 8 * ROUNDING)


@pytest.mark.parametrize("axis", [AXIS, *np.eye(3)], ids=["oblique", "x", "y", "z"])
@pytest.mark.parametrize("angle", [*ANGLES, 1e-200, 6.0])
def test_a_floating_base_turns_by_its_rotation_vector(angle, axis):
    # The product of both matrices, which q and -q stand for; and a turn back is that by -w.
    w = angle * axis
    q = [0.0, 0.0, 0.0, *START.as_quat()]
    after = FLOATING.integrated(q, [0.0, 0.0, 0.0, *w])
    expected = START.as_matrix() @ screw(np.zeros(3), w)[0]
    found = Rotation.from_quat(after[3:]).as_matrix()
    assert_within(found, expected, 4 * ROUNDING)
    shorter = angle if angle < np.pi else angle - 2 * np.pi
    back = FLOATING.change(after, q)[3:]
    assert_close(back, -shorter * axis, 4 * ROUNDING)


@pytest.mark.parametrize("axis", [*np.eye(3), -AXIS])
def test_half_a_turn_is_about_the_axis_of_the_quaternion_that_names_it(axis):
    # From no turn: (e, 0) stands for a turn by pi about e, and -(e, 0) for the same about -e.
    found = FLOATING.change([0, 0, 0, 0, 0, 0, 1.0], [0, 0, 0, *axis, 0.0])
    assert_within(found[3:], np.pi * axis, 4 * ROUNDING)
