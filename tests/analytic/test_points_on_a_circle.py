"""What n points on a circle of a rigid body hold against a turn without mu_omega."""

import numpy as np
import pytest

from quasistatic_ref.lab.scenes.rigid import rigid_step
from quasistatic_ref.solve.solve import solve_step

MASS = 0.5
INERTIA = 2e-4
MU_V = 0.5
RADIUS = 0.03
HEIGHT = 0.02
GRAVITY = 9.81
STILL = 1e-12
"""A turn below this [rad] is none."""


def turn(angles, torque):
    """The turn about the vertical of a body on points at these angles, with the world's tangents.

    The torque is over mu_v m g r.
    """
    n = len(angles)
    points = np.column_stack(
        [RADIUS * np.cos(angles), RADIUS * np.sin(angles), np.full(n, -HEIGHT)]
    )
    frames = np.tile(np.eye(3), (n, 1, 1))
    weight = MASS * GRAVITY
    wrench = (0, 0, -weight, 0, 0, torque * MU_V * weight * RADIUS)
    step = rigid_step(MASS, INERTIA, wrench, points, frames, mu_v=MU_V, h=0.01)
    return abs(solve_step(step, fast=True).delta_q[5])


@pytest.mark.parametrize("n", [2, 4, 6, 8, 12])
@pytest.mark.parametrize("offset", [0.0, 0.2, 0.6])
def test_a_rigid_body_is_held_by_the_point_whose_slip_is_nearest_to_a_tangent(n, offset):
    """(R16): mu_v m g r max_j max(|cos t_j|, |sin t_j|), with the slip of point j across its angle.

    Opposite points are a pair with no net force, so n is even.
    """
    angles = offset + 2 * np.pi * np.arange(n) / n
    held = np.maximum(np.abs(np.cos(angles)), np.abs(np.sin(angles))).max()
    assert turn(angles, 0.999 * held) < STILL
    assert turn(angles, 1.001 * held) > STILL
