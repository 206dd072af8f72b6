"""The command line, in this process: exit statuses, plain sentences on failure, JSON."""

import errno
import io
import json
import os
import subprocess
import sys

import numpy as np
import pytest

from quasistatic_ref.cli import solve as solve_command
from quasistatic_ref.cli.main import COMMANDS, main
from quasistatic_ref.cli.options import WIDTH
from quasistatic_ref.resources import scenario_names
from quasistatic_ref.simulate import simulator
from quasistatic_ref.simulate.trajectory import trajectory_read
from quasistatic_ref.step.files import step_read, step_sha256, step_written
from tests.helpers import point_on_floor
from tests.scenes import PUSH, RAIL, SWING, written_scenario
from tests.tolerances import EXACT, MULTIPLIERS, ROUNDING
from tests.unit.urdf_texts import CHAIN, written


@pytest.fixture
def scene(tmp_path):
    return str(written_scenario(tmp_path))


@pytest.fixture
def swing(tmp_path):
    return str(written_scenario(tmp_path, SWING, "swing.toml"))


@pytest.fixture
def out(tmp_path):
    return tmp_path / "out"


def one_sentence(errors):
    """The one line on standard error, without the program's name."""
    lines = errors.splitlines()
    assert len(lines) == 1, errors
    assert lines[0].startswith("quasistatic-ref: ")
    assert "Traceback" not in errors
    return lines[0].removeprefix("quasistatic-ref: ")


def test_run_writes_the_trajectory_and_tells_of_it(scene, out, capsys):
    assert main(["run", scene, "--out", str(out)]) == 0
    told = capsys.readouterr().out
    assert told.startswith(
        "5 steps of 8 variables x 10 rows\n5 of 5 steps exact; backend daqp (native), "
    )
    assert told.endswith(f"wrote {out / 'scene.npz'}\n")
    assert trajectory_read(out / "scene.npz").steps == 5


