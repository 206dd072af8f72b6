"""``--cone`` and the scenario's ``cone`` reach the step, its file, its trajectory and figures."""

import json

import numpy as np
import pytest
from matplotlib import pyplot as plt

from quasistatic_ref.cli.main import main
from quasistatic_ref.lab.examples import pinch_threshold
from quasistatic_ref.lab.figures.cones import limit_surfaces
from quasistatic_ref.simulate.trajectory import trajectory_read
from quasistatic_ref.solve.solve import solve_step
from quasistatic_ref.step.files import step_read, step_written
from tests.helpers import pinch
from tests.scenes import written_scenario
from tests.tolerances import EXACT, ROUNDING

NAMES = ("product", "facets-6", "frictionless", "ellipsoid")


@pytest.fixture
def scene(tmp_path):
    return str(written_scenario(tmp_path))


@pytest.mark.parametrize("name", NAMES)
def test_a_run_in_another_cone_can_be_replayed_from_its_file(name, scene, tmp_path, capsys):
    assert main(["run", scene, "--cone", name, "--out", str(tmp_path), "--json"]) == 0
    said = json.loads(capsys.readouterr().out)
    trajectory = trajectory_read(tmp_path / "scene.npz")
    assert trajectory.header["cone"] == name
    step = trajectory.step_data(3)
    assert step.cone == name
    assert said["rows"] == int(step.offsets[-1]) == trajectory["lam"].shape[1]
    again = solve_step(step, "none")
    np.testing.assert_allclose(again.delta_q, trajectory["delta_q"][3], rtol=EXACT, atol=EXACT)
    out = tmp_path / "step.json"
    arguments = ["extract", str(tmp_path / "scene.npz"), "--step", "3", "-o", str(out)]
    assert main(arguments) == 0
    assert step_read(out) == step


@pytest.mark.parametrize("name", NAMES)
def test_a_solution_in_another_cone_is_verified_in_that_cone_only(name, tmp_path, capsys):
    step, solution = tmp_path / "step.json", tmp_path / "solution.json"
    step_written(step, pinch(grip=5.0, offset=0.2))
    assert main(["solve", str(step), "--cone", name, "-o", str(solution)]) == 0
    assert main(["verify", str(step), str(solution), "--cone", name]) == 0
    assert "verified" in capsys.readouterr().out
    assert main(["verify", str(step), str(solution)]) == 2
    assert "cone: must be that of the step, 'pyramid'" in capsys.readouterr().err


def test_an_enclosure_that_was_tampered_with_is_refuted(tmp_path, capsys):
    step, solution = tmp_path / "step.json", tmp_path / "solution.json"
    step_written(step, pinch(grip=5.0, offset=0.2).replace(cone="ellipsoid"))
    assert main(["solve", str(step), "-o", str(solution)]) == 0
    record = json.loads(solution.read_text())
    assert record["certificate"]["kind"] == "enclosure"
    assert [len(part) for part in record["lam"]] == [4, 4]
    record["delta_q"][4] *= 1 + 1e-13
    solution.write_text(json.dumps(record))
    assert main(["verify", str(step), str(solution)]) == 1
    assert "error_bound is claimed" in capsys.readouterr().out


def test_an_unknown_cone_is_refused_in_a_sentence(scene, tmp_path, capsys):
    assert main(["run", scene, "--cone", "facets-7", "--out", str(tmp_path)]) == 2
    assert "cone: must be one of pyramid, ellipsoid" in capsys.readouterr().err


def test_inspect_counts_the_rows_of_the_scenario_s_cone(scene, capsys):
    assert main(["inspect", scene, "--set", "cone=product", "--json"]) == 0
    said = json.loads(capsys.readouterr().out)
    assert said["cone"] == "product"
    expected = {6: 8, 4: 4}
    assert main(["inspect", scene, "--json"]) == 0
    pyramid = json.loads(capsys.readouterr().out)
    for one, two in zip(said["pairs"], pyramid["pairs"], strict=True):
        assert one["rows"] == expected[two["rows"]]


def test_the_figure_of_limit_surfaces_shows_each_with_its_name():
    figure = limit_surfaces()
    titles = [axes.get_title() for axes in figure.axes]
    assert titles == ["pyramid", "ellipsoid", "product"]
    for axes in figure.axes:
        assert axes.get_xlabel() == r"$f_1/\mu_v$ [N]"
        assert axes.get_zlabel() == r"$\tau_n/\mu_\omega$ [N]"
    plt.close(figure)


def test_the_figure_of_the_pinch_draws_the_formulas():
    figure = pinch_threshold.figure(levers=4)
    (axes,) = figure.axes
    lines = [line for line in axes.lines if line.get_linestyle() != "None"]
    for line in lines:
        d, drawn = line.get_data()  # mm, N
        slide, spin = 0.2 * 9.81 / (2 * 0.5), 0.2 * 9.81 * 1e-3 * d / (2 * 0.02)
        expected = {
            "pyramid": slide + spin,
            "ellipsoid": np.sqrt(slide**2 + spin**2),
            "product": np.maximum(slide, spin),
        }[line.get_label()]
        np.testing.assert_allclose(drawn, expected, rtol=ROUNDING, atol=0.0)
        if line.get_label() == "product":  # the corner, where both are 1.962 N
            assert np.diff(d).max() < 0.2
            np.testing.assert_allclose(np.interp(40.0, d, drawn), 1.962, rtol=1e-3)
    tried = np.linspace(0, 60, 4)
    marks = [
        line for line in axes.lines if line.get_linestyle() == "None" and len(line.get_xdata())
    ]
    assert sorted(mark.get_marker() for mark in marks) == [*"^^^vvv"]  # of three cones
    for mark, line in zip(marks, np.repeat(lines, 2), strict=True):
        share = 1.03 if mark.get_marker() == "^" else 0.97
        np.testing.assert_allclose(mark.get_xdata(), tried, rtol=ROUNDING)
        held = share * np.interp(tried, *line.get_data())
        np.testing.assert_allclose(mark.get_ydata(), held, rtol=1e-3)
    plt.close(figure)
