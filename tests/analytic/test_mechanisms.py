"""Grippers, hinges and gantries: each claim is that of the scenario's README."""

import numpy as np

from quasistatic_ref import load_scenario
from tests.closeness import assert_relative, assert_within
from tests.tolerances import FIRST_ORDER, SCENARIO

G = 9.81
H = 0.01


def test_of_two_pinched_bars_one_is_held_and_one_pivots_and_slips():
    m = 0.2
    inertia = 1.0666666666666667e-3
    K_q = 1e3
    N_0 = 5.0
    mu_omega = 0.02
    offset = 0.069
    a = mu_omega / 0.5
    omega = (
        H
        * (m * G * (a + offset) - 2 * mu_omega * N_0)
        / (m * (a + offset) ** 2 + inertia + 2 * K_q * mu_omega**2 * H**2)
    )
    scenario = load_scenario("two_finger_pinch", fast=True)
    run = scenario.run()
    assert {*run["certificate"]} == {"exact"}
    held, pivoting = (scenario.system.joint(f"{name}/base") for name in ("held", "pivoting"))
    assert_within(run.q[-1, held.q], run.q[0, held.q], SCENARIO)
    # delta_q is the twist at the centre of mass, which sinks by slip and turn.
    twist = run["delta_q"][0, pivoting.v] / (H * omega)
    assert_within(twist, [0, 0, -(a + offset), 1, 0, 0], SCENARIO)
    angle = 2 * np.arcsin(run.q[-1, pivoting.q][3])
    assert_relative(angle, omega * 100 * H, FIRST_ORDER)


def test_a_door_follows_the_tip_that_pushes_it_and_stops_with_it():
    inertia = 0.1 + 2 * 0.4**2
    K_q = 2000.0
    r = 0.6
    w = 0.045
    scenario = load_scenario("door", fast=True)
    run = scenario.run()
    assert {*run["certificate"]} == {"exact"}
    x, theta = run["q"][1:].T
    pushed = slice(120, 400)  # in touch, on the move
    place = r * np.tan(theta) - w / np.cos(theta)
    assert_within(x[120:], place[120:], SCENARIO)
    before = run["q"][:-1, 1]
    s = r / np.cos(before) - w * np.tan(before)
    v = run["delta_q"][:, 0] / H
    lag = run["q_bar_a"][:, 0] - x
    expected = inertia * v * np.cos(before) ** 2 / (H * K_q * s**2)
    assert_relative(v[pushed], 0.1, 0.011)
    assert_relative(lag[pushed], expected[pushed], FIRST_ORDER)
    assert_within(x[-1], 0.345, SCENARIO)
    assert_within(theta[-50:], theta[-1], SCENARIO)
    assert_within(np.degrees(theta[-1]), 33.63, 0.005)
