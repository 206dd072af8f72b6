"""Forces on bodies and of pairs: against the rows that were solved, and against plain loops."""

import copy
import pickle
from dataclasses import replace

import numpy as np
import pytest

from quasistatic_ref import InputError, ModelError, load_scenario, load_trajectory, save_trajectory
from quasistatic_ref.simulate.scene import Scene
from tests.closeness import assert_close, assert_relative, assert_same, assert_within
from tests.scenes import SWING, written_scenario
from tests.tolerances import ROUNDING


@pytest.fixture(scope="module")
def scenario(tmp_path_factory):
    """A plate pushes a ball over the floor; 5 mm apart at the start."""
    return load_scenario(written_scenario(tmp_path_factory.mktemp("scene")), steps=40, fast=True)


@pytest.fixture(scope="module")
def run(scenario):
    done = scenario.run()
    push = done["wrench"][:, 1]
    assert (np.abs(push[:, 2]) > 0).any()  # the plate does reach the ball
    return done


def test_a_wrench_does_to_the_coordinates_what_the_rows_did(scenario, run):
    """J' w = A' lam / h: the ball is beta of the floor and of the plate, the plate is alpha."""
    system = scenario.system
    ball = run.wrench_on("ball")
    plate = run.wrench_on("rail/plate")
    for k in range(run.steps):
        J = system.kinematics(run["q"][k]).J
        both = J[system.link("ball")].T @ ball[k] + J[system.link("rail/plate")].T @ plate[k]
        assert_close(both, run["A"][k].T @ run["lam"][k] / run.header.h, ROUNDING)


def test_forces_of_pairs_add_up_to_those_of_the_body(scenario, run):
    forces = run.pair_forces()
    assert list(forces) == [pair.name for pair in scenario.pairs]
    floor, push = forces.values()
    assert_within(floor + push, run.forces_on("ball")[:, :3], ROUNDING)
    assert_within(-push, run.forces_on("rail")[:, :3], ROUNDING)
    assert_relative(floor[:, 2], run.forces[:, 0, 2], ROUNDING)
    # Multipliers are unique here: the compliance alone makes a difference.
    off = np.abs(run.forces - run["wrench"]).max()
    assert 0 < off < 1e-4 * run["wrench"].max()


def test_a_record_of_forces_has_those_of_the_steps(scenario, run, tmp_path):
    kept = load_scenario(scenario.path, steps=40, fast=True, record="forces").run()
    assert_same(kept["forces"], run.forces)
    read = load_trajectory(save_trajectory(tmp_path / "forces.npz", kept))
    assert_same(read.forces, kept.forces)
    assert "A" not in read.arrays
    assert_same(read.step_forces(3), run.forces[3])
    for name, force in run.pair_forces().items():
        assert_same(read.pair_forces()[name], force)


@pytest.mark.parametrize("fast", [False, True])
def test_a_full_record_holds_no_forces_and_files_that_do_are_read(scenario, run, tmp_path, fast):
    full = load_scenario(scenario.path, steps=40, fast=fast).run()
    assert "forces" not in full.arrays
    assert_same(full.forces, run.forces)
    stored = replace(full, arrays={**full.arrays, "forces": full.forces + 1.0})
    read = load_trajectory(save_trajectory(tmp_path / "stored.npz", stored))
    assert_same(read.forces, full.forces + 1.0)


def test_a_light_record_holds_no_forces(scenario):
    light = load_scenario(scenario.path, steps=2, fast=True, record="light").run()
    with pytest.raises(InputError, match="a light record holds no forces; run again with record"):
        light.pair_forces()


@pytest.mark.parametrize("fast", [False, True])
def test_a_result_has_the_forces_by_contact_pair_and_body(scenario, run, fast):
    simulator = load_scenario(scenario.path, fast=fast).simulator()
    k = int(np.argmax(run["wrench"][:, 1, 2]))
    result = simulator.step(run["q"][k], run["q_bar_a"][k])
    assert_same(result.forces, run.forces[k])
    for name, force in run.pair_forces().items():
        assert_same(result.pair_forces()[name], force[k])
    for name in ("ball", "rail/plate"):
        assert_same(result.forces_on(name), run.forces_on(name)[k])
    with pytest.raises(InputError, match="scene: is not known: this result is a copy"):
        pickle.loads(pickle.dumps(result)).pair_forces()


def test_a_trajectory_from_a_file_or_a_pickle_is_given_its_scene(scenario, run, tmp_path):
    for other in (
        load_trajectory(save_trajectory(tmp_path / "run.npz", run)),
        pickle.loads(pickle.dumps(run)),
    ):
        with pytest.raises(InputError, match=r"^scene: is not known: .* is from a file"):
            other.wrench_on("ball")
        scenes = (scenario, scenario.simulator(), Scene(scenario.system, scenario.pairs))
        for scene in scenes:
            assert_same(other.wrench_on("ball", scene), run.wrench_on("ball"))
    assert copy.copy(run)["q"] is run["q"]


def test_other_names_and_scenes_are_refused(run, tmp_path):
    with pytest.raises(ModelError, match="link: is not a link; did you mean 'ball'"):
        run.wrench_on("bal")
    for body, other in (("held", "two_finger_pinch"), ("post", written_scenario(tmp_path, SWING))):
        with pytest.raises(InputError, match="scene: must be that of the steps"):
            run.wrench_on(body, load_scenario(other))
