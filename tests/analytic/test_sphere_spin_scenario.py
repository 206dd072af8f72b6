"""models/sphere_spin step by step: it sticks up to mu_omega m g, and follows its recurrence beyond.

The formula is that of models/sphere_spin/README.md.
"""

import numpy as np
import pytest

from quasistatic_ref import load_scenario
from tests.closeness import assert_within

MASS = 0.3
INERTIA = 8e-5
RADIUS = 0.05
MU_OMEGA = 0.01
H = 0.01
GRAVITY = 9.81
LIMIT = MU_OMEGA * MASS * GRAVITY
AT_LIMIT = 39
"""The step whose torque is the limit, to rounding."""


def torque(k):
    """Of step k, at its end: it grows to 0.14715 N m in 2 s."""
    return 0.14715 * (k + 1) * H / 2


@pytest.fixture(scope="module")
def run():
    return load_scenario("sphere_spin", fast=True).run()


def test_the_sphere_sticks_up_to_the_limit(run):
    assert not run["delta_q"][:AT_LIMIT].any()
    assert run["delta_q"][AT_LIMIT + 1].any()


def test_the_whole_run_is_the_recurrence_from_rest(run):
    phi = 0.0
    angle = 0.0
    heights = [RADIUS]
    turns = [0.0]
    for k in range(200):
        turn = (H**2 * (torque(k) - LIMIT) + MASS * MU_OMEGA * phi) / (INERTIA + MASS * MU_OMEGA**2)
        if torque(k) <= LIMIT:
            turn = 0.0
        phi += MU_OMEGA * turn - phi
        angle += turn
        heights.append(RADIUS + phi)
        turns.append(angle)
    assert turns[-1] > 2 * np.pi  # more than once around
    assert_within(run["q"][:, 2], heights)
    assert_within(run["q"][:, 5], np.sin(np.array(turns) / 2))
