"""Observers of a run: when they are asked, what is kept of what they say, and how they end it."""

from dataclasses import replace

import numpy as np
import pytest

from quasistatic_ref import (
    Extra,
    InputError,
    Observer,
    Recorder,
    RunFailed,
    load_scenario,
    rollout,
)
from quasistatic_ref.simulate.recorder import PACKED
from tests.cases import cases

STEPS = 3


@pytest.fixture(scope="module")
def scenario():
    return load_scenario("sphere_spin", steps=STEPS)


class Witness(Observer):
    """Keeps the z of each step's end, and notes when it was asked; perhaps it ends the run."""

    notes = ("height", "unknown")

    def __init__(self, ends_at=None, every_step=True):
        self.ends_at = ends_at
        self.every_step = every_step
        self.asked = []

    def before(self, recorder):
        """Before a step."""
        self.asked.append(("before", recorder.steps))
        if recorder.steps == self.ends_at:
            raise InputError("high enough")

    def after(self, recorder, results, arrays):
        """After it, or several."""
        assert [result.q.tolist() for result in results] == arrays["q"].tolist()
        self.asked.append(("after", recorder.steps))
        return {"height": arrays["q"][:, 2], "unknown": [None] * len(results)}

    def end(self, recorder, trajectory, interrupted):
        """At the end."""
        self.asked.append(("end", recorder.steps, trajectory.failed, interrupted))
        heights = recorder.noted("height").tolist()
        self.noted = {name: recorder.noted(name).tobytes() for name in recorder.notes}
        return replace(trajectory, header=replace(trajectory.header, not_looked_at=str(heights)))


def test_an_observer_is_asked_before_and_after_each_step_and_at_the_end(scenario):
    witness = Witness()
    plain = scenario.run()
    run = scenario.run(observers=[witness])
    steps = [each for k in range(STEPS) for each in (("before", k), ("after", k + 1))]
    assert witness.asked == [*steps, ("end", STEPS, None, False)]
    heights = run.q[1:, 2].tolist()
    assert run == replace(plain, header=replace(plain.header, not_looked_at=str(heights)))


@pytest.mark.parametrize("name", ["bunny_grasp", "block_push"])
def test_a_run_whose_steps_are_packed_one_by_one_is_the_same(name):
    """In all arrays, notes and findings."""
    scene = load_scenario(name, steps=PACKED + 5, record="full", fast=True)
    of_each, of_packs = Witness(), Witness(every_step=False)
    single, whole = (scene.run(observers=[one]) for one in (of_each, of_packs))
    assert len(of_each.asked) == 2 * whole.steps + 1
    assert len(of_packs.asked) == whole.steps + 2 + 1
    assert of_each.noted == of_packs.noted
    assert single == whole


def test_an_observer_ends_a_run_as_any_failure_does(scenario):
    witness = Witness(ends_at=2)
    with pytest.raises(RunFailed, match="step 2: high enough") as caught:
        scenario.run(observers=[witness])
    assert witness.asked[-2:] == [("before", 2), ("end", 2, "step 2: high enough", False)]
    heights = caught.value.trajectory.q[1:, 2].tolist()
    assert caught.value.trajectory.header.not_looked_at == str(heights)


class Failing(Observer):
    """Returns a note of so many steps where it is asked for the second time; keeps its numbers."""

    notes = ("note",)

    def __init__(self, note):
        self.note = note
        self.found = []

    def after(self, recorder, results, arrays):
        """After several steps."""
        for array in arrays.values():
            with pytest.raises(ValueError, match="read-only"):
                array[:] = array
        assert recorder.trajectory().steps == recorder.steps
        self.found.append((recorder.steps, len(recorder.noted("note"))))
        arrays.clear()
        first = len(self.found) == 1
        return {"note": np.zeros(len(results))} if first else self.note(len(results))


def low(n):
    raise InputError("low", field="x", value=1)


FAILS = {
    "an error": (low, r"x: low \(got 1\)"),
    "a number": (
        lambda n: {"note": 3.0},
        r"note note: must be an array of . rows of numbers, .* \(got 3.0\)",
    ),
    "another shape": (
        lambda n: {"note": np.zeros((n, 3))},
        r"note note: must have shape \(\) in each step, as in those before \(got \(3,\)\)",
    ),
    "a name of the record's": (
        lambda n: {"lam": np.zeros(n)}, "note lam: is a name that the recording uses",
    ),
}  # fmt: skip


@cases("note, says", FAILS)
def test_an_observer_that_fails_in_a_block_leaves_all_steps(note, says):
    """Also in the last block of the run, which is shorter."""
    taken = PACKED + 5
    scene = load_scenario("sphere_spin", steps=taken, fast=True)
    observer = Failing(note)
    with pytest.raises(RunFailed, match=f"^step {taken - 1}: {says}") as caught:
        scene.run(observers=[observer])
    assert observer.found == [(PACKED, 0), (taken, PACKED)]
    failed = str(caught.value)
    whole = scene.run()
    assert caught.value.trajectory == replace(whole, header=replace(whole.header, failed=failed))


def test_rows_of_an_extension_that_change_are_refused(scenario):
    from quasistatic_ref import Extension

    limits = Extra(("ceiling", "wall"), np.eye(6)[:2], [-1.0, -1.0])
    extensions = iter([Extension(), Extension(rows=limits)])
    simulator = scenario.simulator(lambda q: next(extensions))
    says = "extension: has ceiling in step 1, where the step before has no row; give the same rows"
    with pytest.raises(RunFailed, match=says) as caught:
        rollout(simulator, scenario.system.q_start, [], 2)
    assert caught.value.trajectory.steps == 1


def test_a_recorder_of_one_s_own_knows_the_waypoints_of_its_targets():
    scenario = load_scenario("two_finger_pinch", steps=1)
    simulator, q = scenario.simulator(), scenario.system.q_start
    recorder = Recorder(simulator, q, target=scenario.targets)
    assert recorder.tracks == scenario.targets.tracks
    for target in (q, scenario.targets.over, {"near": 0.0}, None):
        assert Recorder(simulator, q, target=target).tracks == recorder.idle_columns == ()
