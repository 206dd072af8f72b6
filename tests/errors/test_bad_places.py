"""Paths that leave their folder, settings of no meaning, and outputs that cannot be written."""

import sys

import pytest

from quasistatic_ref import save_step
from quasistatic_ref.cli.main import main
from quasistatic_ref.text.quoting import clipped
from tests.cases import cases
from tests.errors.scene import SCENE, changed, scene_written
from tests.files.urdf.urdf_texts import urdf_of_text
from tests.helpers import planted_step
from tests.scenes import BALL

LEAVES = "is outside the scenario's folder; move the file there, or give the path on the command"


@pytest.fixture
def outside(tmp_path):
    """A scenario in a folder of its own, and a good URDF and cloud next to that folder."""
    urdf_of_text(tmp_path, BALL, "outside.urdf")
    urdf_of_text(tmp_path, "0 0 0\n", "outside.xyz")
    (tmp_path / "inner").mkdir()
    return tmp_path / "inner"


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("urdf", "../outside.urdf"),
        ("urdf", "{}/outside.urdf"),
        ("urdf", "/etc/passwd"),
        ("urdf", "link.urdf"),
        ("cloud", "../outside.xyz"),
    ],
)
def test_a_path_in_a_scenario_stays_in_its_folder(outside, refused, tmp_path, field, value):
    value = value.replace("{}", str(tmp_path))
    path = scene_written(outside, changed(SCENE, (f"bodies/ball/{field}", value)))
    (outside / "link.urdf").symlink_to("../outside.urdf")
    sentence = refused("inspect", path)
    assert sentence.startswith(f"{path}: bodies.ball.{field}: {LEAVES}")
    assert f"--set bodies.ball.{field}=PATH (got '{value[:60]}" in sentence  # long ones are cut


@pytest.mark.parametrize("field", ["roots", "bodies/ball/package_dirs"])
def test_a_scenario_names_folders_inside_of_its_own(outside, refused, field):
    name = field.replace("/", ".")
    path = scene_written(outside, changed(SCENE, (field, [".."])))
    leaves = f"{name}: is outside the scenario's folder; name it on the command line, as --root"
    assert leaves in refused("inspect", path)
    path = scene_written(outside, changed(SCENE, (field, ["ball.urdf"])))
    assert f"{name}: is no folder" in refused("inspect", path)


@pytest.mark.parametrize("value", ["ball.urdf", "./ball.urdf", "sub/../ball.urdf", "{}/ball.urdf"])
def test_a_path_that_comes_back_is_good(outside, value, cli):
    (outside / "sub").mkdir()
    scene = changed(SCENE, ("bodies/ball/urdf", value.replace("{}", str(outside))))
    cli("inspect", scene_written(outside, scene))


@pytest.mark.parametrize("value", ["../outside.urdf", "{}/outside.urdf"])
def test_a_path_on_the_command_line_leads_anywhere(outside, tmp_path, value, cli):
    setting = f"bodies.ball.urdf={value.replace('{}', str(tmp_path))}"
    cli("inspect", scene_written(outside), "--set", setting)


def test_a_path_with_a_nul_character_is_none(tmp_path, refused):
    path = scene_written(tmp_path, changed(SCENE, ("bodies/ball/urdf", "a\0b")))
    assert refused("inspect", path).startswith(f"{path}: bodies.ball.urdf: cannot be a path")


SETTINGS = {
    "h.x=1": "--set h.x=1: is not a table",
    "bodies.rail.targets.0.t=1": "--set bodies.rail.targets.0.t=1: is not a table",
    "a." * 5000 + "b=1": ": is a key of 5001 parts; a scenario has none of more than 10",
    "h=0.01\nsteps=9": r"--set h=0.01\nsteps=9: must be a number",
    "h=-1": "--set h=-1: must be greater than 0",
    "h=" + "1" * 5000: "1: must be a number",
    "h=" + "[" * 5000: "[: must be a number",
    "h=" + "0x" + "f" * 5000: "f: must be at most 1e+15",
    "gravity=[0, 0": "--set gravity=[0, 0: must be 3 numbers, with commas between them and",
    "bodies.ball=3": "--set bodies.ball=3: must be a table of named fields",
    "contacts.floor={alpha='floor', beta='ball', mu_v='x'}": "mu_v='x'}: mu_v: must be a number",
}


@pytest.mark.parametrize("setting", SETTINGS)
def test_a_setting_that_does_not_fit_is_refused(tmp_path, refused, setting):
    path = scene_written(tmp_path)
    sentence = refused("run", path, "--set", setting, "--out", tmp_path / "out")
    assert sentence.startswith("--set ")
    assert SETTINGS[setting] in sentence


