"""Rotations: matrices, quaternions and angles against those of SciPy."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from quasistatic_ref.model.rotation import quaternion, rotation
from quasistatic_ref.optional.account.motions import rotation_angle
from tests.tolerances import ROUNDING


@pytest.mark.parametrize("rpy", np.random.default_rng(0).uniform(-3.0, 3.0, (20, 3)))
def test_roll_pitch_yaw_turn_about_the_fixed_axes_in_that_order(rpy):
    R = Rotation.from_euler("xyz", rpy).as_matrix()
    np.testing.assert_allclose(rotation(rpy), R, rtol=0, atol=ROUNDING)
    q = quaternion(rpy)
    np.testing.assert_allclose(np.linalg.norm(q), 1.0, rtol=ROUNDING)
    np.testing.assert_allclose(Rotation.from_quat(q).as_matrix(), R, rtol=0, atol=ROUNDING)


@pytest.mark.parametrize("angle", [0.0, 1e-9, 1e-3, 0.5, 2.0, np.pi - 1e-3, np.pi - 1e-9, np.pi])
def test_the_angle_of_a_rotation_about_any_axis_is_the_angle_turned(angle):
    axes = np.random.default_rng(1).normal(size=(10, 3))
    axes /= np.linalg.norm(axes, axis=-1, keepdims=True)
    R = Rotation.from_rotvec(angle * axes).as_matrix().reshape(2, 5, 3, 3)
    np.testing.assert_allclose(rotation_angle(R), np.full((2, 5), angle), rtol=0, atol=ROUNDING)
    np.testing.assert_allclose(rotation_angle(R[0]), np.full(5, angle), rtol=0, atol=ROUNDING)
