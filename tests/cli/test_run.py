"""``run``: what it writes and prints, how it ends, in every cone."""

import io
import json
import sys

import pytest

from quasistatic_ref import Simulator, load_step, load_trajectory, save_trajectory, solve_step
from tests.closeness import assert_same
from tests.files.urdf.urdf_texts import joint, urdf_of_text
from tests.scenes import BALL, RAIL
from tests.scenes import scene as scene_of
from tests.tolerances import MULTIPLIERS


def test_run_writes_the_trajectory_and_tells_of_it(scene, out, cli):
    printed = cli("run", scene, "--out", out).out
    assert printed.startswith(
        "5 steps of 8 variables x 10 rows\n5 of 5 steps exact; backend clarabel, plain path, "
    )
    assert printed.endswith(f"wrote {out / 'scene.npz'}\n")
    assert load_trajectory(out / "scene.npz").steps == 5


def test_a_run_of_no_steps_prints_no_times(scene, out, cli):
    for steps, printed in ((0, False), (1, True)):
        words = cli("run", scene, "--out", out, "--set", f"steps={steps}").out
        assert ("ms per step" in words) == printed


def test_run_says_once_what_of_a_file_means_nothing_to_the_model(tmp_path, out, cli):
    loops = '<loop_joint name="l"/><link name="z"><odd/></link>'
    ground = joint("y", "rail", "z", "fixed")
    text = RAIL.replace("</robot>", f"{loops}{ground}</robot>")
    urdf_of_text(tmp_path, text, "rail.urdf")
    head = 'format = "quasistatic-ref/scenario"\nversion = 1\nh = 0.01\nsteps = 2\n'
    bodies = '[bodies.one]\nurdf = "rail.urdf"\n[bodies.two]\nurdf = "rail.urdf"\n'
    scene = urdf_of_text(tmp_path, head + bodies, "scene.toml")
    said = cli("run", scene, "--out", out).err
    assert said.count("ignored: <loop_joint> (2), <link.odd> (2); inspect lists all") == 1


def test_run_prints_one_json_object(scene, out, cli):
    printed = json.loads(cli("run", scene, "--out", out, "--json").out)
    assert printed["trajectory"] == str(out / "scene.npz")
    assert (printed["steps"], printed["variables"], printed["rows"]) == (5, 8, 10)
    assert (printed["backend"], printed["fast"]) == ("clarabel", False)
    assert 0 <= printed["worst_residual"] < MULTIPLIERS
    assert set(printed["milliseconds_per_step"]) == {
        "distances",
        "rows",
        "solve",
        "proof",
        "integrate",
        "record",
        "findings",
    }


def test_options_change_the_scenario(scene, out, cli):
    options = ["--backend", "osqp", "--certify", "off", "--set", "steps=2", "--set", "h=0.02"]
    printed = json.loads(cli("run", scene, "--out", out, "--json", *options).out)
    assert (printed["backend"], printed["steps"], printed["worst_residual"]) == ("osqp", 2, None)
    assert_same(load_trajectory(out / "scene.npz")["t"], [0.02, 0.04])


def test_an_interrupted_run_leaves_its_steps(scene, out, cli, monkeypatch):
    honest = Simulator.step
    calls = []

    def interrupted(*arguments, **options):
        calls.append(1)
        if len(calls) == 3:
            raise KeyboardInterrupt
        return honest(*arguments, **options)

    monkeypatch.setattr(Simulator, "step", interrupted)
    *_, last = cli("run", scene, "--out", out, status=130).err.splitlines()
    assert last.startswith("quasistatic-ref: step 2: interrupted; the first 2 steps")
    assert load_trajectory(out / "scene.npz").steps == 2


def test_quiet_leaves_nothing_on_a_terminal_s_standard_error(scene, tmp_path, monkeypatch, cli):
    class Terminal(io.StringIO):
        def isatty(self):
            return True

    for words, shown in (([], True), (["--quiet"], False)):
        terminal = Terminal()
        monkeypatch.setattr(sys, "stderr", terminal)
        cli("run", scene, "--out", tmp_path, *words)
        assert ("step/s" in terminal.getvalue()) is shown


def test_a_quiet_run_still_says_its_findings(tmp_path, cli):
    printed = cli("run", "block_push", "--fast", "--quiet", "--out", tmp_path).err
    assert printed.startswith("quasistatic-ref: note: ")
    assert printed.endswith("[artifact]\n")


NAMES = ("facets-6", "ellipsoid")


@pytest.mark.parametrize("name", NAMES)
def test_a_run_in_another_cone_can_be_replayed_from_its_file(name, scene, tmp_path, cli):
    said = json.loads(cli("run", scene, "--cone", name, "--out", tmp_path, "--json").out)
    trajectory = load_trajectory(tmp_path / "scene.npz")
    assert trajectory.header.cone == name
    step = trajectory.step_data(3)
    assert step.cone == name
    assert said["rows"] == int(step.offsets[-1]) == trajectory["lam"].shape[1]
    again = solve_step(step, "none")
    assert_same(again.delta_q, trajectory["delta_q"][3])
    out = tmp_path / "step.json"
    cli("extract", tmp_path / "scene.npz", "--step", "3", "-o", out)
    assert load_step(out) == step


def test_the_step_of_one_body_s_group_is_extracted_and_proved(scene, tmp_path, cli):
    """A plate on a rail is in the ball's group; a wheel on that rail is not."""
    cli("run", scene, "--fast", "--set", "steps=2", "--set", "record=full", "--out", tmp_path)
    path = tmp_path / "scene.npz"
    step = tmp_path / "step.json"
    answer = tmp_path / "answer.json"
    cli("extract", path, "--step", "1", "--body", "ball", "-o", step)
    part = load_step(step)
    whole = load_trajectory(path).step_data(1)
    assert (part.n_v, part.contacts.name) == (whole.n_v - 1, whole.contacts.name)
    cli("solve", step, "-o", answer)
    assert "verified" in cli("verify", step, answer).out
    asked = ("extract", path, "--step", "1")
    assert "did you mean 'ball'" in cli(*asked, "--body", "bal", status=2).err


def test_a_step_of_611_bodies_is_too_large_for_a_file(tmp_path, cli):
    """M_u alone has 3666^2 entries, each of 5 bytes or more: above 64 MiB."""
    balls = {f"b{i}": {"urdf": BALL, "base": "floating"} for i in range(611)}
    run = scene_of(balls, {}, 0, fast=True, record="light").run(findings=False)
    path = save_trajectory(tmp_path / "run.npz", run)
    said = cli("extract", path, "--step 0", status=2).err
    assert "is too large for a step file; extract the group of one body, with --body" in said
