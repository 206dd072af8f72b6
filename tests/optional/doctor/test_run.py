"""Findings of what steps did not represent: what triggers each, and the near miss that does not."""

import numpy as np
import pytest

from quasistatic_ref.optional.doctor.leaps import leaps
from quasistatic_ref.optional.doctor.start import Start
from quasistatic_ref.optional.doctor.sunk import sunk
from quasistatic_ref.optional.doctor.targets import beyond_limits, half_turns
from quasistatic_ref.optional.doctor.units import far_targets, large_mu_omega
from quasistatic_ref.scenario.scenario import load_scenario
from quasistatic_ref.simulate.simulator import Simulator
from quasistatic_ref.simulate.trajectory import Trajectory, trajectory_read
from quasistatic_ref.tolerances import BEYOND, IN_METRES, LEAP, SUNK
from tests.scenes import chain_scene, written_scenario


@pytest.fixture(scope="module")
def scene(tmp_path_factory):
    """A ball of radius 0.05 m, a floor, and a plate that slides along x from -1 m to 1 m."""
    return written_scenario(tmp_path_factory.mktemp("scene"))


def test_a_file_from_before_there_were_findings_has_none(scene, tmp_path):
    run = load_scenario(scene, fast=True).run(progress=False)
    header = {key: value for key, value in run.header.items() if key != "findings"}
    path = Trajectory(header | {"warnings": ["a sentence"]}, run.arrays).save(tmp_path / "old.npz")
    assert trajectory_read(path).findings == ()


class Made(Start):
    """The record of a run in which nothing happens, but for `changes`."""

    def __init__(self, simulator, steps=3, **changes):
        super().__init__(simulator, simulator.system.q_start)
        system, n_c = self.system, sum(pair.n_c for pair in self.pairs)
        still = {
            "phi": np.zeros((steps, n_c)),
            "point": np.zeros((steps, n_c), dtype=int),
            "delta_q": np.zeros((steps, system.n_v)),
            "q": np.tile(system.q_start, (steps + 1, 1)),
            "q_bar_a": np.tile(system.q_start[: system.n_q_a], (steps, 1)),
            "gap": np.zeros((steps, n_c)),
        }
        self.arrays = still | changes

    def __getitem__(self, name):
        return self.arrays[name]

    noted = __getitem__


def sentences(found, scenario, **changes):
    run = Made(scenario.simulator(), **changes)
    return [f"{said.remedy}: {said.cause}" for said in found(run)]


@pytest.mark.parametrize(("share", "gap", "warned"), [
    (1.01, 0.0, True),  # deeper than a hundredth of the ball's diameter, and predicted to touch
    (0.99, 0.0, False),
    (1.01, -1.01 * SUNK * 0.1, False),  # as deep as the step before predicted
    (1.01, -0.02 * SUNK * 0.1, False),  # all but 0.99 of it was
])  # fmt: skip
def test_a_contact_that_sinks_unpredicted_needs_shorter_steps(scene, share, gap, warned):
    phi = np.zeros((3, 2))
    phi[2, 0] = -share * SUNK * 0.1
    said = sentences(sunk, load_scenario(scene, fast=True), phi=phi, gap=np.full((3, 2), gap))
    depth = share * SUNK * 100.0
    sentence = (
        "take a smaller h or move slower: candidate 0 of floor(floor, ball/ball#0) is "
        f"{depth:.3g} mm deep at step 2; the step before, which is right to first order, left it "
        "at 0 mm"
    )
    assert said == ([sentence] if warned else [])


def test_a_pair_of_solids_that_could_keep_more_contacts_is_asked_for_k(scene):
    # push: a box against a ball has 8 corners and the closest pair, of which one is kept.
    phi = np.zeros((3, 2))
    phi[1, 1] = -2 * SUNK * 0.1
    (said,) = sentences(sunk, load_scenario(scene, fast=True), phi=phi)
    assert said.startswith("take a smaller h or move slower, or raise k of contacts.push: ")
    # Two are kept: a corner that was not one of them is a contact that k left out.
    scenario = load_scenario(scene, ["contacts.push.k=2"], fast=True)
    phi, point = np.zeros((3, 3)), np.array([[0, 8, 3], [0, 8, 3], [0, 5, 8]])
    phi[2, 1] = -2 * SUNK * 0.1
    (said,) = sentences(sunk, scenario, phi=phi, point=point)
    assert said == (
        "raise k of contacts.push: point 5 of push(rail/plate#0, ball/ball#0) was not among its 2 "
        "closest at step 1 and is 2 mm deep at step 2"
    )


