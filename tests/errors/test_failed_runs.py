"""Runs that end early keep what was done, and the step that failed; one sentence says why."""

import os
import signal
import threading

import numpy as np
import pytest

from quasistatic_ref import (
    Limits,
    Observer,
    RunFailed,
    load_scenario,
    load_step,
    load_trajectory,
)
from quasistatic_ref.simulate.interrupt import ENDS, Interrupt, exit_status
from tests.cases import cases
from tests.closeness import assert_relative
from tests.errors.scene import SCENE, SUNK, changed, scene_written

WEDGE = (
    # The ball between the floor and a ceiling 1 mm too low: no displacement opens both.
    ("shapes/ceiling", {"halfspace": {"normal": [0.0, 0.0, -1.0], "offset": -0.099}}),
    ("contacts/ceiling", {"alpha": "ceiling", "beta": "ball", "mu_v": 0.5, "rows": 4}),
)
THROWN = (("bodies/ball/wrenches/0/force", [0.0, 0.0, 3e4]), ("contacts", {}))
"""3e4 N on 0.3 kg: h^2 f / m = 10 m a step, straight up from 0.05 m."""
CASES = {
    # name: (changes to the scene, steps that succeed, words of the sentence)
    "without solution": (
        WEDGE, 0,
        ("floor(floor, ball/ball#0)/0", "ceiling(ceiling, ball/ball#0)/0", "contradict each other",
         "widen these gaps, or make one of the bodies compliant"),
    ),
    "too deep": (
        (SUNK,), 0,
        ("contact floor(floor, ball/ball#0)/0 is 0.08 m deep, deeper than "
         "limits.penetration = 0.05 m", "start the bodies apart", "or raise the limit"),
    ),
    "out of the scene": (
        (*THROWN, ("limits/reach", 15.0), ("steps", 9)), 1,
        ("link ball/ball is 20 m from the origin, farther than limits.reach = 15 m",
         "check its wrenches and targets, or raise the limit"),
    ),
}  # fmt: skip


@cases("changes, steps, words", CASES)
def test_a_run_that_fails_leaves_its_steps_and_the_one_that_failed(
    tmp_path, cli, changes, steps, words
):
    path = scene_written(tmp_path, changed(SCENE, *changes))
    out = tmp_path / "out"
    captured = cli("run", path, "--out", out, status=3)
    assert captured.out == ""
    *warned, said = captured.err.splitlines()
    assert said.startswith(f"quasistatic-ref: step {steps}: ")
    assert all(word in captured.err for word in words)
    trajectory = load_trajectory(out / "scene.npz")
    assert trajectory.steps == steps
    assert trajectory.failed is not None
    assert trajectory.failed in captured.err
    assert warned == [f"quasistatic-ref: {finding}" for finding in trajectory.findings]
    assert trajectory["q"].shape[0] == steps + 1
    failed = load_step(out / "scene_failed_step.json")
    assert f"the failing step in {out / 'scene_failed_step.json'}" in captured.err
    # It is the step that starts where the trajectory ends.
    scenario = load_scenario(path, fast=True)
    with pytest.raises(RunFailed) as caught:
        scenario.run()
    assert caught.value.step == failed
    assert sorted(os.listdir(out)) == ["scene.npz", "scene_failed_step.json"]
    if steps:
        cli("extract", out / "scene.npz", "--step", steps - 1)


def test_the_failing_step_fails_again_by_itself(tmp_path, cli):
    path = scene_written(tmp_path, changed(SCENE, *WEDGE))
    cli("run", path, "--out", tmp_path, status=3)
    step = tmp_path / "scene_failed_step.json"
    proof = tmp_path / "proof.json"
    cli("solve", step, "-o", proof, status=3)
    assert "the step has no solution" in cli("verify", step, proof).out


@pytest.mark.parametrize(("depth", "fails"), [(0.0799, True), (0.0801, False)])
def test_the_depth_that_is_allowed_is_the_scenario_s(tmp_path, depth, fails):
    alone = (("contacts/push", ...), ("bodies/ball/wrenches", ...))
    scene = changed(SCENE, SUNK, *alone, ("limits/penetration", depth), ("steps", 1))
    scenario = load_scenario(scene_written(tmp_path, scene), fast=True)
    if fails:
        with pytest.raises(RunFailed, match=r"is 0\.08 m deep"):
            scenario.run()
    else:
        trajectory = scenario.run()
        # Pushed out in one step: the sphere's lowest point is on the floor.
        assert_relative(scenario.system.of(trajectory.q[1], "ball.z"), 0.05)


def test_a_position_that_is_no_number_is_out_of_the_scene():
    said = Limits().out_of_reach(("world", "ball"), np.array([[0.0, 0.0, 0.0], [0.0, np.nan, 1.0]]))
    assert said is not None
    assert said.startswith("link ball is nan m from the origin")


@pytest.fixture
def listening():
    """Signals as a terminal has them: a process in the background ignores SIGINT."""
    before = {one: signal.signal(one, usual) for one, usual in ENDS.items()}
    yield
    for one, handler in before.items():
        signal.signal(one, handler)


@pytest.mark.usefixtures("listening")
@pytest.mark.parametrize("end", ENDS)
def test_a_signal_is_noted_once_and_raised_the_second_time(end):
    before = signal.getsignal(end)
    with Interrupt() as interrupt:
        interrupt.check()
        signal.raise_signal(end)
        assert interrupt.noted == end
        with pytest.raises(KeyboardInterrupt):
            interrupt.check()
        with pytest.raises(KeyboardInterrupt) as raised:
            signal.raise_signal(end)
    assert exit_status(raised.value) == 128 + end
    assert signal.getsignal(end) is before


@pytest.mark.usefixtures("listening")
@pytest.mark.parametrize("end", ENDS)
def test_a_signal_keeps_the_steps_before_it(end, tmp_path):
    """It comes while step 1 is taken, which is kept as well."""

    class Ending(Observer):
        def before(self, recorder):
            if recorder.steps == 1:
                signal.raise_signal(end)

    scenario = load_scenario(scene_written(tmp_path), fast=True)
    with pytest.raises(RunFailed) as raised:
        scenario.run(observers=[Ending()])
    word = "interrupted" if end == signal.SIGINT else f"ended by {end.name}"
    assert str(raised.value) == f"step 2: {word}"
    assert raised.value.trajectory.steps == 2


def test_a_handler_of_the_caller_is_left_alone():
    calls = []
    before = signal.signal(signal.SIGINT, lambda number, frame: calls.append(number))
    try:
        with Interrupt() as interrupt:
            signal.raise_signal(signal.SIGINT)
        assert (calls, interrupt.noted) == ([signal.SIGINT], None)
    finally:
        signal.signal(signal.SIGINT, before)


def test_a_run_in_another_thread_needs_no_signals(tmp_path):
    scenario = load_scenario(scene_written(tmp_path), fast=True)
    runs = []
    thread = threading.Thread(target=lambda: runs.append(scenario.run()))
    thread.start()
    thread.join()
    assert runs[0].steps == 3
