"""The simulator: its targets and forces at the right times; steps are those of the vectors."""

import copy
import pickle
import time

import numpy as np
import pytest

from quasistatic_ref import (
    RunFailed,
    StepDataError,
    load_scenario,
    rollout,
)
from tests.closeness import assert_close, assert_relative, assert_same

GRAVITY = 9.81


@pytest.mark.parametrize("copied", [copy.copy, lambda one: pickle.loads(pickle.dumps(one))])
def test_a_copy_of_a_result_has_no_end_and_says_what_makes_it(copied):
    scenario = load_scenario("sphere_spin", fast=True)
    result = scenario.simulator().step(scenario.system.q_start)
    assert (result.end.q == result.q).all()
    assert copied(result) == result
    with pytest.raises(AttributeError, match=r"system\.at\(result\.q\)"):
        assert copied(result).end
    with pytest.raises(AttributeError, match="no 'ends'"):
        assert result.ends


@pytest.mark.parametrize("fast", [False, True])
def test_a_result_is_no_others_to_change(fast):
    scenario = load_scenario("sphere_spin", fast=fast)
    q = scenario.system.q_start.copy()
    result = scenario.simulator().step(q)
    before = result.forces_on("sphere")
    q[0] += 1.0
    assert (result.forces_on("sphere") == before).all()
    assert not result.q.flags.writeable
    listed = scenario.simulator().step(scenario.system.q_start.tolist(), [])
    assert (listed.forces_on("sphere") == before).all()


def test_the_target_is_a_change_from_where_the_joints_are(scenario):
    system = scenario.system
    simulator = scenario.simulator()
    q = system.integrate(system.q_start, np.array([0.004, 3.0, 0, 0, 0, 0, 0, 0]))
    q_bar_a = np.array([0.01, np.cos(3.4), np.sin(3.4)])
    step = simulator.step(q, q_bar_a).step
    assert_relative(step.delta_q_bar_a, [0.006, 0.4])


def test_row_k_of_a_table_is_the_target_at_the_end_of_step_k(run):
    steps = 20
    table = np.stack([np.linspace(0, -0.1, steps), np.ones(steps), np.zeros(steps)], axis=1)
    assert_same(run(table, steps, record="light")["q_bar_a"], table)


@pytest.mark.parametrize("fast", [False, True])
def test_the_parts_of_a_run_add_up_to_its_wall_time(fast):
    scenario = load_scenario("sphere_spin", steps=20, fast=fast)
    simulator = scenario.simulator()
    scenario.run()  # which imports what a run needs
    shares = []
    for _ in range(3):  # another process may take its turn between two parts, but not each time
        begin = time.perf_counter()
        run = rollout(simulator, scenario.system.q_start, scenario.targets, 20)
        wall = time.perf_counter() - begin
        shares.append(sum(float(part.sum()) for part in run.seconds.values()) / wall)
    assert 0.95 <= max(shares) <= 1


def test_forces_are_asked_for_at_the_end_of_the_step(scenario, run):
    calls = []

    def force(t, q):
        calls.append((t, q.copy()))
        return np.arange(8.0)

    done = run(scenario.targets, 3, force=force)
    assert_same([t for t, _ in calls], [0.01, 0.02, 0.03])
    assert_same([q for _, q in calls], done["q"][:3])
    # At the start the ball's frame is the world's; the rail bears its own weight.
    weight = np.array([0, 0, 0.3 * GRAVITY, 0, 0, 0])
    tau = np.concatenate([done["tau_a"][0], done["tau_u"][0] + weight])
    assert_close(tau, np.arange(8.0))


def test_a_force_that_is_not_a_number_ends_the_run_at_its_step(scenario, run):
    def force(t, q):
        return np.full(8, np.nan if t > 0.015 else 0.0)

    with pytest.raises(RunFailed, match=r"^step 1: tau_a: must contain finite") as caught:
        run(scenario.targets, 3, force=force)
    assert caught.value.trajectory.steps == 1
    assert isinstance(caught.value.__cause__, StepDataError)
