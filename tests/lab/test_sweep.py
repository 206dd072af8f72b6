"""Many runs of one scenario: a table and a trajectory a run."""

import csv
import json
import os
import signal
import subprocess
import sys

import numpy as np
import pytest

from quasistatic_ref import InputError, load_scenario, load_trajectory
from quasistatic_ref.lab import sweep
from quasistatic_ref.lab.processes import descendants
from quasistatic_ref.lab.sweep import TABLE, simulate_many, swept_values
from tests.cases import cases, first
from tests.optional.doctor.mistake_scenes import scenes_written
from tests.pages import ROOT
from tests.processes import has_ended, started, waited_for


def table(folder):
    with (folder / TABLE).open() as file:
        return list(csv.DictReader(file))


def test_a_grid_is_run_and_kept(tmp_path, cli):
    sideways = "gravity=[0.0, 0.5, -9.81]"
    run = f"run block_incline --set '{sideways}' --set fast=true --quiet"
    sweep = "--sweep contacts.rough.mu_v=0:0.9:2 --sweep steps=1,2 --jobs 1 --out"
    assert "4 runs (fast path), 0 failed" in cli(run, sweep, tmp_path).out
    header = next(csv.reader((tmp_path / TABLE).read_text().splitlines()))
    assert len(set(header)) == len(header)
    lines = table(tmp_path)
    points = [(float(line["contacts.rough.mu_v"]), int(line["steps"])) for line in lines]
    assert points == [(mu, steps) for mu in (0.0, 0.9) for steps in (1, 2)]
    # Each trajectory is that of the scenario alone with the same values, bit for bit.
    for line, (mu, steps) in zip(lines, points, strict=True):
        assert float(line["steps_taken"]) == steps
        settings = [sideways, f"contacts.rough.mu_v={mu}", f"steps={steps}"]
        alone = load_scenario("block_incline", settings).run()
        np.testing.assert_array_equal(load_trajectory(tmp_path / line["run"])["q"], alone["q"])
    printed = json.loads(cli(run, sweep, tmp_path / "again", "--json").out)
    assert (printed["runs"], printed["fast"]) == (4, True)
    assert table(tmp_path / "again") == lines


def swept(folder, scenario="block_incline", **values):
    return simulate_many(scenario, values, folder, workers=1)


def content(folder):
    return {path: path.read_bytes() for path in folder.rglob("*") if path.is_file()}


OTHER_SWEEPS = {"longer": {"steps": [2]}, "another h": {"h": [0.02]}, "more": {"steps": [2, 3]}}


@cases("other", OTHER_SWEEPS)
def test_a_folder_with_runs_of_another_sweep_is_refused_before_anything_is_written(tmp_path, other):
    swept(tmp_path, steps=[1])
    for remains in ("all", "runs", "table"):
        if remains == "runs":
            (tmp_path / TABLE).unlink()
        if remains == "table":
            (tmp_path / "runs" / "block_incline_0.npz").unlink()
            (tmp_path / "runs").rmdir()
            (tmp_path / TABLE).touch()
        kept = content(tmp_path)
        with pytest.raises(InputError, match="holds runs of another sweep; choose another folder"):
            swept(tmp_path, **other)
        assert content(tmp_path) == kept


@pytest.mark.parametrize("end", first(1, [signal.SIGKILL, signal.SIGTERM]))
def test_a_sweep_that_was_ended_has_no_workers_but_a_table_and_goes_on(tmp_path, end):
    values = {"steps": [1, 2, 100_000]}
    code = "from quasistatic_ref.lab.sweep import simulate_many\n"
    code += f"simulate_many('block_incline', {values}, 'map', workers=2)\n"
    process = started(code, tmp_path)
    folder = tmp_path / "map"
    waited_for(lambda: (folder / TABLE).exists() and len(table(folder)) >= 1)
    workers = descendants(process.pid)
    assert len(workers) >= 2
    process.send_signal(end)
    process.wait()
    waited_for(lambda: all(map(has_ended, workers)))
    ended = content(folder / "runs")
    ended = {path: one for path, one in ended.items() if path.suffix != ".partial"}  # half written
    assert 1 <= len(ended) < 3
    values["steps"][2] = 3  # what it did not come to may be another
    rows = swept(folder, **values)
    assert [row["measures"]["steps"] for row in rows] == [1, 2, 3]
    assert ended.items() <= content(folder / "runs").items()
    assert rows == swept(tmp_path / "whole", **values)
    assert (folder / TABLE).read_bytes() == (tmp_path / "whole" / TABLE).read_bytes()


