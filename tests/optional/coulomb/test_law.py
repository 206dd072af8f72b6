"""``law = "coulomb"`` of scenarios and simulators: runs without a rise, and what is refused."""

import json

import cvxpy as cp
import numpy as np
import pytest

from quasistatic_ref import (
    Body,
    Box,
    ContactPair,
    Extension,
    InputError,
    PlacedShape,
    RunFailed,
    Simulator,
    System,
    derivatives,
    load_scenario,
    load_trajectory,
    rollout,
    save_trajectory,
    verify_answer,
)
from tests.closeness import assert_relative, assert_same
from tests.scenes import written_scenario

H = 0.01
RISE = 1e-10
"""Largest gap under load, over the slip of its step [-]: s is its own to within 1e-12 of motions
that are up to a hundred times the slip."""


@pytest.fixture(scope="module")
def plain():
    """The first 40 steps of block_push."""
    return load_scenario("block_push", steps=40, law="coulomb", fast=True).run()


def test_a_run_under_coulombs_law_lifts_nothing_off(plain):
    assert plain.header.law == "coulomb"
    s = plain["s"].max()
    assert plain.header.largest_boundary_layer < RISE * s
    rising = load_scenario("block_push", steps=40, fast=True).run()
    assert_relative(rising.header.largest_boundary_layer, s, 0.2)
    assert rising.header.law == "convex"
    assert "s" not in rising.arrays


def test_a_recorded_step_is_the_one_that_was_certified(plain, tmp_path):
    run = load_trajectory(save_trajectory(tmp_path / "run.npz", plain))
    k = int(run["s_iterations"].argmax())
    step = run.step_data(k)
    assert_same(step.contacts.phi, run["phi"][k] + run["s"][k])
    scenario = load_scenario("block_push", law="coulomb")
    q_bar = scenario.targets((k + 1) * scenario.h)
    result = scenario.simulator().step(run["q"][k], q_bar)
    assert result.solution.step == result.step == step
    assert result.solution.converged
    assert (result.points.phi == run["phi"][k]).all()
    certificate = result.solution.certificate
    assert verify_answer(step, run["delta_q"][k], certificate.active, run["lam"][k], certificate)


def test_the_command_says_how_many_iterations_there_were(tmp_path, cli):
    path = written_scenario(tmp_path)
    assert "Coulomb's law: " in cli("run", path, "--law coulomb --out", tmp_path, "--quiet").out
    said = json.loads(cli("run", path, "--law coulomb --out", tmp_path, "--json").out)
    run = load_trajectory(tmp_path / "scene.npz")
    assert said["law"] == "coulomb"
    assert said["s_iterations"] == run["s_iterations"].tolist()
    assert said["largest_s_residual"] == run["s_residual"].max()


def slot(clearance, **settings):
    """A block of 1 kg without weight between two walls, each `clearance` away [m]."""
    block = Body.of_shape("block", Box(size=(0.1, 0.1, 0.1)), 1.0)
    system = System([block])
    wall = Box(size=(2.0, 0.1, 2.0))
    pairs = [
        ContactPair(
            f"wall(wall, {side:+})",
            PlacedShape.in_world("wall", wall, (0.0, side * (0.1 + clearance), 0.0)),
            system.shapes[0], mu_v=0.5, mu_omega=0.0, rows=4, k=4,
        )
        for side in (-1, 1)
    ]  # fmt: skip
    settings = {"law": "coulomb"} | settings
    return Simulator(system, pairs, h=H, K_q=1.0, gravity=(0, 0, 0), **settings)


PUSH = 20.0 * np.eye(6)[0]


def test_a_guide_stays_locked_unless_it_has_clearance():
    """Each iterate with clearance c raises s by c: X mu / c of them lead to Coulomb's slip."""
    locked = slot(0.0)
    result = locked.step(locked.system.q_start, [], PUSH)
    assert not result.solution.delta_q.any()
    X = H**2 * 20.0
    loose = slot(X / 20)
    result = loose.step(loose.system.q_start, [], PUSH)
    assert_relative(result.solution.delta_q[0], X)
    assert 10 <= result.solution.s_iterations <= 30


def test_where_no_solution_is_found_a_run_ends_and_claims_nothing():
    """Coulomb's slip is 2 mm, and each iterate raises s by the clearance of 1 um."""
    narrow = slot(1e-6)
    message = (
        r"step 0: no solution under Coulomb's law was found in 200 iterations, which does not say "
        r"that there is none: s is still off by 1e-06 m; take a smaller h, or law = \"convex\"$"
    )
    with pytest.raises(RunFailed, match=message) as failed:
        rollout(narrow, narrow.system.q_start, [], 3, force=PUSH)
    assert failed.value.trajectory.steps == 0
    assert failed.value.step.contacts.phi == pytest.approx(1e-6)  # the step as it was posed


def test_what_the_law_does_not_take_is_refused_in_a_sentence():
    with pytest.raises(InputError, match=r"law: is not a choice; did you mean 'coulomb'\?"):
        slot(0.0, law="coulom")
    with pytest.raises(InputError, match=r'law: needs certify = "full", not "off"'):
        slot(0.0, certify="off")
    cost = slot(0.0, extension=lambda q: Extension(lambda s: [cp.norm(s.delta_q)]))
    with pytest.raises(InputError, match=r"extension: holds nonlinear constraints or costs"):
        cost.step(cost.system.q_start, [])
    tried = slot(0.0)
    with pytest.raises(InputError, match=r'law: must be "convex" for derivatives'):
        derivatives(tried, tried.system.q_start, [])
