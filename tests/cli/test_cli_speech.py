"""What commands print: help without heavy imports, lines that fit, nothing when quiet."""

import io
import json
import subprocess
import sys

import numpy as np
import pytest

from quasistatic_ref.cli.main import COMMANDS, main
from quasistatic_ref.cli.options import WIDTH
from quasistatic_ref.formats.resources import scenario_names
from tests.model.urdf.urdf_texts import inertial, joint, link, robot, written
from tests.tolerances import ROUNDING


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
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stderr == "loaded: []\n"
    assert done.stdout


@pytest.mark.parametrize("name", scenario_names())
def test_what_is_inspected_fits_a_terminal(name, capsys):
    assert main(["inspect", name]) == 0
    assert max(map(len, capsys.readouterr().out.splitlines())) <= WIDTH


def test_inspect_names_links_that_nothing_can_touch(tmp_path, capsys):
    visual = "<visual><geometry><sphere radius='1'/></geometry></visual>"
    text = robot(link("a", visual), link("b"), joint("j", "a", "b"))
    assert main(["inspect", str(written(tmp_path, text, "one.urdf"))]) == 0
    assert "- one: links with visual but no collision geometry: a\n" in capsys.readouterr().out


TURNED = inertial(
    moments=("0.1", "0.2", "0.25"),
    origin='<origin xyz="0.5 0.25 0.125" rpy="0 0 1.5707963267948966"/>',
)


def test_inspect_shows_inertias_along_the_axes_of_their_link(tmp_path, capsys):
    """A quarter turn about z: ixx along the frame of the inertia is iyy along the link's."""
    path = str(written(tmp_path, robot(link("a", inertial=TURNED)), "one.urdf"))
    assert main(["inspect", path, "--json"]) == 0
    (found,) = json.loads(capsys.readouterr().out)["links"]
    assert found["centre"] == [0.5, 0.25, 0.125]
    assert np.diag(found["inertia"]) == pytest.approx([0.2, 0.1, 0.25], abs=ROUNDING)
    assert main(["inspect", path]) == 0
    out = capsys.readouterr().out
    assert "inertias: about the centre of mass, along the link's axes" in out
    assert "0.5 0.25 0.125" in out


@pytest.mark.parametrize(
    "words",
    [[name] for name in COMMANDS if name not in ("study", "vectors")]
    + [["study", "report"], ["study", "pack"], ["study", "export"]]
    + [["vectors", name] for name in ("check", "report", "pack", "challenge")],
    ids=" ".join,
)
def test_every_command_takes_quiet(words, capsys):
    with pytest.raises(SystemExit):
        main([*words, "--help"])
    assert "--quiet" in capsys.readouterr().out


def test_quiet_leaves_nothing_on_a_terminal_s_standard_error(scene, tmp_path, monkeypatch):
    class Terminal(io.StringIO):
        def isatty(self):
            return True

    for words, shown in (([], True), (["--quiet"], False)):
        terminal = Terminal()
        monkeypatch.setattr(sys, "stderr", terminal)
        assert main(["run", scene, "--out", str(tmp_path), *words]) == 0
        assert ("step/s" in terminal.getvalue()) is shown


@pytest.mark.parametrize(
    "words", [["figures", "cone_surfaces"], ["validate", "incline_sliding"]], ids=lambda w: w[0]
)
def test_quiet_is_taken_by_whatever_says_what_it_does(words, tmp_path, capsys):
    for more, shown in (([], True), (["--quiet"], False)):
        assert main([*words, "--out", str(tmp_path), *more]) == 0
        assert (f"{words[1]} ..." in capsys.readouterr().err) is shown


def test_a_quiet_run_still_says_what_it_warns_of(tmp_path, capsys):
    assert main(["run", "block_incline", "--fast", "--quiet", "--out", str(tmp_path)]) == 0
    warned = capsys.readouterr().err
    assert warned.startswith("quasistatic-ref: the spurious drag")
    assert (
        main(["run", "block_incline", "--fast", "--quiet", "--strict", "--out", str(tmp_path)]) == 1
    )