def test_an_empty_folder_of_runs_is_none(tmp_path):
    (tmp_path / "runs").mkdir()
    assert len(swept(tmp_path, steps=[1])) == 1


def test_ctrl_c_ends_a_sweep_and_its_workers_without_a_traceback(tmp_path):
    command = "run block_incline --sweep steps=1,100000 --jobs 2 --out map"
    code = (
        "import runpy, signal\n"
        "signal.signal(signal.SIGINT, signal.default_int_handler)\n"  # ignored in the background
        "runpy.run_module('quasistatic_ref', run_name='__main__')\n"
    )
    process = subprocess.Popen(
        [sys.executable, "-c", code, *command.split()], cwd=tmp_path, stderr=subprocess.PIPE,
        env=os.environ | {"PYTHONPATH": str(ROOT)}, start_new_session=True,
    )  # fmt: skip
    waited_for(lambda: any((tmp_path / "map").glob("runs/*.npz")))
    os.killpg(process.pid, signal.SIGINT)  # as a terminal does
    _, said = process.communicate(timeout=60)
    assert process.returncode == 130
    assert b"Traceback" not in said
    assert [float(row["steps"]) for row in table(tmp_path / "map")] == [1]


@pytest.mark.long
def test_on_two_workers_of_dask_the_runs_are_the_same(two_of_dask, tmp_path):
    values = {"h": [0.01, 0.02], "steps": [2]}
    there = simulate_many("block_incline", values, tmp_path / "there", executor=two_of_dask)
    assert there == swept(tmp_path / "here", **values)
    assert (tmp_path / "there" / TABLE).read_text() == (tmp_path / "here" / TABLE).read_text()


@pytest.mark.parametrize("mu", [0.0, 0.3])
def test_a_sliding_block_travels_as_its_closed_form_says(tmp_path, mu):
    """Step k slips d (1 - r^(k+1)), d = h^2 g (sin a - mu cos a), r = mu^2 / (1 + mu^2).

    It is then mu times its last slip above the slope: docs/derivations.md.
    """
    given = {"contacts.smooth.mu_v": [mu], "h": [0.01, 0.02], "steps": [2]}
    rows = swept(tmp_path, **given)
    angle = np.radians(25)
    for row in rows:
        d = row["values"]["h"] ** 2 * 9.81 * (np.sin(angle) - mu * np.cos(angle))
        r = mu**2 / (1 + mu**2)
        slips = d * (1 - r ** np.arange(1, 3))
        travel = np.hypot(slips.sum(), mu * slips[-1])
        measures = row["measures"]
        assert row["outcome"] == "done"
        assert measures["smooth.ends_from_start_m"] == pytest.approx(travel, rel=1e-9)
        layer = 1e6 * mu * slips[-1]
        assert measures["boundary_layer_um"] == pytest.approx(layer, rel=1e-9, abs=1e-9)
        assert measures["smooth.largest_rotation_deg"] < 1e-9
        assert (measures["steps"], measures["exact"]) == (2, 1.0)


def test_a_run_that_ends_early_is_a_row_too(tmp_path):
    """The block starts at 0.20616 m from the origin and slides past 0.2063 m on its way down."""
    rows = swept(tmp_path, **{"limits.reach": [100.0, 0.2063]})
    assert [row["outcome"] for row in rows] == ["done", "ended_early"]
    assert [row["reason"] is None for row in rows] == [True, False]
    steps = [row["measures"]["steps"] for row in rows]
    assert steps[0] == 100
    assert 0 < steps[1] < 100


@pytest.mark.parametrize(
    ("text", "values"),
    [
        ("a.b=0:1:3", [0.0, 0.5, 1.0]),
        ("a.b=40:140:3", [40, 90, 140]),
        ("a.b=-1:1:3", [-1, 0, 1]),
        ("a.b=0:1.0:2", [0.0, 1.0]),
        ("a.b=1,2.5", [1, 2.5]),
        ("a.b=pyramid,facets-8", ["pyramid", "facets-8"]),
    ],
)
def test_values_are_read_as_a_range_or_a_list(text, values):
    field, read = swept_values(text)
    assert (field, read) == ("a.b", values)
    assert list(map(type, read)) == list(map(type, values))


