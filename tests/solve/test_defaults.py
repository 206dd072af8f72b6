"""Which backend a run has that names none."""

import cvxpy as cp
import numpy as np
import pytest

import quasistatic_ref as qr
from quasistatic_ref import Extension, Simulator, StepNotSolved, load_scenario, solve_step
from quasistatic_ref.optional.daqp.default import DENSE_BELOW, default_backend
from quasistatic_ref.simulate.law import CONVEX, COULOMB
from tests.helpers import error, first_step, results_of
from tests.solvers import Reply
from tests.tolerances import OPTIMUM

STEP = first_step(load_scenario("sphere_spin")).step
FAILED = Reply(None, None, False, "at a loss")
UNCLAIMED = Reply(np.zeros(6), np.zeros(6), False, "iteration limit")


def test_the_default_backend_is_clarabel_and_with_fast_daqp():
    for settings, named in (
        ({}, "clarabel"),
        ({"fast": True}, "daqp"),
        ({"fast": True, "cone": "ellipsoid"}, "clarabel"),
        ({"fast": True, "solver.backend": "osqp"}, "osqp"),
        ({"solver.backend": "osqp"}, "osqp"),
        ({"solver.backend": cp.OSQP}, "osqp"),
        ({"fast": True, "solver.backend": cp.CLARABEL}, "clarabel"),
        ({"solver.backend": cp.DAQP}, "cvxpy:daqp"),
    ):
        scenario = load_scenario("sphere_spin", settings)
        assert scenario.backend == scenario.simulator().backend == named


CURVED = Extension(lambda of: [cp.norm(of.delta_q) <= 1.0])
NAMED = {
    "a step": lambda name: solve_step(STEP, name),
    "a curved extension": lambda name: solve_step(STEP, name, extension=CURVED),
    "Coulomb's law": lambda name: qr.coulomb_step(STEP, name),
    "a run": lambda name: first_step(load_scenario("sphere_spin", backend=name)).solution,
}


@pytest.mark.parametrize("named", NAMED.values(), ids=NAMED)
def test_a_word_of_cvxpy_names_a_backend_wherever_one_is_named(named):
    for word, name in ((cp.CLARABEL, "clarabel"), (cp.SCS, "scs")):
        assert named(word).backend == name
    with pytest.raises(qr.QuasistaticError, match=r"is not a backend; did you mean 'clarabel'\?"):
        named("CLARABLE")


def test_bodies_that_cannot_touch_count_one_by_one():
    """Points of two clouds over a floor: the dense J has 24 entries a contact."""
    cloud = qr.PointCloud(np.random.default_rng(0).random((DENSE_BELOW // 24, 3)))
    system = qr.System([qr.Body.of_shape(name, qr.Sphere(0.1), 1.0) for name in "ab"])
    floor = qr.PlacedShape.in_world("floor", qr.HalfSpace((0, 0, 1), 0.0))
    shapes = [qr.PlacedShape(f"c{link}", link, np.eye(3), np.zeros(3), cloud) for link in (1, 2)]
    for fewer, named in ((1, "daqp"), (0, "clarabel")):
        k = DENSE_BELOW // 24 - fewer
        pairs = [qr.ContactPair(one.name, floor, one, 0.5, 0.0, 4, k) for one in shapes]
        assert default_backend(system, pairs, "pyramid", CONVEX) == named
        assert default_backend(system, pairs, "pyramid", COULOMB) == "clarabel"
    assert default_backend(system, (), "pyramid", CONVEX) == "daqp"


@pytest.mark.parametrize("failed", [FAILED, UNCLAIMED])
def test_clarabel_takes_steps_on_which_the_default_backend_fails(failed, answers):
    scenario = load_scenario("sphere_spin", ["solver.certify=off"], fast=True, steps=4)
    backends = []
    answers("daqp", lambda _, own: failed if len(backends) in (1, 2) else own())
    for result in results_of(scenario):
        optimum = solve_step(result.step, "none").delta_q
        assert error(result.step, result.solution.delta_q, optimum) <= OPTIMUM
        backends.append(result.solution.backend)
    assert backends == ["daqp", "clarabel", "clarabel", "daqp"]


def test_a_failure_of_a_backend_that_is_named_is_that_backend_s(answers):
    answers("piqp", lambda *_: FAILED)
    settings = ["solver.certify=off", "solver.backend=piqp"]
    scenario = load_scenario("sphere_spin", settings, fast=True)
    with pytest.raises(StepNotSolved, match="piqp did not solve the step"):
        first_step(scenario)


def test_a_simulator_that_names_no_backend_takes_curved_extensions():
    scenario = load_scenario("sphere_spin")
    simulator = Simulator(scenario.system, scenario.pairs, h=scenario.h, K_q=scenario.K_q)
    of_file = load_scenario("sphere_spin", fast=True).simulator()
    for one in (simulator, of_file):
        one.extension = lambda q: Extension(lambda s: [cp.norm(s.delta_q) <= 1.0])
        answer = one.step(scenario.system.q_start, np.zeros(0)).solution
        assert (answer.backend, answer.certificate.kind) == ("clarabel", "residual")
