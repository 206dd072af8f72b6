"""Findings of runs: too few contacts end to end, the command line, scenarios that come along."""

import copy
import json
import pickle

import pytest

import quasistatic_ref as qr
from quasistatic_ref import RunFailed, load_scenario, load_trajectory
from quasistatic_ref.optional.doctor import checks, observer
from quasistatic_ref.simulate.finding import told
from tests.extras import SCENARIOS_TO_RUN
from tests.optional.doctor.mistake_scenes import scenes_written
from tests.oracles.records import change_header, header_in
from tests.scenes import written_scenario


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
    printed = json.loads(cli(*arguments, "--strict", "--json", status=1).out)["findings"]
    assert printed == header_in(tmp_path / "push.npz")["findings"]
    assert str(run.findings[0])[:40] in repr(run)


def test_strict_is_content_with_findings_that_are_not_grave(tmp_path, cli):
    arguments = ["run", "block_push", "--set", "steps=60", "--out", tmp_path, "--certify", "off"]
    printed = cli(*arguments, "--json", "--strict")
    (found,) = json.loads(printed.out)["findings"]
    assert (found["name"], found["grave"], found["of"]) == ("artifact", False, "push")
    line = printed.err.splitlines()[-1]
    assert line.startswith("quasistatic-ref: note: push(")
    assert line.endswith("; move more slowly, or take a larger h [artifact]")


def test_three_notes_are_printed_and_the_names_of_others():
    notes = [qr.Finding("artifact", False, "", f"cause {i}", {}, f"pair {i}") for i in range(5)]
    grave = qr.Finding("leap", True, "", "it leaps", {})
    *first, last = told([*notes, grave], notes[:1])
    others = "and 2 more: artifact (pair 3), artifact (pair 4)"
    assert first == [*map(str, notes[:3]), str(grave), others]
    assert last == "ignored: artifact (pair 0)"


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


def test_files_whose_sentences_begin_with_the_remedy_or_without_findings_are_read(tmp_path):
    run = load_scenario("block_push", steps=1).run(progress=False)
    path = qr.save_trajectory(tmp_path / "old.npz", run)
    old = {"name": "free fall", "grave": True, "remedy": "hold it", "numbers": {"fallen_mm": 3.0}}
    change_header(path, findings=[old | {"sentence": "hold it: it falls"}])
    read = load_trajectory(path)
    (found,) = read.findings
    assert str(found) == "grave: it falls; hold it [free fall]"
    assert load_trajectory(qr.save_trajectory(path, read)).findings == (found,)
    change_header(path, findings=..., warnings=["a sentence"])
    assert load_trajectory(path).findings == ()


def fails(*_):
    raise ZeroDivisionError("no reason")


OF_RUN = "locked guides"
NOTES = {"block_push": "artifact", "door": "artifact"}
"""Drag pushes a block, and a door without friction."""


@pytest.mark.shared
@pytest.mark.parametrize("name", SCENARIOS_TO_RUN)
def test_a_scenario_that_comes_along_is_silent_but_for_what_it_shows(name):
    settings = ["solver.certify=off", "record=light"]
    run = load_scenario(name, settings, fast=True).run(progress=False)
    assert run.header.not_looked_at == ""
    assert [one.name for one in run.findings] == ([NOTES[name]] if name in NOTES else [])
    assert not any(one.grave for one in run.findings)


FLOOR = """format = "quasistatic-ref/scenario"
version = 1
h = 0.01
steps = 1
[shapes.floor]
halfspace = { normal = [0, 0, 1], offset = 0 }
"""
LYING = """[bodies.b{0}]
urdf = "ball.urdf"
base = "floating"
pose = {{ xyz = [{0}, 0, 0.05] }}
[contacts.c{0}]
alpha = "floor"
beta = "b{0}"
mu_v = 0.5
rows = 4
"""


def test_a_large_scene_says_what_is_not_looked_at(tmp_path, cli):
    """Of 92 balls J has 4 * 92 * 552 entries, more than are searched."""
    path = written_scenario(tmp_path, FLOOR + "".join(map(LYING.format, range(92))), "large.toml")
    of_scene = "guides, points of faces"
    line = f"{of_scene}, {OF_RUN}: the scene is large"
    assert f"not looked at: {line};" in cli("run --fast", path, "--out", tmp_path).err
    header = load_trajectory(tmp_path / "large.npz").header
    assert header.not_looked_at.startswith(f"{line}; bodies that share no table: more than 300")
    printed = cli("inspect", path).out
    assert f"not looked at: {of_scene}: the scene is large" in printed


@pytest.mark.parametrize("progress", [True, False])
def test_findings_are_silenced_by_their_own_argument_alone(capsys, progress):
    system = qr.System([qr.Body.of_shape("ball", qr.Sphere(0.05), mass=0.3, xyz=(0, 0, 1))])
    simulator = qr.Simulator(system, [], h=0.01, K_q=1.0)
    qr.rollout(simulator, system.q_start, [], 1, progress=progress)
    assert "ball" in capsys.readouterr().err
    run = qr.rollout(simulator, system.q_start, [], 1, progress=progress, findings=False)
    assert run.findings
    assert "ball" not in capsys.readouterr().err


def test_a_check_that_fails_costs_its_finding_alone():
    """Each in its turn; all others find what they found. At last all fail."""
    run = load_scenario("block_push", steps=60, fast=True).run(progress=False, findings=False)
    every = (*checks.OF_SCENE, *checks.OF_RUN)
    for i, check in enumerate(every):
        found, skipped = checks.looked([*every[:i], fails, *every[i + 1 :]], run.header.at)
        own = {one.name for one in checks.looked([check], run.header.at)[0]}
        assert {one.name for one in found} >= {one.name for one in run.findings} - own
        assert skipped == "fails: ZeroDivisionError no reason"
    found, skipped = checks.looked([fails, fails], run.header.at)
    assert (list(found), skipped) == ([], "fails, fails: ZeroDivisionError no reason")


@pytest.mark.parametrize("name", ["Run", "Start", "quasi_dynamic_number", "gives"])
def test_failures_around_the_checks_cost_the_findings_and_not_the_run(name, monkeypatch):
    monkeypatch.setattr(observer, name, fails)
    run = load_scenario("block_push", steps=2).run(progress=False)
    assert (run.steps, run.findings) == (2, ())
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
    assert (run.steps, run.findings) == (2, ())
    assert run.header.not_looked_at == "findings: nothing is noted of the steps after 0"


def test_findings_that_are_not_printed_are_looked_for_when_they_are_first_read(
    tmp_path, monkeypatch
):
    """Then, in a pickle and in a file they are those of a run that prints them."""
    looks_taken = []
    looked = observer.looked
    scenario = load_scenario("block_push", steps=60, fast=True)
    printed = scenario.run(progress=False)
    assert printed.findings
    monkeypatch.setattr(observer, "looked", lambda *run: looks_taken.append(1) or looked(*run))
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
