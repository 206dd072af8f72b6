"""Many runs of one scenario: a table, a trajectory a run, and going on after an interruption."""

import csv
import json

import numpy as np
import pytest

from quasistatic_ref import InputError, Scenario, load_scenario, load_trajectory
from quasistatic_ref.lab import run_settings
from quasistatic_ref.lab.lock import locked
from quasistatic_ref.lab.processes import descendants
from quasistatic_ref.lab.sweep import TABLE, simulate_many, swept_values
from tests.optional.doctor.mistake_scenes import scenes_written
from tests.processes import has_ended, started, waited_for
from tests.scenes import BALL, PUSH, written_scenario


def table(folder):
    with (folder / TABLE).open() as file:
        return list(csv.DictReader(file))


def test_a_grid_is_run_kept_and_gone_on_with(tmp_path, cli):
    sideways = "gravity=[0.0, 0.5, -9.81]"
    run = f"run block_incline --set '{sideways}' --set fast=true --quiet"
    sweep = "--sweep contacts.rough.mu_v=0:0.9:2 --sweep steps=1,2 --jobs 1 --out"
    argv = run, sweep, tmp_path
    assert "4 runs (fast path), 0 of which not done" in cli(*argv).out
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
    kept = {path: path.stat().st_mtime_ns for path in (tmp_path / "runs").iterdir()}
    printed = json.loads(cli(*argv, "--json").out)
    assert (printed["runs"], printed["fast"]) == (4, True)
    assert {path: path.stat().st_mtime_ns for path in kept} == kept
    assert table(tmp_path) == lines


def swept(path, folder, **values):
    given = values or {"h": [0.01]}
    return simulate_many(path, given, folder, workers=1)


