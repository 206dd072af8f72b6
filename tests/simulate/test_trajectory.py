"""Trajectories: the same bits in and out, without pickles."""

from dataclasses import replace

import numpy as np
import pytest

from quasistatic_ref import (
    InputError,
    load_scenario,
    load_trajectory,
    save_trajectory,
    standard_form,
)
from quasistatic_ref.certify import solution
from quasistatic_ref.cli.run import worst_residual
from quasistatic_ref.optional.doctor.telling import numbers_of
from quasistatic_ref.optional.fast import joined
from quasistatic_ref.simulate.finding import finding_table
from quasistatic_ref.simulate.header import header_table
from tests.closeness import assert_same
from tests.scenes import written_scenario

SHAPES = {
    "q": (6, 10), "t": (5,), "delta_q": (5, 8), "q_bar_a": (5, 3), "phi": (5, 2),
    "alpha": (5, 2, 3), "beta": (5, 2, 3), "n": (5, 2, 3), "d1": (5, 2, 3), "d2": (5, 2, 3),
    "point": (5, 2), "lam": (5, 10), "wrench": (5, 2, 4), "worst_residual": (5,),
    "certificate": (5,), "digits": (5,),
    "H": (5, 8, 8), "g": (5, 8), "A": (5, 10, 8), "b": (5, 10), "J": (5, 2, 4, 8),
    "K_q": (5, 2, 2), "M_u": (5, 6, 6), "tau_a": (5, 2), "tau_u": (5, 6),
    "delta_q_bar_a": (5, 2), "mu_v": (2,), "mu_omega": (2,), "rows": (2,),
}  # fmt: skip
"""Of the arrays of the run."""
PROGRAMS = {"H", "g", "A", "b", "J", "K_q", "M_u", "tau_a", "tau_u", "delta_q_bar_a"}


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return written_scenario(tmp_path_factory.mktemp("scenes")).parent


@pytest.fixture(scope="module")
def scenario(folder):
    return load_scenario(folder / "scene.toml", ["solver.backend=daqp"], fast=True)


@pytest.fixture(scope="module")
def run(scenario):
    return scenario.run()


def test_the_first_axis_is_the_step_and_q_has_the_start_as_well(scenario, run):
    assert {name: array.shape for name, array in run.arrays.items()} == SHAPES
    assert_same(run["q"][0], scenario.system.q_start)
    assert_same(run["t"], [(k + 1) * 0.01 for k in range(5)])


def test_a_recorded_step_is_the_one_that_was_solved(scenario, run):
    simulator = scenario.simulator()
    targets = scenario.targets
    force = scenario.force
    for k in range(run.steps):
        t = (k + 1) * scenario.h
        q = run["q"][k]
        solved = simulator.step(q, targets(t), force(t, q))
        assert run.step_data(k) == solved.step
        assert_same(run["delta_q"][k], solved.solution.delta_q)


@pytest.mark.parametrize("changes", [["cone=ellipsoid"], ["cone=facets-6"], []])
@pytest.mark.parametrize("name", ["bunny_grasp", "arm_push"])
def test_a_recorded_program_is_the_standard_form_of_its_step(name, changes):
    limits = ["bodies.arm.joint_limits=urdf"] if name == "arm_push" else []
    run = load_scenario(name, ["solver.certify=off", *limits, *changes], steps=3).run()
    for k in range(3):
        form = standard_form(run.step_data(k))
        for matrix, recorded in zip(form, ("H", "g", "A", "b"), strict=True):
            assert (run[recorded][k] + 0.0).tobytes() == (matrix + 0.0).tobytes()


@pytest.mark.extra("fast")
@pytest.mark.parametrize("name", ["block_push", "stack", "door"])
def test_a_recorded_step_of_many_bodies_is_the_one_that_was_solved(name, tmp_path, monkeypatch):
    scenario = load_scenario(name, ["record=full"], steps=3, fast=True)
    every = scenario.run()
    monkeypatch.setattr(joined, "LARGEST", 0)
    run = scenario.run()
    assert {*every} - {*run} == {"H", "g", "A", "b"}
    assert run["J"].size == 4 * run["column"].size <= every["J"].size
    moved, all_moved = (numbers_of(each, scenario)["pairs"] for each in (run, every))
    assert moved == all_moved
    path = save_trajectory(tmp_path / "run.npz", run)
    back = load_trajectory(path)
    for k in range(3):
        assert back.step_data(k) == run.step_data(k) == every.step_data(k)
    for array in (run["column"] - 1, run["column"] + 99, run["column"] + 0.0):
        save_trajectory(path, replace(run, arrays={**run.arrays, "column": array}))
        with pytest.raises(InputError, match=r"column: must contain whole numbers of 0 to \d+"):
            load_trajectory(path)


