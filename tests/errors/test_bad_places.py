"""Paths that leave their folder, words of a command that do not fit, outputs that have no place."""

import re
import shlex
import sys
import tomllib

import pytest

from quasistatic_ref import InputError, Scenario, load_scenario, save_step
from tests.cases import refusal
from tests.errors.scene import SCENE, changed, scene_written
from tests.files.urdf.urdf_texts import urdf_of_text
from tests.helpers import planted_step
from tests.scenes import BALL


@pytest.fixture
def inner(tmp_path, monkeypatch):
    """The working folder, for a scenario, with a good URDF, cloud and mesh next to it."""
    for name, text in (("outside.urdf", BALL), ("outside.xyz", "0 0 0\n"), ("outside.obj", "")):
        urdf_of_text(tmp_path, text, name)
    (tmp_path / "inner" / "sub").mkdir(parents=True)
    (tmp_path / "inner" / "link.urdf").symlink_to("../outside.urdf")
    monkeypatch.chdir(tmp_path / "inner")
    return tmp_path / "inner"


MOVE = (
    ": is outside the scenario's folder; move the file there, or give the path on the command line,"
    " as --set {}=PATH (got "
)
NAME = ": is outside the scenario's folder; name it on the command line, as --root FOLDER"
PLACES = [
    ("bodies/ball/urdf", "../outside.urdf", MOVE),
    ("bodies/ball/urdf", "ABOVE/outside.urdf", MOVE),
    ("bodies/ball/urdf", "/etc/passwd", MOVE),
    ("bodies/ball/urdf", "link.urdf", MOVE),
    ("bodies/ball/urdf", "a\0b", ": cannot be a path"),
    ("bodies/ball/cloud", "../outside.xyz", MOVE),
    ("bodies/ball/cloud", "ABOVE/outside.xyz", MOVE),
    ("shapes/wall", {"mesh": {"file": "../outside.obj"}}, ".mesh.file: leads to "),
    ("shapes/wall", {"mesh": {"file": "ABOVE/outside.obj"}}, ".mesh.file: leads to "),
    ("roots", [".."], NAME),
    ("roots", ["ball.urdf"], ": is no folder"),
    ("bodies/ball/package_dirs", [".."], NAME),
    ("bodies/ball/package_dirs", ["ball.urdf"], ": is no folder"),
]
"""A field, a path of it, in which ABOVE is the folder above, and the words that refuse it."""


@pytest.mark.parametrize(("field", "value", "words"), PLACES)
def test_a_path_in_a_scenario_stays_in_its_folder(inner, refused, field, value, words):
    """So does one in a table that others wrote, of which the folder is the working folder."""
    path = scene_written(inner, changed(SCENE, (field, value)))
    path.write_text(path.read_text().replace("ABOVE", str(inner.parent)))
    name = field.replace("/", ".")
    sentence = refused("inspect", path)
    assert sentence.startswith(f"{path}: {name}{words.format(name)}")
    with refusal(InputError, sentence.removeprefix(f"{path}: ")):
        load_scenario(tomllib.loads(path.read_text()), of_others=True)


@pytest.mark.parametrize("value", ["ball.urdf", "./ball.urdf", "sub/../ball.urdf", "{}/ball.urdf"])
def test_a_path_that_comes_back_is_good(inner, value, cli):
    scene = changed(SCENE, ("bodies/ball/urdf", value.replace("{}", str(inner))))
    cli("inspect", scene_written(inner, scene))
    assert load_scenario(scene, of_others=True).steps == SCENE["steps"]


@pytest.mark.parametrize("value", ["../outside.urdf", "{}/outside.urdf"])
def test_a_path_of_the_user_leads_anywhere(inner, value, cli):
    """On the command line, and in tables of others where the user names its folder."""
    value = value.replace("{}", str(inner.parent))
    cli("inspect", scene_written(inner), "--set", shlex.quote(f"bodies.ball.urdf={value}"))
    scene = changed(SCENE, ("bodies/ball/urdf", value))
    load_scenario(scene, {"roots": [str(inner.parent)]}, of_others=True)


@pytest.fixture
def here(tmp_path, monkeypatch):
    """The working folder, with a scenario, a step, and what is in the way of others; no run."""

    def run(scenario, progress=True):
        raise AssertionError("work was done before all words were looked at")

    monkeypatch.setattr(Scenario, "run", run)
    monkeypatch.chdir(tmp_path)
    scene_written(tmp_path)
    save_step("step.json", planted_step(0)[0])
    (tmp_path / "file").touch()
    (tmp_path / "folder").mkdir()
    (tmp_path / "circle").symlink_to("circle")