def content(folder):
    return {path: path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def version_changed(path, monkeypatch):
    monkeypatch.setattr(run_settings, "__version__", "0.0")


CLOUD = "x,y,z\n0,0,-0.05\n-0.05,0,0\n"
"""Of the ball: on the floor, and at the plate."""
WITH_CLOUD = PUSH.replace('urdf = "ball.urdf"', 'urdf = "ball.urdf"\ncloud = "ball.csv"')

CHANGES = {
    "the scenario": lambda path, _: path.write_text(WITH_CLOUD.replace("= 0.3", "= 0.4")),
    "a robot": lambda path, _: (path.parent / "ball.urdf").write_text(BALL.replace("0.3", "0.4")),
    "a cloud": lambda path, _: (path.parent / "ball.csv").write_text(f"{CLOUD}0,0,0.05\n"),
    "the version": version_changed,
}


@pytest.mark.parametrize(
    ("cause", "name"), [*((cause, "push.toml") for cause in CHANGES), ("a robot", "push")]
)
def test_runs_of_a_scene_that_has_changed_are_kept_and_refused(tmp_path, monkeypatch, cause, name):
    path = written_scenario(tmp_path, WITH_CLOUD, name)
    (tmp_path / "ball.csv").write_text(CLOUD)
    first = swept(path, tmp_path / "map")
    kept = content(tmp_path / "map")
    assert swept(path, tmp_path / "map") == first
    CHANGES[cause](path, monkeypatch)
    with pytest.raises(InputError, match="changed; choose another folder, or remove this one"):
        swept(path, tmp_path / "map")
    assert content(tmp_path / "map") == kept
    assert {row["run"] for row in swept(path, tmp_path / "new")}.isdisjoint(
        row["run"] for row in first
    )


OTHERS = {
    "another scenario": ("sphere_spin", {"h": [0.01, 0.02], "steps": [1]}),
    "a value less": ("block_incline", {"h": [0.01], "steps": [1]}),
}


@pytest.mark.parametrize(("scenario", "values"), OTHERS.values(), ids=OTHERS)
def test_a_folder_of_other_runs_is_refused_before_anything_is_written(tmp_path, scenario, values):
    swept("block_incline", tmp_path, h=[0.01, 0.02], steps=[1])
    for path in (tmp_path / "runs").iterdir():
        path.unlink()  # the table alone is enough
    kept = content(tmp_path)
    with pytest.raises(InputError, match="holds runs that this sweep does not have"):
        swept(scenario, tmp_path, **values)
    assert content(tmp_path) == kept


def test_a_table_of_something_else_is_refused(tmp_path):
    (tmp_path / TABLE).write_text("run\n\n")
    with pytest.raises(InputError, match=r"is no table of a sweep"):
        swept("block_incline", tmp_path)
    assert [path.name for path in tmp_path.iterdir()] == [TABLE]


def test_a_folder_that_another_sweep_writes_into_is_refused(tmp_path):
    with locked(tmp_path), pytest.raises(InputError, match="is being written by another sweep"):
        swept("block_incline", tmp_path)


MANY = """
from quasistatic_ref.lab.sweep import simulate_many
simulate_many("block_incline", {"steps": [1, 100_000, 100_001, 100_002]}, "map", workers=2)
"""


def test_workers_end_with_the_process_of_the_sweep_also_when_it_is_killed(tmp_path):
    process = started(MANY, tmp_path)
    waited_for(lambda: any((tmp_path / "map").glob("runs/*.npz")))
    workers = descendants(process.pid)
    assert len(workers) >= 2
    process.kill()
    process.wait()
    waited_for(lambda: all(map(has_ended, workers)))


@pytest.mark.long
def test_on_two_workers_of_dask_the_runs_are_the_same(two_of_dask, tmp_path):
    values = {"h": [0.01, 0.02], "steps": [2]}
    there = simulate_many("block_incline", values, tmp_path / "there", executor=two_of_dask)
    assert there == swept("block_incline", tmp_path / "here", **values)
    assert (tmp_path / "there" / TABLE).read_text() == (tmp_path / "here" / TABLE).read_text()


def test_more_values_add_runs_and_a_spoilt_one_is_made_again(tmp_path):
    first = swept("block_incline", tmp_path, h=[0.01], steps=[2])
    file = tmp_path / first[0]["run"]
    good = file.read_bytes()
    file.write_bytes(good[:100])
    both = swept("block_incline", tmp_path, h=[0.02, 0.01], steps=[2])
    assert both[1] == first[0]
    assert file.read_bytes() == good
    assert [line["run"] for line in table(tmp_path)] == [row["run"] for row in both]


def test_an_interrupted_sweep_has_a_table_of_what_is_done(tmp_path, monkeypatch):
    whole = swept("block_incline", tmp_path / "whole", h=[0.01, 0.02], steps=[2])
    run = Scenario.run

    def interrupted(scenario, **more):
        if scenario.h == 0.02:
            raise KeyboardInterrupt
        return run(scenario, **more)

    monkeypatch.setattr(Scenario, "run", interrupted)
    with pytest.raises(KeyboardInterrupt):
        swept("block_incline", tmp_path / "map", h=[0.01, 0.02], steps=[2])
    assert table(tmp_path / "map") == table(tmp_path / "whole")[:1]
    (tmp_path / "map" / TABLE).unlink()  # as after a kill
    monkeypatch.undo()
    assert swept("block_incline", tmp_path / "map", h=[0.01, 0.02], steps=[2]) == whole


@pytest.mark.parametrize("mu", [0.0, 0.3])
def test_a_sliding_block_travels_as_its_closed_form_says(tmp_path, mu):
    """Step k slips d (1 - r^(k+1)), d = h^2 g (sin a - mu cos a), r = mu^2 / (1 + mu^2).

    It is then mu times its last slip above the slope: docs/derivations.md.
    """
    given = {"contacts.smooth.mu_v": [mu], "h": [0.01, 0.02], "steps": [2]}
    rows = swept("block_incline", tmp_path, **given)
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
    rows = swept("block_incline", tmp_path, **{"limits.reach": [100.0, 0.2063]})
    assert [row["outcome"] for row in rows] == ["done", "ended_early"]
    assert [row["reason"] is None for row in rows] == [True, False]
    steps = [row["measures"]["steps"] for row in rows]
    assert steps[0] == 100
    assert 0 < steps[1] < 100


@pytest.mark.parametrize(
    ("text", "values"),
    [
        ("a.b=0:1:3", [0.0, 0.5, 1.0]),
        ("a.b=1,2.5", [1, 2.5]),
        ("a.b=pyramid,facets-8", ["pyramid", "facets-8"]),
    ],
)
def test_values_are_read_as_a_range_or_a_list(text, values):
    assert swept_values(text) == ("a.b", values)


@pytest.mark.parametrize("text", ["a.b", "a.b=", "a.b=0:1:0"])
def test_values_that_are_none_are_refused(text):
    with pytest.raises(InputError, match="--sweep: must read FIELD=FIRST:LAST:COUNT"):
        swept_values(text)


BAD = {
    "no value": ({"h": []}, "h: must be a list of finite numbers or words"),
    "nothing varied": ({}, "variations: must make 1 to 100000 runs"),
    "too many": ({"h": range(1000), "K": range(1000)}, "must make 1 to 100000 runs"),
    "an unknown field": ({"contacts.rouhg.mu_v": [0.5]}, "rouhg"),
    "a value": ({"contacts.rough.mu_v": np.array([0.5, -1.0])}, "mu_v: must be at least 0"),
    "a cone that the backend does not take": (
        {"solver.backend": ["daqp"], "cone": ["pyramid", "ellipsoid"]},
        "accepts only linear rows",
    ),
}


@pytest.mark.parametrize(("variations", "sentence"), BAD.values(), ids=BAD)
def test_bad_variations_are_one_sentence(variations, sentence, tmp_path):
    with pytest.raises(InputError, match=sentence):
        simulate_many("block_incline", variations, tmp_path / "map", workers=1)
    assert not (tmp_path / "map").exists()


def test_a_sweep_has_a_column_of_findings(tmp_path):
    """Its records are light: the grip without friction is named all the same."""
    scenes_written(tmp_path)
    varied = {"contacts.grip.mu_v": [0.01, 0.6], "solver.certify": ["off"]}
    rows = swept(tmp_path / "grasp.toml", tmp_path / "map", **varied)
    assert [row["findings"] for row in rows] == [["lost grip"], []]
    table = list(csv.DictReader((tmp_path / "map" / TABLE).read_text().splitlines()))
    assert [row["findings"] for row in table] == ["lost grip", ""]
