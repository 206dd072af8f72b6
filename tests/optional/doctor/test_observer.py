"""Findings of runs: too few contacts end to end, the command line, scenarios that come along."""

import copy
import json
import pickle

import numpy as np
import pytest
import scipy.optimize
from scipy.optimize import OptimizeResult

import quasistatic_ref as qr
from quasistatic_ref import RunFailed, load_scenario, load_trajectory
from quasistatic_ref.files.finding import finding_read, finding_table
from quasistatic_ref.files.npz import json_array
from quasistatic_ref.files.trajectory import header_table
from quasistatic_ref.optional.doctor import checks, observer, scenes, slow, start
from tests.extras import SCENARIOS_TO_RUN
from tests.optional.doctor.mistake_scenes import scenes_written


def test_findings_are_printed_and_strict_fails_on_grave_ones(tmp_path, cli):
    scenes_written(tmp_path)
    arguments = ["run", tmp_path / "push.toml", "--out", tmp_path]
    arguments += ["--set", "steps=5", "--set", "contacts.rest.mu_v=6"]
    printed = cli(*arguments).err.splitlines()
    run = load_trajectory(tmp_path / "push.npz")
    grave = [f"quasistatic-ref: {found}" for found in run.findings if found.grave]
    assert printed[: len(grave)] == grave
    assert grave[0].startswith("quasistatic-ref: grave: a friction coefficient is the ratio")
    assert grave[0].endswith("; check mu_v of contacts.rest [no-friction-coefficient]")
    assert json.loads(cli(*arguments, "--strict", "--json", status=1).out)["findings"] == [
        finding_table(f) for f in run.findings
    ]
    assert str(run.findings[0])[:40] in repr(run)


def test_strict_is_content_with_findings_that_are_not_grave(tmp_path, cli):
    arguments = ["run", "block_push", "--set", "steps=60", "--out", tmp_path, "--certify", "off"]
    printed = cli(*arguments, "--json", "--strict")
    (found,) = json.loads(printed.out)["findings"]
    assert (found["name"], found["grave"], found["of"]) == ("artifact", False, "push")
    line = "1 note: artifact (push); --notes shows the sentence"
    assert printed.err.splitlines()[-1] == f"quasistatic-ref: {line}"
    printed = cli(*arguments, "--notes").err.splitlines()[-1]
    assert printed.startswith("quasistatic-ref: note: push(")
    assert printed.endswith("; move more slowly, or take a larger h [artifact]")


def test_findings_that_are_ignored_do_not_count_and_are_named(tmp_path, cli):
    scenes_written(tmp_path)
    arguments = ["run", tmp_path / "push.toml", "--strict", "--out", tmp_path]
    arguments += ["--set", "steps=5", "--set", "contacts.rest.mu_v=6"]
    printed = cli(*arguments, "--ignore", "no-friction-coefficient,leap").err
    assert printed == "quasistatic-ref: ignored: no-friction-coefficient\n"
    run = load_trajectory(tmp_path / "push.npz")
    (ignored,) = run.ignored_findings
    assert (run.findings, ignored.name) == ((), "no-friction-coefficient")
    wrong = cli(*arguments, "--ignore", "friction", status=2).err
    assert "friction" in wrong
    assert "is no finding" in wrong
    scene = tmp_path / "push.toml"
    table = '[findings]\nignore = ["no-friction-coefficient"]\n\n[bodies.pusher]'
    scene.write_text(scene.read_text("utf-8").replace("[bodies.pusher]", table, 1), "utf-8")
    assert load_scenario(scene, {"contacts.rest.mu_v": 6}).findings() == ()
    cli(*arguments)
    with pytest.raises(qr.InputError, match="is no finding"):
        load_scenario(scene, {"findings.ignore": ["leaps"]})


def test_a_file_whose_sentences_begin_with_the_remedy_is_read():
    old = {"name": "free fall", "grave": True, "remedy": "hold it", "numbers": {"fallen_mm": 3.0}}
    found = finding_read(old | {"sentence": "hold it: it falls"}, "findings[0]")
    assert str(found) == "grave: it falls; hold it [free fall]"
    assert finding_read(finding_table(found), "findings[0]") == found


def fails(*_):
    raise ZeroDivisionError("no reason")


def refuses(*_):
    raise qr.QuasistaticError("no normal")


def unanswered(at, s, most):
    last = at(np.arange(len(s)), s)
    return last._replace(own=np.zeros(len(s), dtype=bool))


