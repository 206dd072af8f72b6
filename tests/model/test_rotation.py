"""Rotations: matrices, quaternions and angles against those of SciPy."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from quasistatic_ref.model.rotation import quaternion, rotation
from quasistatic_ref.optional.doctor.motions import LinkMotion
from tests.closeness import assert_relative, assert_within
from tests.tolerances import ROUNDING


@pytest.mark.parametrize("rpy", np.random.default_rng(0).uniform(-3.0, 3.0, (20, 3)))
def test_roll_pitch_yaw_turn_about_the_fixed_axes_in_that_order(rpy):
    R = Rotation.from_euler("xyz", rpy).as_matrix()
    assert_within(rotation(rpy), R, ROUNDING)
    q = quaternion(rpy)
    assert_relative(np.linalg.norm(q), 1.0, ROUNDING)
    assert_within(Rotation.from_quat(q).as_matrix(), R, ROUNDING)


def test_what_turns_with_a_link_does_not_turn_relative_to_it():
    """The link turns about z by 0, 1, 2 rad; the other in its frame about x by 0, 0, 0.3 rad."""
    hand = Rotation.from_rotvec(np.outer([0.0, 1.0, 2.0], [0, 0, 1]))
    object_in_hand = Rotation.from_rotvec(np.outer([0.0, 0.0, 0.3], [1, 0, 0]))
    t_hand = np.array([[0.0, 0, 0], [0.1, 0, 0], [0.2, 0, 0]])
    t_in_hand = np.array([[0.0, 0.05, 0]] * 3)
    times = np.arange(3.0)
    seen = LinkMotion(
        times, (hand * object_in_hand).as_matrix(), t_hand + hand.apply(t_in_hand)
    ).relative_to(LinkMotion(times, hand.as_matrix(), t_hand))
    assert_within(seen.rotation_since(0.0), [0.0, 0.0, 0.3], ROUNDING)
    assert_within(seen.t, t_in_hand, ROUNDING)
