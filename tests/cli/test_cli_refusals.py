"""What commands refuse: one plain sentence on standard error, status 2, nothing half-written."""

import errno
import json
import os
import sys

import pytest

from quasistatic_ref.cli.main import main
from tests.helpers import one_sentence
from tests.scenes import PUSH, written_scenario

STEP = json.dumps({"format": "quasistatic-ref/step", "version": 1, "h": -1})
BAD = {
    "run nothing": (["run", "{}/none.toml"], "none.toml: no such file"),
    "run an unknown name": (["run", "bunny_gras"], "did you mean 'bunny_grasp'?"),
    "run a folder": (["run", "{}"], "cannot be read: Is a directory"),
    "run with a bad setting": (["run", "{}/scene.toml", "--set", "h"], "--set: must read"),
    "run with a bad value": (
        ["run", "{}/scene.toml", "--set", "h=-1"],
        "h: must be greater than 0",
    ),
    "run with a bad backend": (
        ["run", "{}/scene.toml", "--backend", "clarabell"],
        "did you mean 'clarabel'?",
    ),
    "run with a bad certificate": (
        ["run", "{}/scene.toml", "--certify", "ful"],
        "solver.certify: is not a choice",
    ),
    "run into a file": (["run", "{}/scene.toml", "--out", "{}/scene.toml"], "cannot be written"),
    "solve nothing": (["solve", "{}/none.json"], "none.json: no such file"),
    "solve what is not JSON": (["solve", "{}/scene.toml"], "is not JSON"),
    "solve a bad step": (
        ["solve", "{}/step.json"],
        "step.json: h: must be greater than 0 (got -1)",
    ),
    "extract from nothing": (["extract", "{}/none.npz", "--step", "0"], "no such file"),
    "extract from text": (["extract", "{}/scene.toml", "--step", "0"], "is not a trajectory"),
    "inspect nothing": (["inspect", "{}/none.urdf"], "none.urdf: no such file"),
    "inspect what is not XML": (["inspect", "{}/broken.urdf"], "broken.urdf"),
    "inspect an unknown name": (["inspect", "sphere"], "is neither a file nor a scenario"),
}


@pytest.mark.parametrize(("arguments", "says"), BAD.values(), ids=BAD)
def test_bad_input_is_one_plain_sentence_and_status_2(
    tmp_path, monkeypatch, capsys, arguments, says
):
    monkeypatch.chdir(tmp_path)
    written_scenario(tmp_path)
    (tmp_path / "step.json").write_text(STEP)
    (tmp_path / "broken.urdf").write_text("<robot")
    assert main([argument.replace("{}", str(tmp_path)) for argument in arguments]) == 2
    captured = capsys.readouterr()
    assert captured.out == ""
    assert says in one_sentence(captured.err)


@pytest.mark.parametrize("k", ["-1", "5", "99999"])
def test_a_step_that_a_run_does_not_have_is_bad_input(scene, out, capsys, k):
    main(["run", scene, "--out", str(out)])
    capsys.readouterr()
    assert main(["extract", str(out / "scene.npz"), "--step", k]) == 2
    said = one_sentence(capsys.readouterr().err)
    assert said == f"{out / 'scene.npz'}: step: must be 0 to 4 (got {k})"


def test_a_backend_that_does_not_exist_leaves_no_trajectory(scene, out, capsys):
    assert main(["run", scene, "--out", str(out), "--backend", "clarabell"]) == 2
    assert not out.exists()


def test_a_matrix_that_is_no_stiffness_is_refused_before_the_run(tmp_path, out, capsys):
    text = PUSH.replace("slide = 500", "slide = [[-500]]")
    path = written_scenario(tmp_path, text)
    assert main(["run", str(path), "--out", str(out)]) == 2
    assert "K_q" in capsys.readouterr().err
    assert not out.exists()


def test_only_the_first_word_is_a_command(scene, tmp_path, monkeypatch):
    """A folder called bench is a folder: the module of that command is not even imported."""
    monkeypatch.setitem(sys.modules, "quasistatic_ref.lab.commands.bench", None)
    monkeypatch.chdir(tmp_path)
    assert main(["run", scene, "--out", "bench"]) == 0
    assert (tmp_path / "bench" / "scene.npz").is_file()


def test_an_unusable_file_is_named_and_is_not_standard_output(monkeypatch, capsys):
    def full(options):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC), "study.sqlite")

    monkeypatch.setattr("quasistatic_ref.cli.backends.run", full)
    assert main(["backends"]) == 2
    printed = capsys.readouterr().err
    assert printed == "quasistatic-ref: study.sqlite: cannot be used: No space left on device\n"
