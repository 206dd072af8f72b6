"""Rotations: matrices, quaternions and angles against those of SciPy."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from quasistatic_ref.model.rotation import quaternion, rotation
from tests.closeness import assert_relative, assert_within


@pytest.mark.parametrize("rpy", np.random.default_rng(0).uniform(-3.0, 3.0, (20, 3)))
def test_roll_pitch_yaw_turn_about_the_fixed_axes_in_that_order(rpy):
    R = Rotation.from_euler("xyz", rpy).as_matrix()
    assert_within(rotation(rpy), R)
    q = quaternion(rpy)
    assert_relative(np.linalg.norm(q), 1.0)
    assert_within(Rotation.from_quat(q).as_matrix(), R)
