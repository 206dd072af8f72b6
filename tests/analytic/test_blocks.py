"""Boxes on flat faces: each claim is that of the scenario's README."""

import numpy as np

from docs.drawings import corner_loads
from quasistatic_ref import load_scenario
from tests.closeness import assert_close, assert_relative, assert_within
from tests.tolerances import SCENARIO

G = 9.81
H = 0.01


def test_a_pushed_block_makes_its_pusher_lag_by_friction_and_drag():
    mu_v = 0.4
    m = 0.5
    v = 0.01
    K_q = 1000.0
    trajectory = load_scenario("block_push", fast=True, steps=220).run()
    lag = trajectory["q_bar_a"][:, 0] - trajectory["q"][1:, 0]
    expected = (mu_v * m * G + m * v / H) / K_q
    assert_relative(lag[200:], expected, SCENARIO)
    height = trajectory["q"][-1, 3] - 0.05
    assert_relative(height, mu_v * H * v, SCENARIO)


def test_on_a_slope_the_rough_block_holds_and_the_smooth_one_slides():
    scenario = load_scenario("block_incline", fast=True)
    q = scenario.run()["q"]
    rough, smooth = (scenario.system.joint(f"{name}/base").q for name in ("rough", "smooth"))
    assert_within(q[-1, rough], q[0, rough], SCENARIO)
    a = np.radians(25)
    v = G * H * (np.sin(a) - 0.3 * np.cos(a))
    step = (q[-1] - q[-2])[smooth][:3]
    assert_relative(step @ [np.cos(a), 0, -np.sin(a)], v * H, SCENARIO)


def test_a_stack_stands_and_each_contact_carries_what_is_above():
    trajectory = load_scenario("stack", fast=True, steps=20).run()
    q = trajectory["q"]
    n_z = trajectory["wrench"][-1][:, 2]
    assert_within(q[-1], q[0], SCENARIO)
    loads = n_z.reshape(3, 4).sum(axis=1)
    assert_relative(loads, [1.0 * G, 0.5 * G, 0.2 * G], SCENARIO)


def test_a_push_moves_the_load_to_the_corner_ahead():
    # Moments about a lower corner: m g / 2 -+ F c / (2 w), c the height of the centre of mass.
    for push, (friction, left, right) in zip(corner_loads.PUSHES, corner_loads.main(), strict=True):
        half = G / 2
        shift = push * 0.04 / (2 * 0.05)
        assert_close([friction, left, right], [-push, half - shift, half + shift])
