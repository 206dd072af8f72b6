"""A state of a system: checked once, and not of the order in which states are asked."""

import numpy as np
import pytest

from quasistatic_ref import ModelError, load_scenario
from tests.closeness import assert_same
from tests.made import bits

GRAVITY = (0.0, 0.0, -9.81)
NAMES = (  # mimics, a ball, a tree with bodies
    "bunny_grasp",
    pytest.param("allegro_turn", marks=pytest.mark.extra("robots")),
    "door",
)


def facts(state):
    """What a step asks of a state."""
    at = state.kinematics
    parts = [at.R, at.t, at.columns, state.M_u, state.gravity(GRAVITY)]
    n = state.system.n_q_a
    return [*parts, state.change_to(state.system.q_start[:n]), state.plus(change(state)).q]


def change(state):
    """Some delta_q."""
    return np.linspace(-0.1, 0.1, state.system.n_v)


@pytest.mark.parametrize("name", NAMES)
def test_two_states_of_one_system_that_are_asked_in_turn_do_not_disturb_each_other(name):
    """Each answer is that of a system that knows one state alone, in every bit."""
    system = load_scenario(name).system
    here = system.at(system.q_start)
    there = here.plus(change(here))
    expected = [facts(load_scenario(name).system.at(q)) for q in (here.q, there.q)]
    assert not np.array_equal(here.q, there.q)
    weights = [state.gravity(GRAVITY) for state in (here, there, here)]  # before where links are
    assert_same(weights[0], expected[0][4])
    assert_same(weights[1], expected[1][4])
    assert_same(weights[2], weights[0])
    columns = [state.kinematics.columns.copy() for state in (there, here)]
    assert bits([facts(there), facts(here)]) == bits(expected[::-1])
    assert_same(there.kinematics.columns, columns[0])
    assert_same(here.kinematics.columns, columns[1])


def test_a_state_is_of_its_system_and_of_a_copy_of_q():
    system = load_scenario("door").system
    q = system.q_start.copy()
    here = system.at(q)
    assert system.at(here) is here
    q[0] += 1.0
    assert_same(here.q, system.q_start)
    with pytest.raises(ValueError, match="read-only"):
        here.q[0] = 1.0
    other = load_scenario("door").system
    assert other.at(here).system is other
    with pytest.raises(ModelError, match=r"^q: must have shape"):
        system.at(q[1:])


def test_a_step_from_the_end_of_the_last_is_that_from_its_q_and_computes_nothing_twice(monkeypatch):
    scenario = load_scenario("bunny_grasp")
    simulator, system = scenario.simulator(), scenario.system
    first = simulator.step(system.q_start, scenario.targets(0.01))
    by_q = simulator.step(first.q, scenario.targets(0.02))
    moves = []
    move = type(system._workspace).move
    monkeypatch.setattr(
        type(system._workspace), "move", lambda self, q: [moves.append(q), move(self, q)]
    )
    by_state = simulator.step(first.end, scenario.targets(0.02))
    assert len(moves) == 1  # of its own end
    assert by_state == by_q
