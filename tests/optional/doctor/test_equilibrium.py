"""What contacts cannot bear, against closed forms of statics."""

import numpy as np
import pytest

from quasistatic_ref.lab.scenes.rigid import rigid_step
from quasistatic_ref.optional.doctor.equilibrium import bearing

M = 2.0
WEIGHT = M * 9.81
TOLERANCE = 1e-6
"""Of HiGHS, over the load [-]."""
UP = np.eye(3)
LEFT = np.array([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]])  # its normal is +x
RIGHT = np.array([[0.0, 1.0, 0.0], [0.0, 0.0, -1.0], [-1.0, 0.0, 0.0]])
CORNERS = [(x, y, -0.01) for x in (-0.05, 0.05) for y in (-0.05, 0.05)]


def missing(wrench, points, frames, at_most=np.inf, cone="pyramid", **friction):
    """What the contacts of one body lack, shape (6,) [N, N m]; rows of `frames` are d1, d2, n."""
    frames = np.broadcast_to(frames, (len(points), 3, 3))
    step = rigid_step(M, 2e-3, wrench, np.array(points), frames, h=0.01, **friction)
    touching = np.ones(len(points), dtype=bool)
    return bearing(step.replace(cone=cone), touching, np.full(len(points), at_most)).missing


@pytest.mark.parametrize("cone", ["pyramid", "ellipsoid"])
@pytest.mark.parametrize(("degrees", "mu"), [(25, 0.2), (25, 0.5), (40, 0.6), (60, 0.3)])
def test_a_box_on_a_slope_lacks_what_friction_does_not_bear(degrees, mu, cone):
    slope = np.radians(degrees)
    load = WEIGHT * np.array([np.sin(slope), 0, -np.cos(slope), 0, 0, 0])
    found = missing(load, CORNERS, UP, cone=cone, mu_v=mu, rows=4)
    off = TOLERANCE if cone == "pyramid" else 1e-3  # of a polygon about the circle
    lacks = max(WEIGHT * (np.sin(slope) - mu * np.cos(slope)), 0.0)
    np.testing.assert_allclose(found, [-lacks, 0, 0, 0, 0, 0], atol=off * WEIGHT)


@pytest.mark.parametrize("N", [10.0, 15.0, 30.0])
def test_fingers_bear_by_their_normal_force_alone(N):
    points = [(-0.02, 0, 0), (0.02, 0, 0)]
    found = missing((0, 0, -WEIGHT, 0, 0, 0), points, [LEFT, RIGHT], at_most=N, mu_v=0.6, rows=4)
    lacks = max(WEIGHT - 2 * 0.6 * N, 0.0)
    np.testing.assert_allclose(found, [0, 0, lacks, 0, 0, 0], atol=TOLERANCE * WEIGHT)


def test_torsion_bears_mu_omega_times_the_normal_force():
    load = (0, 0, -WEIGHT, 0, 0, 0.2)
    found = missing(load, [(0, 0, -0.05)], UP, mu_v=0.5, mu_omega=0.005, rows=6)
    np.testing.assert_allclose(np.abs(found).sum(), 0.2 - 0.005 * WEIGHT, rtol=1e-5)