def test_a_file_read_back_is_the_same_bits(tmp_path, run):
    back = load_trajectory(save_trajectory(tmp_path / "run.npz", run))
    assert back == run
    assert set(back.arrays) == SHAPES.keys()
    for name, array in run.arrays.items():
        assert back[name].dtype == array.dtype
        assert back[name].tobytes() == np.ascontiguousarray(array).tobytes()


def test_the_header_says_what_the_run_was(run):
    header = header_table(run.header)
    assert header.pop("quasi_dynamic_number") > 0  # their values: test_artifacts.py
    assert header.pop("largest_boundary_layer") > 0
    assert header.pop("findings") == [finding_table(found) for found in run.findings]
    assert header == {
        "format": "quasistatic-ref/trajectory",
        "version": 1,
        "h": 0.01,
        "backend": "daqp",
        "cone": "pyramid",
        "extra": [],
        "record": "full",
        "n_a": 2,
        "n_u": 6,
        "coordinates": [
            "rail/slide", "rail/turn", "ball/base.x", "ball/base.y", "ball/base.z", "ball/base.rx",
            "ball/base.ry", "ball/base.rz",
        ],
        "units": ["m", "rad", "m", "m", "m", "rad", "rad", "rad"],
        "positions": [
            "rail/slide [m]", "rail/turn.cos [-]", "rail/turn.sin [-]",
            *(f"ball.{axis} [m]" for axis in "xyz"), *(f"ball.q{axis} [-]" for axis in "xyzw"),
        ],
        "slots": ["floor(floor, ball/ball#0)/0", "push(rail/plate#0, ball/ball#0)/0"],
        "steps": 5,
        "scene": {
            "pairs": [["floor(floor, ball/ball#0)", "floor", "ball"],
                      ["push(rail/plate#0, ball/ball#0)", "rail/plate", "ball"]],
            "gravity": [0.0, 0.0, -9.81],
            "stiffness": [500.0, 2.5],
        },
        "failed": None,
        "contacts": [["floor(floor, ball/ball#0)/0", "push(rail/plate#0, ball/ball#0)/0"]] * 5,
    }  # fmt: skip


def test_it_is_a_mapping_of_its_arrays(run):
    assert "phi" in run
    assert "phii" not in run
    assert list(run) == list(run.keys()) == list(run.arrays)


def test_a_light_record_has_no_programs_and_says_so(tmp_path, folder, run):
    light = load_scenario(folder / "scene.toml", ["record=light"], fast=True).run()
    assert set(light.arrays) == SHAPES.keys() - PROGRAMS
    back = load_trajectory(save_trajectory(tmp_path / "run.npz", light))
    assert_same(back["q"], run["q"])
    with pytest.raises(InputError, match="a light record has no quadratic programs"):
        back.step_data(0)


def test_a_run_of_no_steps_is_a_trajectory(tmp_path, folder):
    empty = load_scenario(folder / "scene.toml", ["steps=0"], fast=True).run()
    back = load_trajectory(save_trajectory(tmp_path / "run.npz", empty))
    assert (back.steps, back.failed, back["q"].shape) == (0, None, (1, 10))
    assert worst_residual(back) is None


def test_a_record_of_forces_is_kept_where_those_of_one_step_are_not_found(tmp_path, monkeypatch):
    """And read back; its torque grows by 7e-4 N m a step."""
    found = solution.contact_forces

    def fails(step, near):
        if step.tau_u[5] == torque:
            raise ZeroDivisionError
        return found(step, near)

    torque = load_scenario("sphere_spin", steps=4).run()["tau_u"][2, 5]
    monkeypatch.setattr(solution, "contact_forces", fails)
    scene = load_scenario("sphere_spin", {"record": "forces"}, steps=4)
    run = load_trajectory(save_trajectory(tmp_path / "run.npz", scene.run()))
    assert np.isnan(run.forces).any(axis=(1, 2)).tolist() == [False, False, True, False]
    assert np.isnan(run.imbalance).tolist() == [False, False, True, False]