OPTIONS = {
    ("--cone", "round"): "--cone round: must be one of pyramid",
    ("--certify", "yes"): "--certify yes: is not a choice",
    ("--law", "newton"): "--law newton: is not a choice",
    ("--root", "no folder"): "--root 'no folder': is no folder",
}


@pytest.mark.parametrize("option", OPTIONS)
def test_an_option_that_does_not_fit_is_named_and_no_file_is_blamed(tmp_path, refused, option):
    path = scene_written(tmp_path)
    assert refused("run", path, *option, "--out", tmp_path / "out").startswith(OPTIONS[option])


@pytest.mark.parametrize(
    "option", [("--cone", "round"), ("--certify", "yes"), ("--backend", "clarable")]
)
def test_an_option_of_solve_is_named_and_the_step_is_not_blamed(tmp_path, refused, option):
    save_step(tmp_path / "step.json", planted_step(0)[0])
    assert refused("solve", tmp_path / "step.json", *option).startswith(f"{' '.join(option)}: ")


@pytest.mark.parametrize("name", ["clarable", "", "a\nb", "qpsolvers:"])
@pytest.mark.parametrize("command", ["run", "solve"])
def test_an_unknown_backend_is_refused_before_anything_is_done(tmp_path, refused, name, command):
    path = scene_written(tmp_path)
    save_step(tmp_path / "step.json", planted_step(0)[0])
    where = ["--out", tmp_path / "out"]
    arguments = [path, *where] if command == "run" else [tmp_path / "step.json"]
    sentence = refused(command, *arguments, "--backend", name)
    assert "backend: is not a backend" in sentence or sentence.startswith("--backend ")
    assert "known: " in sentence
    assert "did you mean 'clarabel'" in sentence or name != "clarable"


@pytest.mark.parametrize("name", ["bunny_gras", "a" * 5000, "\x00", "", " "])
def test_a_scenario_that_does_not_exist_is_refused(refused, name):
    sentence = refused("run", name)
    assert "is neither a file nor an installed scenario" in sentence or "cannot be read" in sentence
    assert "did you mean 'bunny_grasp'" in sentence or name != "bunny_gras"


def in_the_way(folder):
    (folder / "file").write_text("not a folder")
    return folder / "file" / "out"


def circle(folder):
    (folder / "out").symlink_to(folder / "out")
    return folder / "out"


FOLDERS = {
    "a file in the way": (in_the_way, "Not a directory"),
    "a file": (lambda folder: folder / "scene.toml", "File exists"),
    "a name too long": (lambda folder: folder / ("a" * 5000), "File name too long"),
    "a NUL character": (lambda folder: f"{folder}/a\0b", "null"),
    "links in a circle": (circle, ""),
}


@cases("folder, words", FOLDERS)
@pytest.mark.parametrize("command", ["run", "demo"])
def test_a_folder_that_cannot_be_written_to_is_known_before_the_run(
    tmp_path, refused, monkeypatch, folder, words, command
):
    from quasistatic_ref import Scenario

    def run(scenario, progress=True):
        raise AssertionError("work was done before the folder was looked at")

    monkeypatch.setattr(Scenario, "run", run)
    scene = scene_written(tmp_path)
    path = folder(tmp_path)
    sentence = refused(command, *([scene] if command == "run" else []), "--out", path)
    shown = clipped(str(path)).replace("\0", "\\x00")
    assert sentence.startswith(f"{shown}: cannot be written: ")
    assert words in sentence
    assert sentence.endswith("; choose another folder")


@pytest.mark.parametrize("path", ["/dev/full", "{}/file/x.json", "{}", "{}/a\0b", "", "{}/x/"])
def test_a_step_that_cannot_be_written_is_refused(tmp_path, refused, path):
    step = save_step(tmp_path / "step.json", planted_step(0)[0])
    in_the_way(tmp_path)
    (tmp_path / "x").mkdir()
    assert "cannot be written: " in refused("solve", step, "-o", path.replace("{}", str(tmp_path)))


def test_standard_output_that_is_full_is_one_sentence(monkeypatch, capsys):
    with open("/dev/full", "w") as full:  # closed, it does not write again
        monkeypatch.setattr(sys, "stdout", full)
        assert main(["backends"]) == 2
    assert capsys.readouterr().err == (
        "quasistatic-ref: standard output: cannot be written: No space left on device\n"
    )


@pytest.mark.parametrize("stream", ["stdout", "stderr"])
def test_a_closed_stream_takes_what_is_printed_without_a_traceback(monkeypatch, capsys, stream):
    """As the shell does by >&- or 2>&-: Python then has no such stream at all."""
    monkeypatch.setattr(sys, stream, None)
    assert main(["backends"]) == 0
    getattr(sys, stream).close()
    printed = capsys.readouterr()
    assert printed.err == ""
    assert printed.out == "" or stream == "stderr"
