"""Grippers, hinges and gantries: each claim is that of the scenario's README."""

import numpy as np

from quasistatic_ref import load_scenario
from quasistatic_ref.simulate.record.trajectory import certified
from tests.closeness import assert_relative, assert_within
from tests.tolerances import FIRST_ORDER, SCENARIO

G = 9.81
H = 0.01


def test_of_two_pinched_bars_one_is_held_and_one_pivots_and_slips():
    m = 0.2
    inertia = 1.0666666666666667e-3
    K_q = 1e3
    N_0 = 5.0
    mu_v = 0.5
    mu_omega = 0.02
    offset = 0.069
    assert 0.055 < mu_omega * (2 * N_0 / (m * G) - 1 / mu_v) < offset
    a = mu_omega / mu_v
    omega = (
        H
        * (m * G * (a + offset) - 2 * mu_omega * N_0)
        / (m * (a + offset) ** 2 + inertia + 2 * K_q * mu_omega**2 * H**2)
    )
    scenario = load_scenario("two_finger_pinch", fast=True)
    trajectory = scenario.run()
    assert certified(trajectory) == "100 of 100 steps exact"
    q = trajectory["q"]
    held, pivoting = (scenario.system.joint(f"{name}/base") for name in ("held", "pivoting"))
    assert_within(q[-1, held.q], q[0, held.q], SCENARIO)
    # delta_q is the twist at the centre of mass, which sinks by slip and turn.
    expected = H * omega * np.array([0, 0, -(a + offset), 1, 0, 0])
    twist = trajectory["delta_q"][0, pivoting.v]
    np.testing.assert_allclose(twist, expected, rtol=SCENARIO, atol=SCENARIO * H * omega)
    angle = 2 * np.arcsin(q[-1, pivoting.q][3])
    assert_relative(angle, omega * 100 * H, FIRST_ORDER)
    assert_relative(trajectory["phi"][1, 2:], mu_omega * H * omega, SCENARIO)


def test_a_door_follows_the_tip_that_pushes_it_and_stops_with_it():
    inertia = 0.1 + 2 * 0.4**2
    K_q = 2000.0
    r = 0.6
    w = 0.045
    scenario = load_scenario("door", fast=True)
    trajectory = scenario.run()
    assert certified(trajectory) == "500 of 500 steps exact"
    M_u = scenario.system.M_u(scenario.system.q_start)
    assert_relative(M_u, [[inertia]], SCENARIO)
    x, theta = trajectory["q"][1:].T
    pushed = slice(120, 400)  # in touch, on the move
    place = r * np.tan(theta) - w / np.cos(theta)
    assert_within(x[120:], place[120:], SCENARIO)
    before = trajectory["q"][:-1, 1]
    s = r / np.cos(before) - w * np.tan(before)
    v = trajectory["delta_q"][:, 0] / H
    lag = trajectory["q_bar_a"][:, 0] - x
    expected = inertia * v * np.cos(before) ** 2 / (H * K_q * s**2)
    assert_relative(v[pushed], 0.1, 0.011)
    assert_relative(lag[pushed], expected[pushed], FIRST_ORDER)
    assert_within(x[-1], 0.345, SCENARIO)
    assert_within(theta[-50:], theta[-1], SCENARIO)
    assert_within(np.degrees(theta[-1]), 33.63, 0.005)
