"""The script by which bash completes commands, in bash itself."""

import shlex
import subprocess

import pytest

from quasistatic_ref.cli.main import COMMANDS, command_parser, main
from quasistatic_ref.formats.resources import scenario_names
from quasistatic_ref.lab.claims.registry import BY_NAME
from quasistatic_ref.lab.study.study_file import study_names
from quasistatic_ref.solve.backends import backend_names
from quasistatic_ref.step.cones import CONES, cone


@pytest.fixture(scope="module")
def script(tmp_path_factory):
    """The script as a user makes it."""
    path = tmp_path_factory.mktemp("script") / "completion.bash"
    with path.open("w") as file, pytest.MonkeyPatch.context() as patch:
        patch.setattr("sys.stdout", file)
        assert main(["completion", "bash"]) == 0
    return path


@pytest.fixture
def offered(script, tmp_path):
    """What bash offers in a folder with a few files for the last of some words."""
    for name in ("scene.toml", "notes.txt", "arm.urdf"):
        (tmp_path / name).touch()
    (tmp_path / "inner").mkdir()

    def complete(*words):
        line = f"""
            source {shlex.quote(str(script))}
            COMP_WORDS=({shlex.join(["quasistatic-ref", *words])}); COMP_CWORD={len(words)}
            function=$(complete -p quasistatic-ref); function=${{function##*-F }}
            ${{function% *}}
            printf "%s\\n" "${{COMPREPLY[@]}}"
        """
        done = subprocess.run(
            ["bash", "--norc", "-c", line], cwd=tmp_path, capture_output=True, text=True, check=True
        )
        assert done.stderr == ""
        return set(done.stdout.split())

    return complete


def test_every_command_is_offered(offered):
    assert offered("") >= set(COMMANDS)
    assert offered("ver") == {"verify"}


def test_scenarios_are_offered_by_name_and_files_of_theirs(offered):
    assert offered("run", "") == {*scenario_names(), "scene.toml", "inner"}
    assert offered("run", "block_") == {"block_incline", "block_push"}
    assert offered("inspect", "") == {*scenario_names(), "scene.toml", "arm.urdf", "inner"}
    assert offered("study", "run", "def") == {"default"}
    assert offered("study", "run", "") == {*study_names(), "scene.toml", "inner"}


def test_values_of_options_are_offered(offered):
    assert offered("run", "block_push", "--backend", "") == set(backend_names())
    assert offered("solve", "step.json", "--certify", "r") == {"residual"}
    cones = offered("run", "block_push", "--cone", "")
    assert len([cone(name) for name in cones]) == len(CONES)  # each is one that can be asked for
    assert offered("run", "block_push", "--out", "") == {"inner"}
    assert offered("validate", "") == {*BY_NAME, "reality"}
    assert offered("verify", "") == {"scene.toml", "notes.txt", "arm.urdf", "inner"}


def test_every_option_of_every_command_is_offered(offered):
    (commands,) = (a for a in command_parser(COMMANDS)._actions if a.dest == "command")
    for name, command in commands.choices.items():
        long = {word for action in command._actions for word in action.option_strings}
        assert offered(name, "--") == {word for word in long if word.startswith("--")}


@pytest.mark.parametrize("shell", ["zsh", "fish"])
def test_other_shells_get_the_same_words(capsys, shell):
    assert main(["completion", shell]) == 0
    script = capsys.readouterr().out
    assert all(word in script for word in (*COMMANDS, *scenario_names(), "resume", "daqp"))
