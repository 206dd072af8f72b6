"""Trajectories: the same bits in and out, without pickles."""

import re
from dataclasses import replace
from typing import get_type_hints

import numpy as np
import pandas as pd
import pytest
from numpy.typing import NDArray

from quasistatic_ref import (
    Body,
    ContactPair,
    InputError,
    PlacedShape,
    PointCloud,
    Recorder,
    RunFailed,
    Simulator,
    Sphere,
    System,
    Trajectory,
    load_scenario,
    load_trajectory,
    save_trajectory,
    standard_form,
)
from quasistatic_ref.files.finding import finding_table
from quasistatic_ref.files.trajectory import header_table
from quasistatic_ref.parts import part
from quasistatic_ref.simulate.record.table import ARRAYS
from tests.closeness import assert_same
from tests.helpers import results_of
from tests.scenes import written_scenario

SHAPES = {
    "q": (6, 10), "q_bar_a": (5, 3), "wrench": (5, 2, 4), "H": (5, 8, 8), "A": (5, 10, 8),
    "J": (5, 2, 4, 8), "K_q": (5, 2, 2), "M_u": (5, 6, 6), "tau_u": (5, 6),
    **dict.fromkeys(("t", "worst_residual", "certificate", "digits"), (5,)),
    **dict.fromkeys(("alpha", "beta", "n", "d1", "d2"), (5, 2, 3)),
    **dict.fromkeys(("phi", "point", "tau_a", "delta_q_bar_a"), (5, 2)),
    **dict.fromkeys(("delta_q", "g"), (5, 8)),
    **dict.fromkeys(("lam", "b"), (5, 10)),
    **dict.fromkeys(("mu_v", "mu_omega", "rows"), (2,)),
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
    """In a run from the end of the step before, a state; here from its q."""
    for k, solved in enumerate(results_of(scenario)):
        assert run.step_data(k) == solved.step
        assert_same(run["delta_q"][k], solved.solution.delta_q)
        assert run["q"][k + 1].tobytes() == solved.q.tobytes() == solved.end.q.tobytes()


@pytest.mark.parametrize("cone", ["ellipsoid", "facets-6", "pyramid"])
@pytest.mark.parametrize(
    ("name", "more"), [("bunny_grasp", {}), ("arm_push", {"bodies.arm.joint_limits": "urdf"})]
)
def test_a_recorded_program_is_the_standard_form_of_its_step(name, more, cone):
    run = load_scenario(name, {"cone": cone} | more, certify="off", steps=3).run()
    for k in range(3):
        form = standard_form(run.step_data(k))
        for matrix, recorded in zip(form, ("H", "g", "A", "b"), strict=True):
            assert (run[recorded][k] + 0.0).tobytes() == (matrix + 0.0).tobytes()


def test_a_full_record_of_very_many_contacts_is_refused_before_the_first_step():
    """A ball that has 41,667 contacts with a cloud: J has 4 * 6 entries for each."""
    system = System([Body.of_shape("ball", Sphere(0.1), 1.0)])
    points = PointCloud(np.random.default_rng(0).random((41_667, 3)))
    dust = PlacedShape.in_world("dust", points)
    pair = ContactPair("dust", dust, system.shapes[0], 0.5, 0.0, 4, k=41_667)
    simulator = Simulator(system, [pair], h=0.01)
    with pytest.raises(InputError, match=r"has 1000008 entries.*; say record = \"light\""):
        Recorder(simulator, system.q_start, "full")
    assert Recorder(simulator, system.q_start, "light").steps == 0


def test_a_file_read_back_is_the_same_bits(tmp_path, run):
    back = load_trajectory(save_trajectory(tmp_path / "run.npz", run))
    assert back == run
    assert set(back.arrays) == SHAPES.keys()
    for name, array in run.arrays.items():
        assert back[name].dtype == array.dtype
        assert back[name].tobytes() == np.ascontiguousarray(array).tobytes()


def test_the_attributes_of_a_trajectory_have_the_types_of_its_arrays():
    formed = {"forces", "imbalance"}  # where a record has none
    table = {name: NDArray[one.dtype] for name, one in ARRAYS.items() if name not in formed}
    assert get_type_hints(Trajectory.__base__) == table


@pytest.mark.parametrize("share", [0.99e-4, 1.01e-4])
def test_forces_that_leave_a_ten_thousandth_of_the_load_are_doubted(share, recwarn):
    run = load_scenario("sphere_spin", steps=2, record="forces").run(progress=False)
    one = replace(run, arrays={**run.arrays, "imbalance": np.array([np.inf, share])})
    assert_same(one.forces, run["forces"])
    said = [str(each.message) for each in recwarn]
    words = "forces of single contacts leave 1.0e-04 of the load: read wrench in their place, or "
    assert said == [f"{words}raise mu_v or mu_omega"] * (share > 1e-4)


def test_the_header_says_what_the_run_was(run):
    header = header_table(run.header)
    slots = ["floor(floor, ball/ball#0)/0", "push(rail/plate#0, ball/ball#0)/0"]
    assert header.pop("quasi_dynamic_number") > 0  # their values: test_artifacts.py
    assert header.pop("largest_boundary_layer") > 0
    assert re.fullmatch("[0-9a-f]{64}", header.pop("scene_sha256"))
    assert header.pop("findings") == [finding_table(found) for found in run.findings]
    assert header == {
        "format": "quasistatic-ref/trajectory",
        "version": 2,
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
        "slots": slots,
        "steps": 5,
        "failed": None,
        "contacts": [slots] * 5,
    }  # fmt: skip


def test_a_trajectory_is_a_mapping_of_its_arrays(run):
    assert "phi" in run
    assert "phii" not in run
    assert list(run) == list(run.keys()) == list(run.arrays)
    assert len(run) == len(run.arrays) == len(dict(run)) > run.steps == 5
    assert run.get("phii") is None
    assert run._ipython_key_completions_() == list(run)


AS_ONE_ARRAY = {
    "asarray": np.asarray, "with a type": lambda run: np.asarray(run, np.float64),
    "array": np.array, "stack": lambda run: np.stack([run, run]), "sum": np.sum,
    "times": lambda run: np.ones(3) * run, "frame": pd.DataFrame,
}  # fmt: skip


@pytest.mark.parametrize("read", AS_ONE_ARRAY.values(), ids=AS_ONE_ARRAY)
def test_a_trajectory_is_not_one_array_and_names_the_table(run, read):
    with pytest.raises(InputError, match=r"run\.to_pandas\(\)"):
        read(run)


def test_a_light_record_has_no_programs_and_says_so(tmp_path, folder, run):
    light = load_scenario(folder / "scene.toml", ["record=light"], fast=True).run()
    assert set(light.arrays) == SHAPES.keys() - PROGRAMS
    back = load_trajectory(save_trajectory(tmp_path / "run.npz", light))
    assert_same(back["q"], run["q"])
    with pytest.raises(InputError, match="a light record has no quadratic programs"):
        back.step_data(0)


@pytest.mark.parametrize("record", ["full", "light", "forces"])
@pytest.mark.parametrize("law", ["convex", "coulomb"])
def test_a_run_of_no_steps_and_one_that_fails_at_once_are_trajectories(folder, record, law):
    settings = [f"record={record}", f"law={law}"]
    none = load_scenario(folder / "scene.toml", [*settings, "steps=0"], fast=True).run()
    with pytest.raises(RunFailed) as failure:  # 0.5 m deep
        load_scenario(folder / "scene.toml", [*settings, "shapes.floor.halfspace.offset=0.5"]).run()
    for run in (none, failure.value.trajectory):
        assert run.steps == 0
        assert load_trajectory(save_trajectory(folder / "run.npz", run)) == run
        assert run.mu_v.tolist() == [0.5, 0.3]
        # Without the 5 steps 5 rows are none and the 6 of q are its start.
        shapes = {name: run[name].shape for name in SHAPES if record == "full" or name in run}
        assert shapes == {name: (SHAPES[name][0] % 5, *SHAPES[name][1:]) for name in shapes}
        assert run.wrench_on("ball").shape == (0, 6)
        if record != "light":
            assert run.forces.shape == (0, 2, 4)
            assert run.forces_on("ball").shape == (0, 6)
            assert {force.shape for force in run.pair_forces().values()} == {(0, 3)}


def test_spoilt_names_are_refused_and_every_array_of_another_shape(tmp_path):
    run = load_scenario("stack", {"law": "coulomb"}, steps=2).run(progress=False, findings=False)
    n_c = run["rows"].size
    names = run.header.contacts
    refused = [
        ("slots: must have", {"slots": run.header.slots[:-1]}, {}),
        ("unanswered: must be numbers of steps", {"unanswered": ("x", 2.5)}, {}),
        ("unanswered: must be", {"unanswered": (1, 0)}, {}),
        (f"contacts\\[1\\]: must be {n_c} names", {"contacts": (names[0], names[1][:-1])}, {}),
        ("certificate: must contain numbers", {}, {"certificate": np.zeros(2)}),
    ]
    for name, array in run.arrays.items():
        cut = (np.delete(array, -1, axis) for axis in range(array.ndim) if array.shape[axis])
        other = [*cut, array[..., None]]
        refused += [(r"\w: must have (shape|\d+ entries)", {}, {name: one}) for one in other]
    for words, fields, arrays in refused:
        header = replace(run.header, **fields)
        spoilt = replace(run, header=header, arrays=run.arrays | arrays)
        path = save_trajectory(tmp_path / "run.npz", spoilt)
        with pytest.raises(InputError, match=words):
            load_trajectory(path)
    assert load_trajectory(save_trajectory(tmp_path / "run.npz", run)) == run


def test_a_record_of_forces_is_kept_where_those_of_one_step_are_not_found(tmp_path, monkeypatch):
    """And read back; its torque grows by 7e-4 N m a step."""
    found = part("contact_forces")

    def fails(step, *others):
        if step.tau_u[5] == torque:
            raise ZeroDivisionError
        return found(step, *others)

    torque = load_scenario("sphere_spin", steps=4).run()["tau_u"][2, 5]
    monkeypatch.setattr("quasistatic_ref.optional.forces.forces.contact_forces", fails)
    scene = load_scenario("sphere_spin", {"record": "forces"}, steps=4)
    run = load_trajectory(save_trajectory(tmp_path / "run.npz", scene.run()))
    assert np.isnan(run.forces).any(axis=(1, 2)).tolist() == [False, False, True, False]
    assert np.isnan(run.imbalance).tolist() == [False, False, True, False]
