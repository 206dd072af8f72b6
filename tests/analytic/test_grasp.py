"""models/bunny_grasp, both runs: the paper's sizes and verdict, and where its files come from."""

import json
import runpy
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from quasistatic_ref import load_scenario, load_trajectory
from tests.closeness import assert_relative, assert_same
from tests.pages import ROOT
from tests.processes import python
from tests.tolerances import (
    ROUNDING,
)

CASES = ("with_torsion", "without_torsion")
CLOSED, TOP = 70, 290  # steps, of 0.01 s
FOLDER = ROOT / "models" / "bunny_grasp"
AT_REST = 1e-8
"""Largest motion of a step while nothing touches the bunny but the floor [m, rad]: its pose is
written to nanometres."""


@pytest.fixture(scope="module")
def scenario():
    return load_scenario("bunny_grasp", fast=True)


@pytest.fixture(scope="module")
def demo(tmp_path_factory):
    """Where `demo --fast --json` wrote both cases of the grasp, and its JSON and its errors."""
    folder = tmp_path_factory.mktemp("demo") / "out"
    done = python("-m", "quasistatic_ref", "demo", "--fast", "--json", "--out", folder)
    return folder, json.loads(done.stdout), done.stderr


@pytest.fixture(scope="module")
def runs(demo):
    folder, _, _ = demo
    return {case: load_trajectory(folder / f"bunny_grasp_{case}.npz") for case in CASES}


@pytest.fixture(scope="module")
def build():
    return SimpleNamespace(**runpy.run_path(str(FOLDER / "build.py")))


def largest_turn(scenario, run):
    """Of the bunny since the grip closed, up to the top [deg]."""
    bunny = scenario.system.link("bunny")
    R = np.array([scenario.system.kinematics(q).R[bunny] for q in run["q"][CLOSED : TOP + 1]])
    return np.degrees(Rotation.from_matrix(R @ R[0].T).magnitude().max())


def test_demo_prints_one_json_object_and_writes_what_it_names(demo):
    folder, printed, _ = demo
    assert set(printed["cases"]) == {"with torsion", "without torsion"}
    names = {path.name for path in folder.iterdir()}
    assert names == {
        *printed["figures"], "bunny_grasp_with_torsion.npz", "bunny_grasp_without_torsion.npz",
    }  # fmt: skip
    for name in printed["figures"]:
        assert (folder / name).stat().st_size > 1000


@pytest.mark.parametrize("case", CASES)
def test_the_bunny_starts_at_rest_and_drag_is_small_ever_after(runs, demo, case):
    run = runs[case]
    assert np.abs(run["delta_q"][:20, 7:]).max() < AT_REST
    assert_relative(run["wrench"][0, :5, 2].sum(), 0.2 * 9.81, 1e-3)
    swings = {"with_torsion": [], "without_torsion": ["lost-grip"]}
    assert [one.name for one in (*run.ignored_findings, *run.findings)] == swings[case]
    _, _, errors = demo
    assert "drag" not in errors
    assert "lost-grip" not in errors  # it slips on purpose, as a line says


def test_the_missing_force_of_the_swinging_bunny_is_that_of_a_pendulum(runs, scenario):
    """It turns about the line through the two points that hold it, and the springs give way.

    A step of T has K (q - q_bar) + J'f = 0 and M q_u / T^2 - tau + J'f = 0, J q = 0; r = -M (q_2 -
    q_1) / (T_2^2 - T_1^2) of two T, the second three times the first, in which it turns by less
    than 0.1 rad.
    """
    run = runs["without_torsion"]
    (lost,) = run.ignored_findings
    lacks = lost.numbers
    k = int(lacks["step"])
    after = k + 1  # where that step has led
    grip = np.char.startswith(run.pair_names, "grip")
    holds = grip & (run["wrench"][after, :, 2] > 0)
    assert holds.sum() == 2
    J = run["J"][after, holds, :3].reshape(6, 13)
    M, tau = run["M_u"][after], run["tau_u"][k]
    off = scenario.system.actuated_difference(run["q"][after], run["q_bar_a"][k])
    load = np.concatenate([scenario.K_q @ off, tau, np.zeros(6)])

    def way(T):
        H = np.block([[scenario.K_q, np.zeros((7, 6))], [np.zeros((6, 7)), M / T**2]])
        both = np.block([[H, J.T], [J, np.zeros((6, 6))]])
        return np.linalg.lstsq(both, load, rcond=None)[0][7:13]

    size = max(pair.beta.shape.extent for pair in scenario.pairs)
    first = np.sqrt(1e-3 * size / 9.81)
    r = -M @ (way(3 * first) - way(first)) / (8 * first**2)
    about_its_middle = r[3:] - M[3:, :3] / M[0, 0] @ r[:3]
    assert_relative(lacks["missing_Nm"], np.linalg.norm(about_its_middle), 5e-3)


