"""Robots of the extra `robots`, found where they are installed: each claim is its README's."""

import numpy as np

from quasistatic_ref import load_scenario
from quasistatic_ref.simulate.trajectory import certified
from tests.tolerances import FIRST_ORDER, SCENARIO

G = 9.81
H = 0.01


def test_a_panda_that_pushes_a_block_yields_by_the_torques_of_the_push() -> None:
    m = 0.4
    mu_v = 0.4
    K_q = 7000.0
    scenario = load_scenario("panda_push", fast=True)
    trajectory = scenario.run(progress=False)
    assert certified(trajectory) == "400 of 400 steps exact"
    system = scenario.system
    q = trajectory["q"]
    block = system.joint("block/base")
    axes = [system.link(f"panda/panda_link{i}") for i in (2, 4, 6)]
    for k in (100, 250, 399):
        F = mu_v * m * G + m * trajectory["delta_q"][k, block.v][0] / H**2
        z_2, z_4, z_6 = system.kinematics(q[k]).t[axes, 2]
        tau = K_q * (trajectory["q_bar_a"][k] - q[k + 1, : system.n_q_a])[:7]
        np.testing.assert_allclose(tau[1] + tau[3], F * (z_4 - z_2), rtol=FIRST_ORDER, atol=0)
        np.testing.assert_allclose(tau[3] - tau[5], F * (z_4 - z_6), rtol=FIRST_ORDER, atol=0)
        np.testing.assert_allclose(tau[[0, 2, 4, 6]], 0, rtol=0, atol=SCENARIO)
    pushed = q[-1, block.q][:3] - q[0, block.q][:3]
    np.testing.assert_allclose(pushed[:2], [0.0386, 0], rtol=0, atol=5e-5)


def test_a_finger_of_the_allegro_hand_rolls_on_the_drum_that_it_turns() -> None:
    R = 0.03
    rho = 0.012
    axle = np.array([0.055, 0.0, 0.0525])
    scenario = load_scenario("allegro_turn", fast=True)
    trajectory = scenario.run(progress=False)
    assert certified(trajectory) == "300 of 300 steps exact"
    system = scenario.system
    tip = system.link("hand/link_7.0_tip")
    drum = system.joint("roller/axle")
    poses = [system.kinematics(q) for q in trajectory["q"]]
    x, _, z = np.transpose([pose.t[tip] - axle for pose in poses])
    turned = np.array([pose.R[tip] for pose in poses])
    gamma = np.arctan2(x, z)
    psi = np.arctan2(turned[:, 0, 2], turned[:, 2, 2])  # about y, the axle's direction
    theta = np.concatenate([np.zeros(1), np.cumsum(trajectory["delta_q"][:, drum.v])])
    touch = 1 + int(np.argmax(trajectory["wrench"][:, 1, 2] > 0))
    rolled = ((R + rho) * gamma - rho * psi) / R
    since = (theta - theta[touch])[touch:]
    np.testing.assert_allclose(since, (rolled - rolled[touch])[touch:], rtol=0, atol=FIRST_ORDER)
    np.testing.assert_allclose(theta[-1] - theta[50], 1.03, rtol=0, atol=0.005)
