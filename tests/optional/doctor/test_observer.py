"""Findings of runs: too few contacts end to end, the command line, scenarios that come along."""

import copy
import json
import pickle

import numpy as np
import pytest

import quasistatic_ref as qr
from quasistatic_ref import RunFailed, load_scenario, load_trajectory
from quasistatic_ref.formats.npz import json_array
from quasistatic_ref.lab.bench.scenes import boxes
from quasistatic_ref.optional.doctor import looks, observer, slowly, start
from quasistatic_ref.simulate.finding import finding_table
from quasistatic_ref.simulate.header import header_table
from tests.extras import SCENARIOS_TO_RUN
from tests.optional.doctor.mistake_scenes import scenes_written


def test_findings_are_printed_and_strict_fails_on_grave_ones(tmp_path, cli):
    scenes_written(tmp_path)
    arguments = ["run", tmp_path / "push.toml", "--out", tmp_path]
    arguments += ["--set", "steps=5", "--set", "contacts.rest.mu_v=6"]
    printed = cli(*arguments).err.splitlines()
    run = load_trajectory(tmp_path / "push.npz")
    assert printed == [f"quasistatic-ref: {found}" for found in run.findings]
    assert run.findings[0].name == "no friction coefficient"
    assert json.loads(cli(*arguments, "--strict", "--json", status=1).out)["findings"] == [
        finding_table(f) for f in run.findings
    ]
    assert str(run.findings[0])[:40] in repr(run)


def test_strict_is_content_with_findings_that_are_not_grave(tmp_path, cli):
    arguments = ["run", "block_push", "--set", "steps=60", "--out", tmp_path]
    (found,) = json.loads(cli(*arguments, "--json", "--strict").out)["findings"]
    assert (found["name"], found["grave"]) == ("drag", False)


OF_RUN = "locked guides, forces of single contacts"
ARTIFACTS = {
    "block_push": ["drag"],
    "panda_push": ["drag", "boundary layer"],
    "door": ["drag"],
    "block_incline": ["not in equilibrium"],
    "sphere_spin": ["not in equilibrium"],
    "two_finger_pinch": ["corners of the cone"],
    "peg_in_hole": ["boundary layer"],
}
"""What is not small: a smooth block slides down its incline, and a sphere is turned by more than
its floor bears; one of two bars is held in the ellipsoid alone; a door is set in motion."""


@pytest.mark.parametrize("name", SCENARIOS_TO_RUN)
def test_of_a_scenario_that_comes_along_nothing_grave_is_found(name):
    settings = ["solver.certify=off", "record=light", "steps=60"]
    run = load_scenario(name, settings, fast=True).run(progress=False)
    assert [found.name for found in run.findings] == ARTIFACTS.get(name, [])


def test_a_body_that_sticks_to_what_pushes_it_is_looked_at():
    """The arm's tip bears any part of mu_v N of its weight: one solution of many is approached."""
    run = load_scenario("arm_push", ["solver.certify=off", "record=light"], fast=True).run(
        progress=False
    )
    assert run.findings == ()
    assert "fixed point" not in run.header.not_looked_at


@pytest.mark.parametrize(("most", "names"), [(looks.GROUP, ["drag"]), (0, [])])
def test_a_large_scene_is_looked_at_by_groups(most, names, monkeypatch):
    monkeypatch.setattr(start, "SEARCHED", 0)
    monkeypatch.setattr(looks, "GROUP", most)
    run = load_scenario("block_push", ["solver.certify=off", "steps=60"], fast=True).run(
        progress=False
    )
    assert [found.name for found in run.findings] == names
    said = "equilibrium of 1 bodies: too many of them touch"
    assert (said in run.header.not_looked_at) is (most == 0)


def slid():
    """Three equal boxes, pushed by 0.7 of their weight, of which friction takes a half."""
    slides = boxes(3)
    force = slides.force
    simulator = slides.simulator("off", True)
    return qr.rollout(
        simulator, slides.q, slides.target, 8, force=lambda t, q: force, progress=False
    )


def test_groups_that_are_alike_are_proved_once(monkeypatch):
    proved = []
    by_proof = slowly.Solvers.by_proof
    monkeypatch.setattr(
        slowly.Solvers, "by_proof", lambda self, step: proved.append(step) or by_proof(self, step)
    )
    together = slid()
    count = len(proved)
    monkeypatch.setattr(slowly, "alike", lambda step, sizes: object())
    apart = slid()
    assert count * 3 == len(proved) - count
    for one, other in zip(together.findings, apart.findings, strict=True):
        assert (one.name, one.remedy) == (other.name, other.remedy)
        numbers = {key: value for key, value in other.numbers.items() if key != "step"}
        assert {key: one.numbers[key] for key in numbers} == pytest.approx(numbers, rel=1e-9)


