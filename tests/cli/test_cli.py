"""The command line, in this process: exit statuses, plain sentences on failure, JSON."""

import json
from pathlib import Path

import numpy as np
import pytest

from quasistatic_ref.cli import solve as solve_command
from quasistatic_ref.cli.main import main
from quasistatic_ref.simulate import simulator
from quasistatic_ref.simulate.trajectory import trajectory_read
from quasistatic_ref.step.files import step_read, step_sha256, step_written
from tests.helpers import one_sentence, point_on_floor
from tests.model.urdf.urdf_texts import CHAIN, written
from tests.scenes import RAIL, SWING, written_scenario
from tests.tolerances import EXACT, MULTIPLIERS, ROUNDING


@pytest.fixture
def swing(tmp_path):
    return str(written_scenario(tmp_path, SWING, "swing.toml"))


def test_run_writes_the_trajectory_and_tells_of_it(scene, out, capsys):
    assert main(["run", scene, "--out", str(out)]) == 0
    printed = capsys.readouterr().out
    assert printed.startswith(
        "5 steps of 8 variables x 10 rows\n5 of 5 steps exact; backend clarabel, plain path, "
    )
    assert printed.endswith(f"wrote {out / 'scene.npz'}\n")
    assert trajectory_read(out / "scene.npz").steps == 5


def test_run_prints_one_json_object(scene, out, capsys):
    assert main(["run", scene, "--out", str(out), "--json"]) == 0
    printed = json.loads(capsys.readouterr().out)
    assert printed["trajectory"] == str(out / "scene.npz")
    assert (printed["steps"], printed["variables"], printed["rows"]) == (5, 8, 10)
    assert (printed["backend"], printed["fast"]) == ("clarabel", False)
    assert 0 <= printed["worst_residual"] < MULTIPLIERS
    assert set(printed["milliseconds_per_step"]) == {"distances", "rows", "solve", "integrate"}


def test_run_finds_the_scenarios_that_come_along(out, capsys):
    arguments = ["run", "sphere_spin", "--set", "steps=2", "--out", str(out), "--json"]
    assert main(arguments) == 0
    assert json.loads(capsys.readouterr().out)["steps"] == 2


def test_options_change_the_scenario(scene, out, capsys):
    options = ["--backend", "osqp", "--certify", "off", "--set", "steps=2", "--set", "h=0.02"]
    assert main(["run", scene, "--out", str(out), "--json", *options]) == 0
    printed = json.loads(capsys.readouterr().out)
    assert (printed["backend"], printed["steps"], printed["worst_residual"]) == ("osqp", 2, None)
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
    printed = capsys.readouterr()
    assert printed.err.startswith("exact: the optimum of the step, correctly rounded; ")
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
    assert record["read_as"] == "a fixed base, all joints actuated"
    assert main(["inspect", path]) == 0
    text = capsys.readouterr().out
    assert "read with a fixed base, all joints actuated" in text
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
    assert "read_as" not in record  # a scenario says how its bodies are held
    assert [pair["mu_omega"] for pair in record["pairs"]] == [0.5, 0.0]
    assert record["size"] == [8, 10]
    assert main(["inspect", scene]) == 0
    text = capsys.readouterr().out
    assert "each step: 8 variables, 10 rows; h = 0.01 s" in text
    assert "500 N/m" in text
    assert "2.5 N m/rad" in text


def test_inspect_passes_over_a_byte_order_mark_as_run_does(scene, capsys):
    path = Path(scene)
    assert main(["inspect", scene]) == 0
    plain = capsys.readouterr().out
    path.write_bytes(b"\xef\xbb\xbf" + path.read_bytes())
    assert main(["inspect", scene]) == 0
    assert capsys.readouterr().out == plain
    path.write_bytes(b"\xff" + path.read_bytes())
    assert main(["inspect", scene]) == 2
    assert capsys.readouterr().err.endswith("scene.toml: line 1: is not UTF-8 text\n")


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
    printed = json.loads(capsys.readouterr().out)
    assert (printed["default"], printed["default_of_fast"]) == ("clarabel", "daqp")
    assert {"clarabel", "osqp", "piqp", "daqp"} <= set(printed["installed"])
    assert main(["backends"]) == 0
    page = capsys.readouterr().out
    assert "daqp (default with --fast)" in page
    assert "clarabel (default)" in page


def test_demo_prints_one_json_object_and_writes_what_it_names(demo):
    assert demo.status == 0
    printed = json.loads(demo.output)
    assert set(printed["cases"]) == {"with torsion", "without torsion"}
    names = {path.name for path in demo.folder.iterdir()}
    assert names == {
        *printed["figures"], "bunny_grasp_with_torsion.npz", "bunny_grasp_without_torsion.npz",
    }  # fmt: skip
    for name in printed["figures"]:
        assert (demo.folder / name).stat().st_size > 1000


@pytest.mark.parametrize("name", ["my robot.urdf", "world.urdf"])
def test_inspect_takes_a_urdf_of_any_file_name(tmp_path, capsys, name):
    assert main(["inspect", str(written(tmp_path, RAIL, name))]) == 0


def test_figures_are_made_by_name(out, capsys):
    assert main(["figures", "cone_surfaces", "--out", str(out)]) == 0
    paths = [out / "cone_surfaces.png", out / "cone_surfaces.pdf"]
    assert capsys.readouterr().out.splitlines() == [str(path) for path in paths]
    assert all(path.stat().st_size > 1000 for path in paths)
    assert main(["figures", "cone_surface", "--out", str(out)]) == 2
    assert "did you mean 'cone_surfaces'?" in one_sentence(capsys.readouterr().err)


def test_a_step_that_is_extracted_into_a_file_is_named(scene, tmp_path, capsys):
    assert main(["run", scene, "--out", str(tmp_path), "--quiet"]) == 0
    capsys.readouterr()
    path = tmp_path / "step.json"
    (trajectory,) = tmp_path.glob("*.npz")
    assert main(["extract", str(trajectory), "--step", "1", "-o", str(path)]) == 0
    assert capsys.readouterr().out == f"wrote {path}\n"
