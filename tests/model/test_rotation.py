"""Rotations: matrices, quaternions and angles against products of elementary rotations."""

import numpy as np
import pytest

from quasistatic_ref.cli.measures import rotation_angle
from quasistatic_ref.model.rotation import quaternion, rotation
from tests.tolerances import ROUNDING

RPY = np.random.default_rng(0).uniform(-3.0, 3.0, (20, 3))


def about(axis, angle):
    """Rodrigues: R = I + sin(angle) K + (1 - cos(angle)) K K, K r = axis x r."""
    x, y, z = axis
    K = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * K + (1 - np.cos(angle)) * K @ K


@pytest.mark.parametrize("rpy", RPY)
def test_roll_pitch_yaw_turn_about_the_fixed_axes_in_that_order(rpy):
    roll, pitch, yaw = (about(axis, angle) for axis, angle in zip(np.eye(3), rpy, strict=True))
    np.testing.assert_allclose(rotation(rpy), yaw @ pitch @ roll, rtol=0, atol=ROUNDING)


@pytest.mark.parametrize("rpy", RPY)
def test_the_quaternion_of_roll_pitch_yaw_is_the_same_rotation(rpy):
    # q = [axis sin(angle / 2), cos(angle / 2)], so R = I + 2 w [v] + 2 [v][v]
    *v, w = quaternion(rpy)
    x, y, z = v
    V = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    R = np.eye(3) + 2 * w * V + 2 * V @ V
    np.testing.assert_allclose(np.dot(v, v) + w * w, 1.0, rtol=ROUNDING)
    np.testing.assert_allclose(R, rotation(rpy), rtol=0, atol=ROUNDING)


@pytest.mark.parametrize("angle", [0.0, 1e-9, 1e-3, 0.5, 2.0, np.pi - 1e-3, np.pi - 1e-9, np.pi])
def test_the_angle_of_a_rotation_about_any_axis_is_the_angle_turned(angle):
    axes = np.random.default_rng(1).normal(size=(2, 5, 3))
    axes /= np.linalg.norm(axes, axis=-1, keepdims=True)
    R = np.array([[about(axis, angle) for axis in row] for row in axes])
    np.testing.assert_allclose(rotation_angle(R), np.full((2, 5), angle), rtol=0, atol=ROUNDING)
    np.testing.assert_allclose(rotation_angle(R[0]), np.full(5, angle), rtol=0, atol=ROUNDING)
