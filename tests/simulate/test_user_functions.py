"""Targets and forces as functions of t or of (t, q); loops by hand that end in a trajectory."""

from functools import partial

import numpy as np
import pytest

from quasistatic_ref import InputError, Recorder
from tests.cases import cases
from tests.closeness import assert_same

STEPS = 4


def goal(t):
    return np.array([0.1 * t, np.cos(t), np.sin(t)])


class Callable:
    """An object that is called with t."""

    def __call__(self, t, nu=0):
        """Its target; splines take the order of a derivative as well."""
        assert nu == 0
        return goal(t)


OF_TIME = {
    "a function": goal,
    "with a default": lambda t, k=3: goal(t),
    "all defaults": lambda time=99.0: goal(time),
    "partial": partial(lambda k, t: goal(t), 3),
    "an object": Callable(),
    "of t and q": lambda t, q: goal(t),
    "a list": lambda t: goal(t).tolist(),
}


@cases("target", OF_TIME)
def test_a_function_of_time_may_be_written_in_any_way(run, target):
    times = [0.01 * (k + 1) for k in range(STEPS)]
    expected = np.array([goal(t) for t in times])
    assert_same(run(target)["q_bar_a"], expected)


OTHER = {
    "none": lambda: goal(0.0),
    "q alone": lambda q: goal(0.0),
    "the other way round": lambda q, t: goal(t),
    "by name only": lambda t, *, q: goal(t),
}


@cases("function", OTHER)
@pytest.mark.parametrize("name", ["target", "force"])
def test_other_arguments_are_refused_before_the_first_step(run, name, function):
    given = {"target": goal} | {name: function}
    with pytest.raises(InputError, match=rf"^{name}: must be a function of t, of \(t, q\), or of"):
        run(**given)


def test_an_error_of_the_callers_own_is_left_alone(run):
    with pytest.raises(ZeroDivisionError):
        run(lambda t: 1 / 0)


def test_a_loop_by_hand_ends_in_the_trajectory_of_rollout(scenario, run):
    simulator = scenario.simulator()
    q = scenario.system.q_start
    expected = run(goal, STEPS)
    recorder = Recorder(simulator, q, "full")
    for _ in range(STEPS):
        result = simulator.step(q, goal(recorder.t))
        recorder.add(goal(recorder.t), result)
        q = result.q
    found = recorder.trajectory()
    assert found == expected
    assert found.seconds.keys() == expected.seconds.keys()


def test_a_target_may_ask_for_the_result_of_the_step_before(run):
    seen = []

    def target(t, q, last):
        seen.append((q.copy(), last))
        return goal(t)

    done = run(target)
    assert seen[0][1] is None
    for k, (q, last) in enumerate(seen[1:]):
        assert_same(q, done["q"][k + 1])
        assert_same(last.q, q)
        assert last.forces.shape == (len(done["mu_v"]), 4)