def test_the_report_of_the_demo_is_that_of_the_trajectories(demo, scenario, runs):
    _, printed, _ = demo
    bunny = scenario.system.joint("bunny/base").q.start
    for case, run in runs.items():
        said = printed["cases"][case.replace("_", " ")]
        turn = largest_turn(scenario, run)
        assert_relative(said["rotation_deg"], turn)
        lift = 1e3 * (run["q"][TOP, bunny + 2] - run["q"][CLOSED, bunny + 2])
        assert_relative(said["lift_mm"], lift)
        assert (said["variables"], said["rows"], said["steps"]) == (13, 80, 300)


def test_the_runs_differ_in_mu_omega_alone(runs):
    one, two = runs.values()
    assert_same(one["mu_omega"], [0.0] * 5 + [0.003] * 10)
    assert_same(two["mu_omega"], np.zeros(15))
    for key in ("mu_v", "rows", "K_q", "q_bar_a"):
        assert_same(one[key], two[key])
    assert_same(one["q"][0], two["q"][0])


@pytest.mark.parametrize("case", CASES)
def test_every_step_has_13_variables_and_80_rows_and_is_proved(runs, case):
    run = runs[case]
    assert run["A"].shape == (300, 80, 13)
    assert run["rows"].tolist() == [4] * 5 + [6] * 10
    assert set(run["certificate"]) == {"exact"}
    assert (run["worst_residual"] < ROUNDING).all()
    assert run.failed is None


def test_the_variables_are_a_bunny_and_a_gripper_with_a_base_and_a_width(scenario):
    twist = ("x", "y", "z", "rx", "ry", "rz")
    expected = [f"gripper/base.{axis}" for axis in twist]
    expected += ["gripper/width", *(f"bunny/base.{axis}" for axis in twist)]
    assert [c.name for c in scenario.system.coordinates] == expected
    assert (scenario.system.n_a, scenario.system.n_u) == (7, 6)


def test_each_finger_lifts_the_bunny_by_one_point(runs):
    loaded = runs["with_torsion"]["wrench"][100:TOP, 5:, 2] > 0  # five contacts of each finger
    for finger in (loaded[:, :5], loaded[:, 5:]):
        assert (finger.sum(axis=1) == 1).all()


def test_the_committed_files_are_what_the_script_writes(build, tmp_path):
    build.main(out=tmp_path)
    for name in ("bunny_992.csv", "bunny.urdf"):
        assert (tmp_path / name).read_bytes() == (FOLDER / name).read_bytes()


def test_each_point_of_the_sample_is_the_farthest_from_those_before(build, rng):
    points = rng.normal(size=(60, 3))
    chosen = build.farthest_point_sample(points, 20, 7).tolist()
    assert chosen[0] == 7
    for k in range(1, 20):
        gaps = [min(sum((p - points[i]) ** 2) ** 0.5 for i in chosen[:k]) for p in points]
        assert chosen[k] == gaps.index(max(gaps))


@pytest.mark.long
@pytest.mark.parametrize(
    ("k", "mu_omega", "degrees"),
    [(1, 0.003, 0.208), (20, 0.003, 0.208), (1, 0.0, 67.617), (2, 0.0, 49.931), (20, 0.0, 49.931)],
)
def test_how_many_points_a_finger_keeps_matters_only_if_it_is_one(k, mu_omega, degrees):
    settings = {"contacts.grip.mu_omega": mu_omega, "contacts.grip.k": k, "solver.certify": "off"}
    scenario = load_scenario("bunny_grasp", settings, fast=True)
    run = scenario.run(progress=False, findings=False)
    assert largest_turn(scenario, run) == pytest.approx(degrees, abs=1e-3)
