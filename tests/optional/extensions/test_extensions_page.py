"""The examples of docs/extensions.md: short, right, and exact where they are rows."""

import re

import cvxpy as cp
import numpy as np
import pytest

from quasistatic_ref import (
    Extension,
    InputError,
    load_scenario,
    load_trajectory,
    rollout,
    save_trajectory,
    solve_step,
)
from tests.closeness import assert_relative, assert_same, assert_within
from tests.helpers import error, pinch, random_step
from tests.made import actuated_step, contacts_of, no_contacts
from tests.pages import ROOT
from tests.tolerances import OPTIMUM, ROUNDING

PAGE = ROOT / "docs" / "extensions.md"
SHOWN = {}
for block in re.findall(r"^```python\n(.*?)^```$", PAGE.read_text("utf-8"), re.M | re.S):
    if "def " in block:
        exec(block, SHOWN)


def joint(tau=2.0):
    """One actuated coordinate, without contacts: alone it would go to tau / K, K = 100 N/m."""
    return actuated_step([[100.0]], [tau], [0.0], no_contacts(1), 0.01)


def wall(target, K):
    """One that presses on a wall."""
    contact = contacts_of(0.0, np.eye(3), -np.eye(4)[None, :, 2:3], 0.5)
    return actuated_step([[K]], [0.0], [target], contact, 0.01)


def test_a_joint_stops_at_its_limit_exactly():
    # Free it would move by tau / K = 0.02; the limit is 0.005 away and pushes back tau - K 0.005.
    limits = SHOWN["joint_limits"](np.array([0.25]), np.array([-1.0]), np.array([0.255]))
    step = joint()
    answer = solve_step(step, extension=limits)
    assert answer.certificate.kind == "exact"
    assert answer.delta_q[0] == 0.255 - 0.25
    push = step.h * (2.0 - 100.0 * (0.255 - 0.25))
    assert_relative(answer.lam_extra, [0.0, push])


@pytest.mark.parametrize("target", [0.003, 0.05])
def test_a_saturated_actuator_presses_with_tau_max_and_no_more(target):
    # On the wall the contact carries min(K target, tau_max).
    K = 1000.0
    tau_max = 4.0
    step = wall(target, K)
    saturation = SHOWN["actuator_saturation"](step.h, np.array([K]), np.array([tau_max]))
    answer = solve_step(step, extension=saturation)
    assert answer.certificate.kind == "residual"
    expected = min(K * target, tau_max)
    assert_relative(answer.wrench[0, 2], expected, OPTIMUM)
    assert_within(answer.delta_q, [0.0], OPTIMUM * target)
    assert_relative(solve_step(step).wrench[0, 2], K * target)


@pytest.mark.parametrize("tau", [-3.0, 0.99])
def test_dry_friction_holds_up_to_its_force_and_takes_it_off_beyond(tau):
    # (1 + 1e-6) K delta_q = tau - tau_f sign(delta_q), or 0 while |tau| <= tau_f = 1.
    friction = SHOWN["dry_friction"](0.01, np.array([100.0]), np.ones(1))
    answer = solve_step(joint(tau), extension=friction)
    assert answer.certificate.kind == "exact"
    expected = np.sign(tau) * max(abs(tau) - 1.0, 0.0) / (100.0 * (1 + 1e-6))
    assert_relative(answer.delta_q, [expected, abs(expected)])


def test_welded_bodies_move_as_one_exactly(rng):
    # Two free bodies, m_1 pushed: with one twist for both, (M_1 + M_2) delta = h^2 tau.
    step = random_step(rng, 0, 12, rows=())
    J = np.eye(12).reshape(2, 6, 12)
    answer = solve_step(step, extension=SHOWN["weld"](*J))
    assert answer.certificate.kind == "exact"
    one, two = answer.delta_q.reshape(2, 6)
    assert_same(two, one)
    E = np.tile(np.eye(6), (2, 1))
    expected = step.h**2 * np.linalg.solve(E.T @ step.M_u @ E, E.T @ step.tau_u)
    assert_relative(one, expected, ROUNDING * 100)


def test_the_smoothed_step_converges_to_the_hard_one_like_the_weight():
    step = pinch(grip=5.0, offset=0.02)
    hard = solve_step(step).delta_q
    weights = 10.0 ** -np.arange(8, 13)
    soft = [solve_step(step, extension=SHOWN["smoothing"](w)).delta_q for w in weights]
    errors = [error(step, delta_q, hard) for delta_q in soft]
    rates = np.diff(np.log10(errors)) / np.diff(np.log10(weights))
    assert_within(rates, 1.0, 0.01)


def test_a_cost_that_is_not_convex_is_refused_in_a_sentence():
    with pytest.raises(InputError, match="not convex"):
        solve_step(joint(), extension=Extension(lambda s: [-cp.sum_squares(s.delta_q)]))


def test_a_simulator_takes_an_extension_and_its_trajectory_replays(tmp_path):
    scenario = load_scenario("bunny_grasp", ["steps=8"], fast=True)
    h = scenario.h
    n_a = scenario.system.n_a
    simulator = scenario.simulator(lambda q: SHOWN["velocity_limit"](h, np.full(n_a, 1e-3)))
    trajectory = rollout(simulator, scenario.system.q_start, scenario.targets, 8)
    assert set(trajectory["certificate"].tolist()) == {"exact"}
    np.testing.assert_array_less(np.abs(trajectory["delta_q"][:, :n_a]), 1e-3 * h * (1 + ROUNDING))
    read = load_trajectory(save_trajectory(tmp_path / "run.npz", trajectory))
    step = read.step_data(7)
    assert len(step.extra.names) == 2 * n_a
    answer = solve_step(step, "osqp")
    assert_same(answer.delta_q, read["delta_q"][7])
