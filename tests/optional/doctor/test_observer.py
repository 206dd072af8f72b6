"""Findings of runs: too few contacts end to end, the command line, scenarios that come along."""

import json
from dataclasses import asdict
from pathlib import Path

import numpy as np
import pytest

from quasistatic_ref.cli.main import main
from quasistatic_ref.formats.resources import scenario_names
from quasistatic_ref.scenario.scenario import load_scenario
from quasistatic_ref.simulate.trajectory import trajectory_read
from quasistatic_ref.tolerances import IN_METRES, SUNK
from tests.model.urdf.urdf_texts import collision, inertial, joint, link, robot, written

GUIDE = Path(__file__).parents[3] / "docs" / "findings.md"
PAD = '<box size="0.06 0.01 0.06"/>'
GRIPPER = robot(
    link("post"),
    link("carriage"),
    link("left", collision(PAD, '<origin xyz="0 0.005 0"/>')),
    link("right", collision(PAD, '<origin xyz="0 -0.005 0"/>')),
    joint("lift", "post", "carriage", "prismatic", "0 0 1"),
    joint("open_left", "carriage", "left", "prismatic", "0 1 0"),
    joint("open_right", "carriage", "right", "prismatic", "0 -1 0"),
)
"""Two flat pads whose inner faces are at y = open_left and y = -open_right."""
CUBE = robot(
    link("cube", collision('<box size="0.04 0.04 0.04"/>'), inertial("0.1", ("4e-5",) * 3))
)
HOSTILE = """format = "quasistatic-ref/scenario"
version = 1
h = 0.01
steps = 200

[bodies.gripper]
urdf = "gripper.urdf"
actuated = "all"
K_q = { lift = 2000, open_left = 1000, open_right = 1000 }
pose = { xyz = [0, 0, 0.025] }
positions = { open_left = 0.025, open_right = 0.025 }

[[bodies.gripper.targets]]
t = 0.0
lift = 0.0
open_left = 0.025
open_right = 0.025

[[bodies.gripper.targets]]
t = 0.5
lift = 0.0
open_left = 0.015
open_right = 0.015

[[bodies.gripper.targets]]
t = 2.0
lift = 0.03

[bodies.cube]
urdf = "cube.urdf"
base = "floating"
pose = { xyz = [0, 0, 0.02], rpy = [0, 0, 0.2] }
cloud = "cube.csv"

[shapes.floor]
halfspace = { normal = [0, 0, 1], offset = 0 }

[contacts.floor]
alpha = "floor"
beta = "cube/cube"
mu_v = 0.5
rows = 4
k = 4

[contacts.grip]
alpha = ["gripper/left", "gripper/right"]
beta = "cube"
mu_v = 0.6
mu_omega = 0.003
k = 3
"""
"""Flat pads on the flat faces of a cube, each of 100 points, of which a pair keeps 3.

The cube stands askew by 0.2 rad. It turns until the faces are flush, and on: with 3 contacts it is
never held, and the gripper rises without it."""
EDGE = np.linspace(-0.02, 0.02, 10)
GRID = np.array(np.meshgrid(EDGE, EDGE, EDGE, indexing="ij")).reshape(3, -1).T
POINTS = GRID[(np.abs(GRID) == 0.02).any(axis=1)]
"""The 488 points of the grid on the cube's surface."""


@pytest.fixture(scope="module")
def hostile(tmp_path_factory):
    folder = tmp_path_factory.mktemp("hostile")
    written(folder, GRIPPER, "gripper.urdf")
    written(folder, CUBE, "cube.urdf")
    np.savetxt(folder / "cube.csv", POINTS, delimiter=",")
    (folder / "hostile.toml").write_text(HOSTILE)
    return folder / "hostile.toml"


def of_contacts(run):
    return [str(found) for found in run.findings if found.name == "sunk contact"]


def risen(run):
    """How far the cube is above its start at the end [m]."""
    return run["q"][-1, 5] - run["q"][0, 5]


