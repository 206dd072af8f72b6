"""Screw motions of a floating base against SciPy's exponential of the twist's matrix."""

import numpy as np
import pytest
from scipy.linalg import expm
from scipy.spatial.transform import Rotation

from quasistatic_ref import Body, Sphere, System
from tests.closeness import assert_close, assert_within
from tests.tolerances import ROUNDING

LINEAR = (0.3, -0.7, 1.1)
AXIS = np.array([2.0, -3.0, 6.0]) / 7
START = Rotation.from_rotvec(0.8 * np.array([1.0, 2.0, -2.0]) / 3)
"""How a base is turned before it moves."""
BALL = System([Body.of_shape("ball", Sphere(0.1), 1.0)])


@pytest.mark.parametrize("axis", [AXIS, *np.eye(3)], ids=["oblique", "x", "y", "z"])
@pytest.mark.parametrize("angle", [0.0, 1e-200, 1e-9, 0.3, 3.0, 6.0])
def test_a_floating_base_moves_by_the_screw_of_its_twist_in_its_own_frame(angle, axis):
    # Its pose is then the product of both, whose rotation q and -q stand for. The change back from
    # there is that of less than half a turn.
    at = np.array([0.5, -0.25, 2.0])
    x, y, z = w = angle * axis
    v_x, v_y, v_z = LINEAR
    screw = expm([[0, -z, y, v_x], [z, 0, -x, v_y], [-y, x, 0, v_z], [0, 0, 0, 0]])
    q = [*at, *START.as_quat()]
    after = BALL.integrate(q, [*LINEAR, *w])
    assert_within(after[:3], at + START.apply(screw[:3, 3]), 4 * ROUNDING)
    turned = Rotation.from_quat(after[3:]).as_matrix()
    assert_within(turned, START.as_matrix() @ screw[:3, :3], 4 * ROUNDING)
    shorter = angle if angle < np.pi else angle - 2 * np.pi
    way = BALL.difference(q, after)
    assert_close(way[3:], shorter * axis, 4 * ROUNDING)
    if shorter == angle:
        assert_within(way[:3], LINEAR, 8 * ROUNDING)


@pytest.mark.parametrize("axis", [*np.eye(3), -AXIS])
def test_half_a_turn_is_about_the_axis_of_the_quaternion_that_names_it(axis):
    # From no turn: (e, 0) stands for a turn by pi about e, and -(e, 0) for the same about -e.
    found = BALL.difference([0, 0, 0, 0, 0, 0, 1.0], [0, 0, 0, *axis, 0.0])
    assert_within(found[3:], np.pi * axis, 4 * ROUNDING)
