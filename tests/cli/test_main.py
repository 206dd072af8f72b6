"""The command line as a whole: help without heavy imports, quiet, interrupts, refusals."""

import errno
import json
import os
import sys

import pytest

from quasistatic_ref.cli.main import COMMANDS, main
from tests.helpers import one_sentence
from tests.processes import python

USAGE = {
    "": "the following arguments are required: COMMAND",
    "rnu": "invalid choice: 'rnu'; did you mean 'run'? known: backends",
    "run x.toml --bakend osqp": "did you mean '--backend'?",
    "run x.toml contacts.a.k=3": "did you mean '--set contacts.a.k=3'?",
    "run x.toml --slow": "usage: quasistatic-ref run ",
    "run x.toml --steps 5": "did you mean '--set steps=5'?",
    "extract x.npz --step 0 --out s.json": "did you mean '-o'?",
    "vectors check x --jsn": "did you mean '--json'?",
    "extract x.npz --step first": "--step: invalid int value: 'first'",
}


@pytest.mark.parametrize("line", USAGE)
def test_wrong_usage_is_status_2(capsys, line):
    with pytest.raises(SystemExit) as caught:
        main(line.split())
    assert caught.value.code == 2
    assert USAGE[line] in capsys.readouterr().err


def test_backends_lists_what_is_installed(cli):
    printed = json.loads(cli("backends", "--json").out)
    assert (printed["default"], printed["default_of_fast"]) == ("clarabel", "daqp")
    assert {"clarabel", "osqp", "piqp", "daqp"} <= set(printed["installed"])
    page = cli("backends").out
    assert "daqp (default with --fast)" in page
    assert "clarabel (default)" in page


def test_figures_are_made_by_name(out, capsys, cli):
    assert main(["figures", "a_screw", "--out", str(out)]) == 0
    paths = [out / "a_screw.png", out / "a_screw.pdf"]
    assert capsys.readouterr().out.splitlines() == [str(path) for path in paths]
    assert all(path.stat().st_size > 1000 for path in paths)
    paper = paths[0].read_bytes()
    cli("figures a_screw --style slides --out", out)
    assert paths[0].read_bytes() != paper
    assert "did you mean 'slides'?" in cli("figures --style slide --out", out, status=2).err
    assert "did you mean 'a_screw'?" in one_sentence(
        cli("figures", "a_scre", "--out", out, status=2).err
    )


@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_has_help(capsys, monkeypatch, command):
    """Its first sentence is the command's line of the list, names such as URDF as they are."""
    monkeypatch.setenv("COLUMNS", "200")  # no line of it is wrapped
    words = COMMANDS[command]
    with pytest.raises(SystemExit) as caught:
        main([command, "--help"])
    assert caught.value.code == 0
    said = capsys.readouterr().out
    assert f"usage: quasistatic-ref {command}" in said
    assert f"\n{words[0].upper()}{words[1:]}.\n" in said


HEAVY = ("cvxpy", "pinocchio", "coal", "matplotlib", "scipy", "qpsolvers")


@pytest.mark.parametrize("arguments", [["--help"], ["--version"]])
def test_help_does_not_pay_for_heavy_imports(arguments):
    code = (
        "import sys\n"
        "from quasistatic_ref.cli.main import main\n"
        "try:\n"
        f"    main({arguments!r})\n"
        "finally:\n"
        f"    loaded = [name for name in {HEAVY!r} if name in sys.modules]\n"
        "    print('loaded:', loaded, file=sys.stderr)\n"
    )
    done = python("-c", code)
    assert done.stderr == "loaded: []\n"
    assert done.stdout


@pytest.mark.parametrize("package", ["numpy", "datetime", "quasistatic_ref.cli.verify"])
def test_ctrl_c_while_packages_are_imported_is_one_sentence(package):
    """NumPy's C code imports datetime, and makes an ImportError of any exception in it."""
    code = (
        "import os, signal, sys\n"
        "signal.signal(signal.SIGINT, signal.default_int_handler)\n"  # ignored in the background
        "class Interrupter:\n"
        "    def find_spec(self, name, *_):\n"
        f"        if name == {package!r}:\n"
        "            os.kill(os.getpid(), signal.SIGINT)\n"
        "sys.modules.pop('datetime', None)\n"
        "sys.meta_path.insert(0, Interrupter())\n"
        "import runpy\n"
        "sys.argv = ['quasistatic-ref', 'verify', 'no.json', 'no.json']\n"
        "runpy.run_module('quasistatic_ref', run_name='__main__')\n"
    )
    assert python("-c", code, status=130).stderr == "quasistatic-ref: interrupted\n"


def test_only_the_first_word_is_a_command(scene, tmp_path, monkeypatch, cli):
    """A folder called bench is a folder: the module of that command is not even imported."""
    monkeypatch.setitem(sys.modules, "quasistatic_ref.lab.commands.bench", None)
    monkeypatch.chdir(tmp_path)
    cli("run", scene, "--out", "bench")
    assert (tmp_path / "bench" / "scene.npz").is_file()


NO_LIBRARY = "libgomp.so.1: cannot open shared object file: No such file or directory"
FAILURES = {
    "interrupted": KeyboardInterrupt(),
    "study.sqlite: cannot be used: No space left on device": (
        OSError(errno.ENOSPC, os.strerror(errno.ENOSPC), "study.sqlite")
    ),
    "libgomp.so.1, which a package needs, is not installed on this system; "
    "libgomp.so.1 comes by: apt-get install libgomp1": ImportError(NO_LIBRARY),
}


@pytest.mark.parametrize("sentence", FAILURES)
def test_any_command_fails_in_one_sentence(monkeypatch, cli, sentence):
    def failing(options):
        raise FAILURES[sentence]

    monkeypatch.setattr("quasistatic_ref.cli.backends.run", failing)
    printed = cli("backends", status=130 if sentence == "interrupted" else 2)
    assert printed.err == f"quasistatic-ref: {sentence}\n"
