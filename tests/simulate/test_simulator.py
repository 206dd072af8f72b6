"""The simulator: its step is the hand-assembled one, its targets and forces at the right times."""

import numpy as np
import pytest

from quasistatic_ref.contact.distance import closest_points
from quasistatic_ref.contact.jacobian import ContactGeometry
from quasistatic_ref.contact.pairs import contact_layout
from quasistatic_ref.errors import InputError, RunFailed, StepDataError
from quasistatic_ref.model.system import Body, System
from quasistatic_ref.scenario.scenario import load_scenario
from quasistatic_ref.simulate.rollout import rollout
from quasistatic_ref.simulate.simulator import Simulator
from quasistatic_ref.solve.solve import solve_step
from quasistatic_ref.step.data import StepData
from tests.model.urdf.urdf_texts import joint, link, robot, written
from tests.scenes import written_scenario
from tests.tolerances import EXACT, ROUNDING, STICKING

GRAVITY = 9.81


@pytest.fixture
def scenario(tmp_path):
    return load_scenario(written_scenario(tmp_path), fast=True)


@pytest.fixture
def lift(tmp_path):
    """A mass of 2 kg on a vertical slide."""
    text = robot(link("post"), link("car"), joint("z", "post", "car", "prismatic", "0 0 1"))
    return System([Body("lift", written(tmp_path, text), actuated=("z",))])


def test_a_step_is_the_hand_assembled_one_solved(scenario, rng):
    system = scenario.system
    simulator = scenario.simulator()
    q = system.q_start
    force = rng.normal(size=8)
    q_bar_a = np.array([0.01, np.cos(0.3), np.sin(0.3)])
    kinematics = system.kinematics(q)
    points = closest_points(scenario.pairs, kinematics)
    gravity = [0.0] * 4 + [-0.3 * GRAVITY] + [0.0] * 3  # on the ball, whose frame is the world's
    geometry = ContactGeometry(contact_layout(scenario.pairs), system.column_map)
    expected = StepData(
        h=0.01,
        K_q=np.diag([500.0, 2.5]),
        M_u=system.M_u(q),
        tau_a=force[:2],
        tau_u=force[2:] + gravity[2:],
        delta_q_bar_a=[0.01, 0.3],
        contacts=geometry.contacts(points, kinematics),
    )
    found = simulator.step(q, q_bar_a, force)
    for key in ("h", "K_q", "M_u", "tau_a", "tau_u", "delta_q_bar_a"):
        np.testing.assert_allclose(
            getattr(found.step, key), getattr(expected, key), rtol=ROUNDING, atol=ROUNDING
        )
    for key in ("phi", "n", "d1", "d2", "J", "mu_v", "mu_omega", "rows"):
        one = getattr(found.step.contacts, key)
        two = getattr(expected.contacts, key)
        np.testing.assert_allclose(one, two, rtol=EXACT, atol=EXACT)
    solution = solve_step(found.step)
    np.testing.assert_allclose(found.solution.delta_q, solution.delta_q, rtol=EXACT, atol=EXACT)
    q_next = system.integrate(q, solution.delta_q)
    np.testing.assert_allclose(found.q, q_next, rtol=EXACT, atol=EXACT)


def test_the_target_is_a_change_from_where_the_joints_are(scenario):
    system = scenario.system
    simulator = scenario.simulator()
    q = system.integrate(system.q_start, np.array([0.004, 3.0, 0, 0, 0, 0, 0, 0]))
    q_bar_a = np.array([0.01, np.cos(3.4), np.sin(3.4)])
    step = simulator.step(q, q_bar_a).step
    np.testing.assert_allclose(step.delta_q_bar_a, [0.006, 0.4], rtol=ROUNDING)


def test_row_k_of_a_table_is_the_target_at_the_end_of_step_k(scenario):
    steps = 100
    table = np.stack([np.linspace(0, -0.1, steps), np.ones(steps), np.zeros(steps)], axis=1)
    q = scenario.system.q_start
    run = rollout(scenario.simulator(), q, table, steps, record="light", progress=False)
    np.testing.assert_allclose(run["q_bar_a"], table, rtol=EXACT, atol=EXACT)


def test_targets_and_forces_are_asked_for_at_the_end_of_the_step(scenario):
    calls = []

    def force(t, q):
        calls.append((t, q.copy()))
        return np.zeros(8)

    q = scenario.system.q_start
    run = rollout(scenario.simulator(), q, scenario.targets, 3, force=force, progress=False)
    np.testing.assert_allclose([t for t, _ in calls], [0.01, 0.02, 0.03], rtol=EXACT)
    np.testing.assert_allclose([q for _, q in calls], run["q"][:3], rtol=EXACT, atol=EXACT)
    expected = [scenario.targets(t) for t in (0.01, 0.02, 0.03)]
    np.testing.assert_allclose(run["q_bar_a"], expected, rtol=EXACT, atol=EXACT)


TARGETS = {
    "too short": np.zeros(2),
    "too few steps": np.zeros((3, 3)),
    "NaN": np.array([np.nan, 1.0, 0.0]),
}


@pytest.mark.parametrize("target", TARGETS.values(), ids=TARGETS)
def test_a_target_of_another_shape_or_not_finite_is_refused(scenario, target):
    with pytest.raises(
        InputError, match=r"target: must contain finite numbers of shape \(3,\) or \(4"
    ):
        rollout(scenario.simulator(), scenario.system.q_start, target, 4, progress=False)


def test_a_target_that_is_no_configuration_is_refused(scenario):
    goal = np.array([0.0, 2 * np.cos(0.3), 2 * np.sin(0.3)])  # taken for 0, not 0.3
    with pytest.raises(InputError):
        rollout(scenario.simulator(), scenario.system.q_start, goal, 1, progress=False)


def test_a_force_that_is_not_a_number_ends_the_run_at_its_step(scenario):
    def force(t, q):
        return np.full(8, np.nan if t > 0.015 else 0.0)

    q = scenario.system.q_start
    with pytest.raises(RunFailed, match=r"^step 1: tau_a: must contain finite") as caught:
        rollout(scenario.simulator(), q, scenario.targets, 3, force=force, progress=False)
    assert caught.value.trajectory.steps == 1
    assert isinstance(caught.value.__cause__, StepDataError)


def test_an_uncompensated_joint_sags_by_its_weight_over_its_stiffness(lift):
    feels = np.array([True])
    K_q = np.array([[400.0]])
    simulator = Simulator(lift, [], h=0.01, K_q=K_q, gravity_acts=feels)
    run = rollout(simulator, lift.q_start, lift.q_start, 3, progress=False)
    sag = 2 * GRAVITY / 400
    np.testing.assert_allclose(run["tau_a"], [[-2 * GRAVITY]] * 3, rtol=ROUNDING)
    np.testing.assert_allclose(run["q"][:, 0], [0, -sag, -sag, -sag], rtol=STICKING, atol=ROUNDING)