def test_a_field_of_whole_numbers_is_swept_as_a_range(tmp_path):
    field, values = swept_values("steps=1:3:3")
    assert [row["measures"]["steps"] for row in swept(tmp_path, **{field: values})] == [1, 2, 3]


@pytest.mark.parametrize("text", ["a.b", "a.b=", "a.b=0:1:0"])
def test_values_that_are_none_are_refused(text):
    with pytest.raises(InputError, match="--sweep: must read FIELD=FIRST:LAST:COUNT"):
        swept_values(text)


BAD = {
    "no value": ({"h": []}, "h: must be a list of finite numbers or words"),
    "nothing varied": ({}, "variations: must make 1 to 100000 runs"),
    "too many": ({"h": range(1000), "K": range(1000)}, "must make 1 to 100000 runs"),
    "an unknown field": ({"contacts.rouhg.mu_v": [0.5]}, "rouhg"),
    "a value": (
        {"contacts.rough.mu_v": np.array([0.5, -1.0])},
        "^contacts.rough.mu_v=-1.0: must be at least 0",
    ),
    "a cone that the backend does not take": (
        {"solver.backend": ["daqp"], "cone": ["pyramid", "ellipsoid"]},
        "accepts only linear rows",
    ),
}


@cases("variations, sentence", BAD)
def test_bad_variations_are_one_sentence(variations, sentence, tmp_path):
    with pytest.raises(InputError, match=sentence):
        swept(tmp_path / "map", **variations)
    assert not (tmp_path / "map").exists()


def test_a_sweep_has_a_column_of_findings(tmp_path):
    """Its records are light: the grip without friction is named all the same."""
    scenes_written(tmp_path)
    varied = {"contacts.grip.mu_v": [0.01, 0.6], "solver.certify": ["off"]}
    rows = swept(tmp_path / "map", tmp_path / "grasp.toml", **varied)
    assert [row["findings"] for row in rows] == [["lost-grip"], []]
    assert [row["findings"] for row in table(tmp_path / "map")] == ["lost-grip", ""]


def test_steps_that_are_judged_by_residuals_are_not_counted_as_exact(tmp_path):
    values = {"solver.certify": ["full", "residual"], "steps": [1]}
    rows = swept(tmp_path, **values)
    assert [row["measures"]["exact"] for row in rows] == [1.0, 0.0]


def test_each_scenario_is_loaded_once_and_each_run_adds_its_line(tmp_path, monkeypatch):
    """Also where a value is a word of several fields; the lines are those of the whole table."""
    loads, lines = [], []
    monkeypatch.setattr(sweep, "load_scenario", lambda *a: loads.append(a) or load_scenario(*a))

    def run_of(*task):
        result = run_of_one(*task)
        lines.append((tmp_path / sweep.TABLE).read_text() if len(lines) else "")
        return result

    run_of_one = sweep.run_of
    monkeypatch.setattr(sweep, "run_of", run_of)
    grid = {"contacts.floor.mu_v": [0.1, 0.2, 0.3], "cone": ["pyramid", "product"]}
    rows = simulate_many("sphere_spin", grid, tmp_path, settings=["steps=2"], workers=1)
    whole = (tmp_path / sweep.TABLE).read_text()
    assert len(loads) == len(rows) == 6
    assert lines[1:] == ["".join(whole.splitlines(True)[: k + 1]) for k in range(1, 6)]


def test_what_takes_too_much_room_is_loaded_again(tmp_path, monkeypatch):
    loads = []
    monkeypatch.setattr(sweep, "load_scenario", lambda *a: loads.append(a) or load_scenario(*a))
    monkeypatch.setattr(sweep, "ROOM", 1.5 * sweep.SCENE)
    grid = {"contacts.floor.mu_v": [0.1, 0.2, 0.3]}
    simulate_many("sphere_spin", grid, tmp_path, settings=["steps=1"], workers=1)
    assert len(loads) == 3 + 2  # the first was kept