@pytest.mark.parametrize(("entry", "motion", "words"), [
    (2, 1.01 * LEAP * 0.1, "ball/base.x moves"), (2, 0.99 * LEAP * 0.1, None),
    (5, 1.01 * LEAP, "turns by 14.5 degrees"), (5, 0.99 * LEAP, None),
    (0, 1.01 * LEAP * 0.2, "rail/slide moves by 50.5 mm"), (0, 0.99 * LEAP * 0.2, None),
    (1, 7.0, None),  # the wheel touches nothing
])  # fmt: skip
def test_a_step_that_moves_a_body_by_a_quarter_of_its_size_is_named(scene, entry, motion, words):
    delta_q = np.zeros((3, 8))
    delta_q[1, entry] = motion
    said = sentences(leaps, load_scenario(scene, fast=True), delta_q=delta_q)
    assert len(said) == (words is not None)
    if words is not None:
        assert words.replace("base.x", "base") in said[0]
        assert ", in step 1, " in said[0]


@pytest.mark.parametrize(("target", "words"), [
    (1.0, None), (-1.0, None), (1.0 + BEYOND / 2, None),
    (1.5, "1.5 m at step 2, or the limit in its URDF, 1 m"),
    (-1.5, "-1.5 m at step 2, or the limit in its URDF, -1 m"),
    (1.01 * IN_METRES, "check the unit of the targets of rail/slide: lengths are in metres"),
])  # fmt: skip
def test_a_target_beyond_the_limits_of_a_urdf_is_named(scene, target, words):
    # (cos, sin) of the wheel's angle: it is continuous and has no limits.
    q_bar_a = np.array([[0.0, 1.0, 0.0], [0.0, 1.0, 0.0], [target, 1.0, 0.0]])
    scenario = load_scenario(scene, fast=True)
    said = [
        s for f in (far_targets, beyond_limits) for s in sentences(f, scenario, q_bar_a=q_bar_a)
    ]
    assert len(said) == (words is not None)
    assert words is None or words in said[0]


@pytest.mark.parametrize(("mu_omega", "warned"), [(0.1, False), (0.101, True), (20.0, True)])
def test_a_mu_omega_longer_than_the_smaller_body_looks_like_millimetres(scene, mu_omega, warned):
    scenario = load_scenario(scene, {"contacts.floor.mu_omega": mu_omega}, fast=True)
    sentence = (
        "check the unit of mu_omega of contacts.floor: it is a length in metres, and "
        f"{mu_omega:.3g} m is more than the size of the smaller body, 0.1 m"
    )
    assert sentences(large_mu_omega, scenario) == ([sentence] if warned else [])


@pytest.mark.parametrize("name", ["arm/spin", "arm/base"])
@pytest.mark.parametrize(("angles", "step"), [
    ([3.0, 3.1, 3.2, 3.3], 2),  # from here on the shorter way is the other one
    ([3.0, 3.1, 3.0, 2.9], None),
    ([1.0, 0.1, -0.1, -1.0], None),
    ([-3.0, -3.2, -3.0, 0.0], 1),
])  # fmt: skip
def test_a_target_that_is_half_a_turn_ahead_is_named(tmp_path, name, angles, step):
    system = chain_scene(tmp_path)
    axis = np.zeros(system.n_v)
    axis[system.joint(name).v] = [0, 0, 0, 0.6, 0, 0.8] if name == "arm/base" else 1.0
    q = system.integrate(system.q_start, 0.3 * np.ones(system.n_v))
    targets = np.array([system.integrate(q, a * axis)[: system.n_q_a] for a in angles])
    K_q = np.eye(system.n_a)
    run = Made(Simulator(system, [], h=0.01, K_q=K_q), 4, q=np.tile(q, (5, 1)), q_bar_a=targets)
    assert [said.numbers for said in half_turns(run)] == ([{"step": step}] if step else [])
    assert all(said.cause.startswith(f"{name} lags its target") for said in half_turns(run))