def test_what_is_beyond_the_budget_is_counted_and_what_moves_far_is_asked_once(monkeypatch):
    monkeypatch.setattr(looks, "PROVED", 0)
    run = slid()
    names = [found.name for found in run.findings]
    assert names.count("not in equilibrium") == 3
    assert "steps with other contacts: 0 proofs were made" in run.header.not_looked_at


def test_what_is_not_looked_at_in_a_large_scene_is_said(tmp_path, cli, monkeypatch):
    monkeypatch.setattr(start, "SEARCHED", 0)
    arguments = ["block_push", "--set", "steps=3"]
    of_scene = "guides, points of faces"
    line = f"{of_scene}, {OF_RUN}: the scene is large"
    assert f"not looked at: {line}" in cli("run", *arguments, "--out", tmp_path).err
    assert load_trajectory(tmp_path / "block_push.npz").header.not_looked_at == line
    printed = cli("inspect", *arguments).out
    assert f"not looked at: {of_scene}: the scene is large" in printed


def test_a_law_whose_steps_are_not_solved_again_is_said():
    run = load_scenario("block_push", law="coulomb", steps=2).run(progress=False)
    line = "locked guides, forces of single contacts: steps are not those of the convex law alone"
    assert run.header.not_looked_at == line


@pytest.mark.parametrize("progress", [True, False])
def test_findings_are_silenced_by_their_own_argument_alone(capsys, progress):
    system = qr.System([qr.Body.of_shape("ball", qr.Sphere(0.05), mass=0.3, xyz=(0, 0, 1))])
    simulator = qr.Simulator(system, [], h=0.01, K_q=1.0)
    qr.rollout(simulator, system.q_start, [], 1, progress=progress)
    assert "ball" in capsys.readouterr().err
    run = qr.rollout(simulator, system.q_start, [], 1, progress=progress, findings=False)
    assert run.findings
    assert "ball" not in capsys.readouterr().err


def test_a_file_from_before_there_were_findings_has_none(tmp_path):
    run = load_scenario("block_push", steps=1).run(progress=False)
    header = header_table(run.header) | {"warnings": ["a sentence"]}
    del header["findings"]
    np.savez(tmp_path / "old.npz", header=json_array(header), **run.arrays)
    assert load_trajectory(tmp_path / "old.npz").findings == ()


@pytest.mark.parametrize("name", ["findings", "Run"])
def test_an_error_in_the_findings_costs_the_findings_and_not_the_run(name, monkeypatch):
    def fails(*_):
        raise MemoryError("no room for (200, 600, 600)")

    monkeypatch.setattr(observer, name, fails)
    run = load_scenario("block_push", steps=2).run(progress=False)
    assert (len(run), run.findings) == (2, ())
    assert run.header.not_looked_at == "findings: MemoryError no room for (200, 600, 600)"


@pytest.mark.parametrize("error", [MemoryError, KeyboardInterrupt])
def test_steps_of_which_nothing_is_noted_cost_the_findings_and_not_the_run(error, monkeypatch):
    def fails(steps):
        raise error

    scenario = load_scenario("block_push", steps=2)
    monkeypatch.setattr(observer, "gives", fails)
    if error is MemoryError:
        run = scenario.run()
    else:
        with pytest.raises(RunFailed, match="step 1: interrupted") as failure:
            scenario.run()
        run = failure.value.trajectory
    assert (len(run), run.findings) == (2, ())
    assert run.header.not_looked_at == "findings: nothing is noted of the steps after 0"


def test_findings_that_are_not_printed_are_looked_for_when_they_are_first_read(
    tmp_path, monkeypatch
):
    """Then, in a pickle and in a file they are those of a run that prints them."""
    looks_taken = []
    looked_for = observer._looked_for
    scenario = load_scenario("two_finger_pinch", steps=10, fast=True)
    printed = scenario.run(progress=False)
    assert printed.findings
    monkeypatch.setattr(
        observer, "_looked_for", lambda *run: looks_taken.append(1) or looked_for(*run)
    )
    for read in (
        lambda run: run.findings,
        lambda run: pickle.loads(pickle.dumps(run)).findings,
        lambda run: copy.copy(run.header).findings,
        lambda run: load_trajectory(qr.save_trajectory(tmp_path / "run.npz", run)).findings,
    ):
        run = scenario.run(progress=False, findings=False)
        assert run.step_data(3) == printed.step_data(3)
        assert run.header.quasi_dynamic_number == printed.header.quasi_dynamic_number
        assert not looks_taken
        assert read(run) == printed.findings
        assert run == printed
        assert looks_taken == [1]
        looks_taken.clear()