def test_run_prints_one_json_object(scene, out, capsys):
    assert main(["run", scene, "--out", str(out), "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert told["trajectory"] == str(out / "scene.npz")
    assert (told["steps"], told["variables"], told["rows"]) == (5, 8, 10)
    assert told["backend"] == "daqp"
    assert 0 <= told["worst_residual"] < MULTIPLIERS
    assert set(told["milliseconds_per_step"]) == {"distances", "rows", "solve", "integrate"}


def test_run_finds_the_scenarios_that_come_along(out, capsys):
    arguments = ["run", "sphere_spin", "--set", "steps=2", "--out", str(out), "--json"]
    assert main(arguments) == 0
    assert json.loads(capsys.readouterr().out)["steps"] == 2


def test_options_change_the_scenario(scene, out, capsys):
    options = ["--backend", "osqp", "--certify", "off", "--set", "steps=2", "--set", "h=0.02"]
    assert main(["run", scene, "--out", str(out), "--json", *options]) == 0
    told = json.loads(capsys.readouterr().out)
    assert (told["backend"], told["steps"], told["worst_residual"]) == ("osqp", 2, None)
    np.testing.assert_allclose(trajectory_read(out / "scene.npz")["t"], [0.02, 0.04], rtol=EXACT)


def test_an_uncertified_run_says_so(scene, out, capsys):
    assert main(["run", scene, "--out", str(out), "--certify", "off"]) == 0
    assert "worst residual not computed" in capsys.readouterr().out


def test_a_run_of_no_steps_is_good(scene, out, capsys):
    assert main(["run", scene, "--out", str(out), "--set", "steps=0"]) == 0
    assert capsys.readouterr().out.startswith("0 steps of 8 variables x 0 rows")


def test_a_run_that_fails_leaves_its_steps_and_the_one_that_failed(swing, out, capsys):
    assert main(["run", swing, "--out", str(out)]) == 3
    captured = capsys.readouterr()
    assert captured.out == ""
    *warned, said = [line.removeprefix("quasistatic-ref: ") for line in captured.err.splitlines()]
    assert said.startswith("step 3: the step has no solution: floor(floor, post/club#0)/0 ")
    step_file = out / "swing_failed_step.json"
    assert f"the first 3 steps are in {out / 'swing.npz'}" in said
    assert f"the failing step in {step_file}" in said
    trajectory = trajectory_read(out / "swing.npz")
    assert trajectory.steps == 3
    assert trajectory.failed is not None
    assert warned == list(trajectory.warnings)
    assert "turns by 270 degrees, in step 2" in warned[0]
    assert main(["run", swing, "--out", str(out), "--quiet"]) == 3
    assert capsys.readouterr().err == captured.err
    np.testing.assert_allclose(step_read(step_file).contacts.phi, [-0.11], rtol=MULTIPLIERS)
    assert main(["solve", str(step_file)]) == 3  # replayed by itself, it fails again
    assert one_sentence(capsys.readouterr().err).startswith("the step has no solution")


def test_an_interrupted_run_leaves_its_steps(scene, out, capsys, monkeypatch):
    honest, calls = simulator.Simulator.step, []

    def interrupted(*arguments, **options):
        calls.append(1)
        if len(calls) == 3:
            raise KeyboardInterrupt
        return honest(*arguments, **options)

    monkeypatch.setattr(simulator.Simulator, "step", interrupted)
    assert main(["run", scene, "--out", str(out)]) == 130
    assert one_sentence(capsys.readouterr().err).startswith(
        "step 2: interrupted; the first 2 steps"
    )
    assert trajectory_read(out / "scene.npz").steps == 2


def test_any_command_can_be_interrupted(tmp_path, capsys, monkeypatch):
    def interrupted(*arguments, **options):
        raise KeyboardInterrupt

    monkeypatch.setattr(solve_command, "solve_step", interrupted)
    path = step_written(tmp_path / "step.json", point_on_floor())
    assert main(["solve", str(path)]) == 130
    assert one_sentence(capsys.readouterr().err) == "interrupted"


def test_a_step_taken_from_a_run_solves_to_what_the_run_did(scene, out, capsys):
    assert main(["run", scene, "--out", str(out)]) == 0
    capsys.readouterr()  # the ball moves fast, of which the run warns
    step, solution = out / "step.json", out / "solution.json"
    assert main(["extract", str(out / "scene.npz"), "--step", "4", "-o", str(step)]) == 0
    assert main(["solve", str(step), "-o", str(solution)]) == 0
    told = capsys.readouterr()
    assert told.err.startswith("exact: the optimum of the step, correctly rounded; ")
    read, run = json.loads(solution.read_text()), trajectory_read(out / "scene.npz")
    np.testing.assert_allclose(read["delta_q"], run["delta_q"][4], rtol=EXACT, atol=EXACT)
    # lam itself is not unique; A'lam is.
    A, lam = run["A"][4], np.concatenate(read["lam"])
    np.testing.assert_allclose(A.T @ lam, A.T @ run["lam"][4], rtol=ROUNDING, atol=0.0)
    assert read["step_sha256"] == step_sha256(run.step_data(4))


def test_extract_and_solve_write_to_standard_output(scene, out, tmp_path, capsys):
    main(["run", scene, "--out", str(out)])
    capsys.readouterr()
    assert main(["extract", str(out / "scene.npz"), "--step", "0"]) == 0
    path = tmp_path / "step.json"
    path.write_text(capsys.readouterr().out)
    assert step_read(path) == trajectory_read(out / "scene.npz").step_data(0)
    assert main(["solve", str(path), "--backend", "osqp", "--certify", "off"]) == 0
    captured = capsys.readouterr()
    solution = json.loads(captured.out)
    assert solution["certificate"]["kind"] == "none"
    assert captured.err == "nothing is certified\n"


def test_verify_tells_a_true_answer_from_a_false_one(tmp_path, capsys):
    step = str(step_written(tmp_path / "step.json", point_on_floor(force=(0.5, 0.0, -3.0))))
    true, false = tmp_path / "true.json", tmp_path / "false.json"
    assert main(["solve", step, "-o", str(true)]) == 0
    capsys.readouterr()
    assert main(["verify", step, str(true)]) == 0
    assert capsys.readouterr().out.startswith("verified: exact")
    record = json.loads(true.read_text())
    record["delta_q"][0] = np.nextafter(record["delta_q"][0], 1.0)
    false.write_text(json.dumps(record))
    assert main(["verify", step, str(false)]) == 1
    assert capsys.readouterr().out.startswith("refuted: ")
    assert main(["verify", step, str(false), "--json"]) == 1
    assert json.loads(capsys.readouterr().out)["verified"] is False
    assert main(["verify", step, str(tmp_path / "none.json")]) == 2
    assert one_sentence(capsys.readouterr().err).endswith("none.json: no such file")


def test_a_step_without_solution_is_proved_so_in_its_file(swing, out, tmp_path, capsys):
    assert main(["run", swing, "--out", str(out)]) == 3
    step, proof = str(out / "swing_failed_step.json"), str(tmp_path / "proof.json")
    assert main(["solve", step, "-o", proof]) == 3
    assert main(["verify", step, proof]) == 0
    assert "the step has no solution" in capsys.readouterr().out


def test_inspect_shows_a_urdf(tmp_path, capsys):
    path = str(written(tmp_path, RAIL, "rail.urdf"))
    assert main(["inspect", path, "--json"]) == 0
    record = json.loads(capsys.readouterr().out)
    assert [c["name"] for c in record["coordinates"]] == ["rail/slide", "rail/turn"]
    assert [c["unit"] for c in record["coordinates"]] == ["m", "rad"]
    assert (record["n_a"], record["n_u"]) == (2, 0)
    masses = {link["name"]: link["mass"] for link in record["links"]}
    assert masses == {"rail/rail": 2, "rail/plate": 2, "rail/wheel": 2}
    assert record["links"][1]["shapes"] == [
        {"name": "rail/plate#0", "kind": "Box", "size": "box 0.02 x 0.2 x 0.2 m"}
    ]
    assert "rail: joint limits: position, effort and velocity (2)" in record["ignored"]
    assert main(["inspect", path]) == 0
    text = capsys.readouterr().out
    assert "rail/slide" in text
    assert "the model ignores:" in text


def test_inspect_says_what_a_mimic_follows(tmp_path, capsys):
    path = str(written(tmp_path, CHAIN, "arm.urdf"))
    assert main(["inspect", path]) == 0
    assert "\narm/swing_mimic = -0.7 * arm/swing + 0.2\n" in capsys.readouterr().out
    assert main(["inspect", path, "--json"]) == 0
    follows = {"name": "arm/swing_mimic", "of": "arm/swing", "multiplier": -0.7, "offset": 0.2}
    assert json.loads(capsys.readouterr().out)["mimics"] == [follows]


def test_inspect_shows_a_scenario(scene, capsys):
    assert main(["inspect", scene, "--json", "--set", "contacts.floor.mu_omega=0.5"]) == 0
    record = json.loads(capsys.readouterr().out)
    stiffness = {c["name"]: c["K_q"] for c in record["coordinates"] if c["actuated"]}
    assert stiffness == {"rail/slide": 500, "rail/turn": 2.5}
    assert [pair["mu_omega"] for pair in record["pairs"]] == [0.5, 0.0]
    assert record["size"] == [8, 10]
    assert main(["inspect", scene]) == 0
    text = capsys.readouterr().out
    assert "each step: 8 variables, 10 rows; h = 0.01 s" in text
    assert "500 N/m" in text
    assert "2.5 N m/rad" in text


def test_inspect_names_each_field_of_a_scenario_as_set_takes_it(scene, capsys):
    assert main(["inspect", scene, "--json"]) == 0
    fields = json.loads(capsys.readouterr().out)["fields"]
    assert fields["h"] == 0.01
    numbers = {
        name: x for name, x in fields.items() if type(x) in (int, float) and name != "version"
    }
    assert any(name.startswith("contacts.floor.") for name in numbers)
    for name, value in numbers.items():
        assert main(["inspect", scene, "--json", "--set", f"{name}={value}"]) == 0
        capsys.readouterr()
    assert main(["inspect", scene]) == 0
    assert "  h = 0.01\n" in capsys.readouterr().out


def test_backends_lists_what_is_installed(capsys):
    assert main(["backends", "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert (told["default"], told["default_of_solve"]) == ("daqp", "clarabel")
    assert {"clarabel", "osqp", "piqp", "daqp"} <= set(told["installed"])
    assert main(["backends"]) == 0
    page = capsys.readouterr().out
    assert "daqp (default of run)" in page
    assert "clarabel (default of solve)" in page


def test_demo_prints_one_json_object_and_writes_what_it_names(demo):
    assert demo.status == 0
    told = json.loads(demo.output)
    assert set(told["cases"]) == {"with torsion", "without torsion"}
    names = {path.name for path in demo.folder.iterdir()}
    assert names == {
        *told["figures"], "bunny_grasp_with_torsion.npz", "bunny_grasp_without_torsion.npz",
    }  # fmt: skip
    for name in told["figures"]:
        assert (demo.folder / name).stat().st_size > 1000


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


@pytest.mark.parametrize("name", ["my robot.urdf", "world.urdf"])
def test_inspect_takes_a_urdf_of_any_file_name(tmp_path, capsys, name):
    assert main(["inspect", str(written(tmp_path, RAIL, name))]) == 0


USAGE = {
    "no command": ([], "the following arguments are required: COMMAND"),
    "an unknown command": (["fly"], "invalid choice: 'fly'"),
    "an unknown option": (["run", "x.toml", "--fast"], "unrecognized arguments: --fast"),
    "a step in words": (["extract", "x.npz", "--step", "first"], "invalid int value: 'first'"),
    "no step": (["extract", "x.npz"], "required: --step"),
}


@pytest.mark.parametrize(("arguments", "says"), USAGE.values(), ids=USAGE)
def test_wrong_usage_is_status_2(capsys, arguments, says):
    with pytest.raises(SystemExit) as caught:
        main(arguments)
    assert caught.value.code == 2
    assert says in capsys.readouterr().err


def test_only_the_first_word_is_a_command(scene, tmp_path, monkeypatch):
    """A folder called bench is a folder: the module of that command is not even imported."""
    monkeypatch.setitem(sys.modules, "quasistatic_ref.lab.commands.bench", None)
    monkeypatch.chdir(tmp_path)
    assert main(["run", scene, "--out", "bench"]) == 0
    assert (tmp_path / "bench" / "scene.npz").is_file()


@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_has_help(capsys, command):
    with pytest.raises(SystemExit) as caught:
        main([command, "--help"])
    assert caught.value.code == 0
    assert f"usage: quasistatic-ref {command}" in capsys.readouterr().out


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


def test_figures_are_made_by_name(out, capsys):
    assert main(["figures", "cone_surfaces", "--out", str(out)]) == 0
    paths = [out / "cone_surfaces.png", out / "cone_surfaces.pdf"]
    assert capsys.readouterr().out.splitlines() == [str(path) for path in paths]
    assert all(path.stat().st_size > 1000 for path in paths)
    assert main(["figures", "cone_surface", "--out", str(out)]) == 2
    assert "did you mean 'cone_surfaces'?" in one_sentence(capsys.readouterr().err)


def test_a_file_that_cannot_be_used_is_named_and_not_taken_for_standard_output(monkeypatch, capsys):
    def full(options):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC), "rows.jsonl")

    monkeypatch.setattr("quasistatic_ref.cli.backends.run", full)
    assert main(["backends"]) == 2
    told = capsys.readouterr().err
    assert told == "quasistatic-ref: rows.jsonl: cannot be used: No space left on device\n"


@pytest.mark.parametrize("name", scenario_names())
def test_what_is_inspected_fits_a_terminal(name, capsys):
    assert main(["inspect", name]) == 0
    assert max(map(len, capsys.readouterr().out.splitlines())) <= WIDTH


def test_a_step_that_is_extracted_into_a_file_is_named(scene, tmp_path, capsys):
    assert main(["run", scene, "--out", str(tmp_path), "--quiet"]) == 0
    capsys.readouterr()
    path = tmp_path / "step.json"
    (trajectory,) = tmp_path.glob("*.npz")
    assert main(["extract", str(trajectory), "--step", "1", "-o", str(path)]) == 0
    assert capsys.readouterr().out == f"wrote {path}\n"


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
    assert main(["run", "block_incline", "--quiet", "--out", str(tmp_path)]) == 0
    warned = capsys.readouterr().err
    assert warned.startswith("quasistatic-ref: the spurious drag")
    assert main(["run", "block_incline", "--quiet", "--strict", "--out", str(tmp_path)]) == 1
