"""Answers of which nothing is claimed, in few calls: those of the long way, to the last bit."""

import numpy as np
import pytest

from quasistatic_ref import load_scenario
from quasistatic_ref.lab.scenes.piles import pile
from quasistatic_ref.optional.fast import simulator
from quasistatic_ref.optional.fast.adapters.daqp import Daqp
from tests.closeness import assert_within
from tests.optional.fast.compiled.test_fast import needs_compiler

pytestmark = needs_compiler
UNCERTIFIED = ["solver.certify=off", "record=light"]


def results(scenario, fast, steps=12):
    simulator = scenario.simulator()
    q = scenario.system.q_start
    if not fast:
        simulator.by_c = False
    for k in range(steps):
        result = simulator.step(q, scenario.targets(scenario.h * (k + 1)))
        q = result.q
        yield result


def counted(monkeypatch):
    """How many answers are taken in few calls, and how many are not."""
    found = []
    plain = simulator.as_said

    def watched(*arguments):
        said = plain(*arguments)
        found.append(said is not None)
        return said

    monkeypatch.setattr(simulator, "as_said", watched)
    return found


@pytest.mark.parametrize("name", ["bunny_grasp", "stack"])
def test_runs_of_which_nothing_is_claimed_have_the_bits_of_the_long_way(monkeypatch, name):
    scenario = load_scenario(name, UNCERTIFIED, fast=True)
    found = counted(monkeypatch)
    for one, other in zip(results(scenario, True), results(scenario, False), strict=True):
        assert one == other
        assert one.solution.statistics._replace(solve_time=0.0) == (
            other.solution.statistics._replace(solve_time=0.0)
        )
    assert sum(found) >= 10  # the first steps make what is kept


def fails(reply):
    reply.solved = False
    reply.status = "on purpose"


def is_not_finite(reply):
    reply.x[0] = np.nan


def has_no_multipliers(reply):
    reply.lam = None


def raises(reply):
    raise RuntimeError("on purpose")


@pytest.mark.parametrize("wrong", [fails, is_not_finite, has_no_multipliers, raises])
def test_an_answer_that_will_not_do_is_left_to_the_long_way(monkeypatch, wrong):
    """The next reply of the backend is right again, and so is what the step comes to."""
    scenario = load_scenario("bunny_grasp", UNCERTIFIED, fast=True)
    expected = [result.q for result in results(scenario, True, 8)]
    plain = Daqp.reply
    calls = []
    found = counted(monkeypatch)

    def once(self, same_H, warm):
        reply = plain(self, same_H, warm)
        calls.append(reply)
        if len(calls) in (6, 7):  # and its second, cold attempt
            wrong(reply)
        return reply

    monkeypatch.setattr(Daqp, "reply", once)
    run = list(results(scenario, True, 8))
    assert False in found[3:]
    for result, q in zip(run, expected, strict=True):
        assert_within(result.q, q, 1e-9)  # cold, and so not the same bits


def test_backends_that_rows_out_of_reach_hurt_take_the_long_way(monkeypatch):
    scenario = load_scenario("bunny_grasp", [*UNCERTIFIED, "solver.backend=piqp"], fast=True)
    found = []
    found = counted(monkeypatch)
    list(results(scenario, True, 4))
    assert found
    assert not any(found)


def test_bodies_in_several_parts_of_the_workspace_have_the_bits_of_the_plain_path():
    """Nine free bodies have 54 coordinates, and a part at most 48."""
    ways = [pile((9, 1, 1), backend="daqp") for _ in range(2)]
    assert len(ways[0].simulator.system.workspace().parts) == 2
    ways[1].simulator.by_c = False
    q = [way.q for way in ways]
    for _ in range(3):
        one, other = (
            way.simulator.step(at, np.zeros(0), way.force) for way, at in zip(ways, q, strict=True)
        )
        assert one == other
        q = [one.q, other.q]
    assert ways[0].simulator.by_c