QUOTED = r'"\"".' * 1200
"""Parts of a key."""
RUN, SOLVE = "run scene.toml", "solve step.json"
REFUSED = {
    (RUN,): {
        "--set h.x=1": "--set h.x=1: is not a table",
        "--set bodies.rail.targets.0.t=1": r"--set bodies\.rail\.targets\.0\.t=1: is not a table",
        f"--set {'a.' * 5000}b=1": r"--set .*: is a key of 5001 parts; .* none of more than 10$",
        f"--set 'gravity={{{QUOTED}a = 1}}'": "--set gravity=.*: must be 3 numbers",
        "--set 'h=0.01\nsteps=9'": r"--set h=0\.01\\nsteps=9: must be a number$",
        "--set h=-1": "--set h=-1: must be greater than 0$",
        f"--set h={'1' * 5000}": r"--set h=1+\.\.\.1+: must be a number$",
        f"--set h={'[' * 5000}": r"--set h=\[+\.\.\.\[+: must be a number$",
        f"--set h=0x{'f' * 5000}": r"--set h=0xf+\.\.\.f+: must be at most 1e\+15$",
        "--set 'gravity=[0, 0'": r"--set gravity=\[0, 0: must be 3 numbers, with commas between",
        "--set bodies.ball=3": r"--set bodies\.ball=3: must be a table of named fields$",
        """--set "contacts.floor={alpha='floor', beta='ball', mu_v='x'}" """: (
            "--set contacts.*'x'}: mu_v: must be a number$"
        ),
        "--law newton": "--law newton: is not a choice",
        "--root 'no folder'": "--root 'no folder': is no folder$",
    },
    (RUN, SOLVE): {
        "--cone round": "--cone round: must be one of pyramid",
        "--certify yes": "--certify yes: (is not a choice; known|must be one of)",
        "--backend clarable": "--backend clarable: is not a backend; did you mean 'clarabel'",
        "--backend ''": "--backend '': is not a backend; known: ",
        "--backend 'a\nb'": r"--backend 'a\\nb': is not a backend; known: ",
        "--backend qpsolvers:": "--backend qpsolvers:: is not a backend; .* known: ",
    },
    ("run",): {
        "bunny_gras": "bunny_gras: is neither .* installed scenario; did you mean 'bunny_grasp'",
        "a" * 5000: r"a+\.\.\.a+: is neither a file nor an installed scenario",
        "'\0'": r"\\x00: is neither a file nor an installed scenario",
        "''": r"\.: cannot be read: Is a directory",
        "' '": " : is neither a file nor an installed scenario",
    },
    (RUN, "demo"): {
        "--out file/out": "file/out: cannot be written: Not a directory; choose another folder$",
        "--out scene.toml": r"scene\.toml: cannot be written: File exists; choose another folder$",
        f"--out {'a' * 5000}": r"a+\.\.\.a+: cannot be written: File name too long; choose another",
        "--out 'a\0b'": r"a\\x00b: cannot be written: .*null.*; choose another folder$",
        "--out circle": "circle: cannot be written: .*; choose another folder$",
    },
    (SOLVE,): {
        "-o /dev/full": "/dev/full: cannot be written: ",
        "-o file/x.json": r"file/x\.json: cannot be written: ",
        "-o .": r"\.: cannot be written: ",
        "-o 'a\0b'": r"a\\x00b: cannot be written: ",
        "-o ''": r"\.: cannot be written: ",
        "-o folder/": "folder: cannot be written: ",
    },
}
"""Commands, words that do not fit them, and how the sentence begins."""
LINES = {
    f"{command} {words}": begins
    for commands, table in REFUSED.items()
    for command in commands
    for words, begins in table.items()
}


@pytest.mark.usefixtures("here")
@pytest.mark.parametrize(("line", "begins"), LINES.items())
def test_a_word_that_does_not_fit_is_named_and_no_file_is_blamed(refused, line, begins):
    assert re.match(begins, refused(*shlex.split(line)))


def test_standard_output_that_is_full_is_one_sentence(monkeypatch, cli):
    with open("/dev/full", "w") as full:  # closed, it does not write again
        monkeypatch.setattr(sys, "stdout", full)
        printed = cli("backends", status=2)
    assert printed.err == (
        "quasistatic-ref: standard output: cannot be written: No space left on device\n"
    )


@pytest.mark.parametrize("stream", ["stdout", "stderr"])
def test_a_closed_stream_takes_what_is_printed_without_a_traceback(monkeypatch, cli, stream):
    """As the shell does by >&- or 2>&-: Python then has no such stream at all."""
    monkeypatch.setattr(sys, stream, None)
    printed = cli("backends")
    getattr(sys, stream).close()
    assert printed.err == ""
    assert printed.out == "" or stream == "stderr"