OF_RUN = "locked guides, forces of single contacts"
NOTES = {
    "block_push": "artifact",
    "door": "artifact",
    "block_incline": "equilibrium",
    "sphere_spin": "equilibrium",
    "two_finger_pinch": "corners",
}
"""What a scene shows: a smooth block slides down its incline, and a sphere is turned by more than
its floor bears; one of two bars is held in the ellipsoid alone; drag pushes a block and a door."""


@pytest.mark.parametrize("name", SCENARIOS_TO_RUN)
def test_a_scenario_that_comes_along_is_silent_but_for_what_it_shows(name):
    settings = ["solver.certify=off", "record=light"]
    run = load_scenario(name, settings, fast=True).run(progress=False)
    assert run.header.not_looked_at == ""
    assert [one.name for one in run.findings] == ([NOTES[name]] if name in NOTES else [])
    assert not any(one.grave for one in run.findings)


SLOW_STEPS = {
    "too many contacts touch": (slow, "GROUP", 0),
    "a slow step has no answer": (slow, "fixed_points", unanswered),
    "QuasistaticError no normal": (scenes.Scene, "__init__", refuses),
}


def test_what_slow_steps_do_not_answer_is_said_by_name(monkeypatch):
    """A block that slides is asked whether it stays, and one that is pushed for what drag adds."""
    unproved = {"solver.certify": "off"}
    sliding = load_scenario("block_incline", unproved, steps=3, fast=True)
    pushed = load_scenario("block_push", unproved, steps=60, fast=True)
    runs = [scene.run(progress=False) for scene in (sliding, pushed)]
    assert [[one.name for one in run.findings] for run in runs] == [["equilibrium"], ["artifact"]]
    pairs = "floor(floor, block/block#0) and push(pusher/plate#0, block/block#0)"
    asked = "equilibrium of smooth", f"equilibrium of block, artifacts of {pairs}"
    for why, change in SLOW_STEPS.items():
        with monkeypatch.context() as changed:
            changed.setattr(*change)
            for scene, what in zip((sliding, pushed), asked, strict=True):
                run = scene.run(progress=False)
                assert run.findings == ()
                assert run.header.not_looked_at == f"{what}: {why}"


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


def test_a_check_that_fails_costs_its_finding_and_not_the_run(monkeypatch):
    """Each in its turn; all others find what they found. At last a run, in which all fail."""
    scenario = load_scenario("block_incline", steps=2, fast=True)
    run = scenario.run(progress=False, findings=False)
    every = (*checks.OF_SCENE, *checks.OF_RUN)
    broken = [check._replace(findings=fails, unless=lambda _: "") for check in every]
    for i, check in enumerate(every):
        found, skipped = checks.looked([*every[:i], broken[i], *every[i + 1 :]], run.header.at)
        assert {*found} >= {one for one in run.findings if one.name != "equilibrium"}
        assert f"{check.name or 'fails'}: ZeroDivisionError no reason" == skipped
    monkeypatch.setattr(observer, "OF_SCENE", ())
    monkeypatch.setattr(observer, "OF_RUN", tuple(broken))
    run = scenario.run(progress=False)
    assert (len(run), run.findings) == (2, ())
    assert run.header.not_looked_at.endswith(": ZeroDivisionError no reason")


def test_a_linear_program_without_an_answer_is_said(monkeypatch):
    """Of a peg in its hole, whose walls do not let it rise, and where no coordinate is free."""
    scenario = load_scenario("peg_in_hole", {"solver.certify": "off"}, h=0.5, steps=6)
    assert scenario.run(progress=False).header.not_looked_at == ""
    no_answer = OptimizeResult(x=None, status=4, message="numerical difficulties")
    monkeypatch.setattr(scipy.optimize, "linprog", lambda *_, **more: no_answer)
    run = scenario.run(progress=False)
    line = "locked guides: QuasistaticError linprog: numerical difficulties"
    assert (len(run), run.header.not_looked_at) == (6, line)


@pytest.mark.parametrize("name", ["Run", "Start", "quasi_dynamic_number", "gives"])
def test_whatever_fails_around_the_checks_costs_the_findings_and_not_the_run(name, monkeypatch):
    monkeypatch.setattr(observer, name, fails)
    run = load_scenario("block_push", steps=2).run(progress=False)
    assert (len(run), run.findings) == (2, ())
    assert run.header.not_looked_at.startswith("findings: ")


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
