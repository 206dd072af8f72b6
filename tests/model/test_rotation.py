"""Rotations: matrices, quaternions and angles against those of SciPy."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from quasistatic_ref import Body, System
from tests.closeness import assert_within
from tests.scenes import BALL


@pytest.mark.parametrize("rpy", np.random.default_rng(0).uniform(-3.0, 3.0, (20, 3)))
def test_roll_pitch_yaw_turn_about_the_fixed_axes_in_that_order(rpy):
    """As a matrix of a body that is held, and as a quaternion of one that is free."""
    system = System([Body(base, BALL, base, rpy=rpy) for base in ("fixed", "floating")])
    R = Rotation.from_euler("xyz", rpy).as_matrix()
    assert_within(system.kinematics(system.q_start).R[1:], [R, R])