def test_a_scene_with_too_few_contacts_names_step_pair_point_depth_and_k(hostile):
    run = load_scenario(hostile, fast=True).run(progress=False)
    assert (run["certificate"] == "exact").all()  # every answer was right, the scene was not
    assert run.steps == 200
    assert risen(run) < 0.005  # of 0.03 m
    (said,) = of_contacts(run)
    own = {"left": slice(4, 7), "right": slice(7, 10)}  # after the floor's 4
    # The first step in which a point of a grip is more than 1 % of 0.04 m deep, and was not among
    # those of the step before.
    step, side, j = next(
        (k, side, j)
        for k in range(1, run.steps)
        for side, pair in own.items()
        for j in range(3)
        if run["phi"][k, pair][j] < -SUNK * 0.04
        and run["point"][k, pair][j] not in run["point"][k - 1, pair]
    )
    point = int(run["point"][step, own[side]][j])
    # How deep that point is under the pad's inner face, from the configuration alone.
    x, y, z, w = run["q"][step, 6:10]
    across = [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)]  # y' R(q)
    at = run["q"][step, 4] + np.dot(across, POINTS[point])
    depth = at - run["q"][step, 1] if side == "left" else -run["q"][step, 2] - at
    assert depth > SUNK * 0.04
    assert said == (
        f"raise k of contacts.grip: point {point} of grip(gripper/{side}#0, cube) was not among "
        f"its 3 closest at step {step - 1} and is {1e3 * depth:.3g} mm deep at step {step}"
    )
    assert f"quasistatic-ref: {said}\n" in GUIDE.read_text()


def test_with_all_points_of_the_faces_the_same_scene_finds_no_contact(hostile):
    settings = ["contacts.grip.k=100", "solver.certify=off", "steps=120"]
    run = load_scenario(hostile, settings, fast=True).run(progress=False)
    assert of_contacts(run) == []
    assert risen(run) > 0.012  # of 0.014 m, at t = 1.2 s


def test_findings_are_printed_once_and_strict_fails_on_grave_ones(hostile, tmp_path, capsys):
    arguments = ["run", str(hostile), "--out", str(tmp_path), "--set", "steps=40"]
    assert main(arguments) == 0
    printed = capsys.readouterr().err.splitlines()
    run = trajectory_read(tmp_path / "hostile.npz")
    assert printed == [f"quasistatic-ref: {found}" for found in run.findings]
    assert len(of_contacts(run)) == 1
    assert main([*arguments, "--strict", "--json"]) == 1
    assert json.loads(capsys.readouterr().out)["findings"] == [asdict(f) for f in run.findings]
    assert str(run.findings[0])[:40] in repr(run)


def test_strict_is_content_with_findings_that_are_not_grave(tmp_path, capsys):
    arguments = ["run", "block_push", "--set", "steps=60", "--out", str(tmp_path)]
    assert main([*arguments, "--json", "--strict"]) == 0
    (found,) = json.loads(capsys.readouterr().out)["findings"]
    assert (found["name"], found["grave"]) == ("drag", False)


DRAGS = {"block_push", "block_incline", "panda_push"}
"""Their drag is not small."""


@pytest.mark.parametrize("name", scenario_names())
def test_of_a_scenario_that_comes_along_nothing_is_found_but_its_drag(name):
    settings = ["solver.certify=off", "record=light", "steps=60"]
    run = load_scenario(name, settings, fast=True).run(progress=False)
    assert [found.name for found in run.findings] == ["drag"] * (name in DRAGS)


@pytest.mark.parametrize(("size", "warned"), [(0.99 * IN_METRES, False), (40.0, True)])
def test_a_cloud_of_forty_metres_looks_like_one_of_forty_millimetres(hostile, size, warned):
    written(hostile.parent, f"0 0 0\n{size} 0 0\n0 1 0\n", "long.xyz")
    settings = {"bodies.cube.cloud": hostile.parent / "long.xyz", "steps": 1}
    run = load_scenario(hostile, settings, fast=True).run(progress=False)
    said = [found for found in run.findings if found.name == "unit of a shape"]
    assert [found.numbers for found in said] == [{"length_m": size}] * warned


def test_a_run_that_fails_at_once_still_says_that_a_unit_is_wrong(hostile, tmp_path, capsys):
    points = "".join(f"{1e3 * x} {1e3 * y} {1e3 * z}\n" for x, y, z in POINTS)  # in millimetres
    cloud = written(hostile.parent, points, "millimetres.xyz")
    arguments = ["run", str(hostile), "--out", str(tmp_path)]
    assert main([*arguments, "--set", f"bodies.cube.cloud={cloud}",
                 "--set", "contacts.floor.beta=cube"]) == 3  # fmt: skip
    printed = capsys.readouterr().err.splitlines()
    assert printed[-1].startswith("quasistatic-ref: step 0: contact ")
    assert printed[0] == (
        "quasistatic-ref: check the unit of cube: lengths are in metres, and it is 40 m long; "
        "scale it by 0.001 if that is meant in millimetres"
    )
    run = trajectory_read(tmp_path / "hostile.npz")
    assert [f"quasistatic-ref: {found}" for found in run.findings] == printed[:-1]
