"""Many steps from one state: each is the step that a cold simulator takes."""

from itertools import islice

import numpy as np
import pytest

import quasistatic_ref as qr
from quasistatic_ref.simulate.steps import ReachBound
from tests.cases import cases
from tests.files.urdf.urdf_texts import joint, link, robot
from tests.helpers import results_of
from tests.made import bits
from tests.model.mechanisms import every_joint

N = 5


def place(name, *settings, extension=None):
    """A simulator some steps into a scene, the state there, N targets and N loads."""
    scenario = qr.load_scenario(name, settings)
    simulator = scenario.simulator(extension)
    *_, last = islice(results_of(scenario, simulator), 3)
    here = last.end
    rng = np.random.default_rng(0)
    moves = 1e-4 * rng.normal(size=(N, scenario.system.n_v))
    targets = here.plus_each(moves)[:, : scenario.system.n_q_a]
    return simulator, here, targets, 0.1 * rng.normal(size=(N, scenario.system.n_v))


KINDS = {
    "daqp": ("bunny_grasp", "solver.backend=daqp"),
    "daqp, several bodies": ("stack", "solver.backend=daqp"),
    "daqp, unproved": ("two_finger_pinch", "solver.backend=daqp", "solver.certify=off"),
    "daqp, residuals": ("door", "solver.backend=daqp", "solver.certify=residual"),
    "clarabel": ("block_push",),
    "clarabel, unproved": ("arm_push", "solver.certify=off"),
    "none": ("stack", "solver.backend=none"),
    "the ellipsoid": ("sphere_spin", "cone=ellipsoid"),
    "Coulomb's law": ("block_push", "law=coulomb"),
}


def data(result):
    """The bits of a result, without times and statistics."""
    said = result.solution
    kind = said.certificate.kind
    return bits((result.q, result.step, result.points, said.delta_q, said.lam, kind))


GUIDE = qr.Extra(("guide",), np.ones((1, 16)), [1e-6])


@pytest.mark.parametrize("extension", [None, lambda q: qr.Extension(rows=GUIDE)], ids=["", "guide"])
def test_steps_of_one_target_have_the_sums_of_forces_and_the_rows_of_each_step(extension):
    place_of = "two_finger_pinch", "solver.backend=daqp"
    simulator, here, targets, loads = place(*place_of, extension=extension)
    results = simulator.steps(here, targets[0], loads)
    pairs = results.pair_forces()
    for k in range(N):
        expected = simulator.step(here, targets[0], loads[k])
        assert data(results[k]) == data(expected)
        assert expected.step.extra.names == (GUIDE.names if extension else ())
        assert bits(results.forces_on("held")[k]) == bits(expected.forces_on("held"))
        assert all(bits(pairs[name][k]) == bits(f) for name, f in expected.pair_forces().items())


@cases("words", KINDS)
def test_steps_at_once_are_those_of_a_cold_simulator_in_any_order(words):
    simulator, here, targets, loads = place(*words)
    kept = simulator.solver
    results = simulator.steps(here, targets, loads)
    assert simulator.solver is kept
    for k in range(N):
        simulator.start_cold()
        expected = simulator.step(here, targets[k], loads[k])
        assert data(results[k]) == data(expected)
        said = expected.q, expected.solution.delta_q, expected.solution.lam
        assert bits((results.q[k], results.delta_q[k], results.lam[k])) == bits(said)
    backwards = simulator.steps(here, targets[::-1], loads[::-1])
    assert bits(backwards.delta_q[::-1].copy()) == bits(results.delta_q)
    assert len(results[1:3]) == 2
    assert repr(results) == "<Steps: 5 steps from one state>"


@pytest.mark.parametrize("n_a", [1, 2, 6, 12])
def test_unproved_steps_of_a_group_without_rows_are_those_of_each_alone(n_a, rng):
    """Coupled springs of hands that touch nothing: whatever LAPACK does of several right sides."""
    slides = [link("world")]
    for k in range(n_a):
        slides.append(link(f"l{k}"))
        slides.append(joint(f"j{k}", "world", f"l{k}", "prismatic", "1 0 0"))
    A = rng.normal(size=(n_a, n_a))
    system = qr.System([qr.Body("hand", robot(*slides), actuated="all")])
    K_q = A @ A.T + np.eye(n_a)
    simulator = qr.Simulator(system, [], h=0.01, K_q=K_q, backend="daqp", certify="off")
    q = system.q_start
    loads = rng.normal(size=(9, n_a))
    many = simulator.steps(q, q, loads)
    for k, load in enumerate(loads):
        assert bits(many.delta_q[k]) == bits(simulator.step(q, q, load).solution.delta_q)
        assert bits(many.delta_q[k]) == bits(simulator.steps(q, q, load).delta_q[0])


@pytest.mark.parametrize("certify", ["off", "residual", "full"])
@pytest.mark.parametrize("depth", [1e-3, 0.03])
def test_loads_that_begin_deep_are_those_of_a_cold_simulator(depth, certify, rng):
    """Of 10 g, which the push out of the floor moves by more than the loads do."""
    block = qr.Body.of_shape("b", qr.Box((0.05, 0.05, 0.05)), 0.01, xyz=(0.0, 0.0, 0.05 - depth))
    system = qr.System([block])
    floor = qr.PlacedShape.in_world("floor", qr.HalfSpace((0, 0, 1), 0.0))
    pair = qr.ContactPair("c", floor, system.shapes[0], 0.5, 0.0, 4, 8)
    simulator = qr.Simulator(system, [pair], h=0.01, backend="daqp", certify=certify)
    here = system.at(system.q_start).plus(0.01 * np.array([0, 0, 0, 1, 2, 30]))
    loads = 0.1 * rng.normal(size=(N, 6))
    results = simulator.steps(here, [], loads)
    for result, load in zip(results, loads, strict=True):
        simulator.start_cold()
        assert data(result) == data(simulator.step(here, [], load))


def test_steps_at_once_refuse_a_target_or_load_as_a_step_does():
    simulator, here, targets, loads = place("bunny_grasp", "solver.backend=daqp")
    wrong = np.zeros((N, 1))
    wrong[2] = np.nan
    for both in ((targets + wrong, loads), (targets, loads + wrong)):
        with pytest.raises(qr.QuasistaticError) as of_step:
            simulator.step(here, *(each[2] for each in both))
        with pytest.raises(type(of_step.value)) as of_steps:
            simulator.steps(here, *both)
        assert str(of_steps.value) == str(of_step.value)
    far = loads.copy()
    far[3, 0] = 1e9
    for error, says, both in (
        (qr.ModelError, r"^targets: must have shape \(N, n_q_a\) = \(5, 8\)", (targets[:, :3],)),
        (qr.StepDataError, r"^force: must have shape \(N, n_v\)", (targets, loads[:, :3])),
        (qr.ModelError, r"must have shape .*, or \(8,\) for all", (targets[:2], loads)),
        (qr.QuasistaticError, r"limits\.reach", (targets, far)),
    ):
        with pytest.raises(error, match=says):
            simulator.steps(here, *both)
    none = simulator.steps(here, targets[:0])
    assert (none.q.shape, none.delta_q.shape) == ((0, here.q.size), (0, simulator.system.n_v))


def test_a_step_that_daqp_does_not_solve_is_replaced_as_by_a_step(monkeypatch):
    from quasistatic_ref.optional.daqp.solver import Workspace

    simulator, here, targets, loads = place("sphere_spin", "solver.backend=daqp",
                                            "solver.certify=off")  # fmt: skip
    honest = Workspace.cold

    def cold(self, *arguments):
        x, lam, flags, iterations = honest(self, *arguments)
        return x, lam, np.where(np.arange(N) == 1, -4, flags), iterations

    monkeypatch.setattr(Workspace, "cold", cold)
    results = simulator.steps(here, targets, loads)
    backends = [result.solution.backend for result in results]
    assert backends == ["daqp", "clarabel", "daqp", "daqp", "daqp"]
    assert results[1].solution.statistics.unanswered
    assert bits(results.delta_q[1]) == bits(results[1].solution.delta_q)


def test_sums_of_many_changes_have_the_bits_of_each(rng):
    system = every_joint()
    here = system.at(system.integrate(system.q_start, rng.normal(size=system.n_v)))
    changes = rng.normal(size=(7, system.n_v)) * 10.0 ** rng.integers(-9, 1, size=(7, 1))
    changes[0] = 0.0
    ends = here.plus_each(changes)
    assert bits(ends) == bits(np.array([here.plus(one).q for one in changes]))
    targets = ends[:, : system.n_q_a]
    apart = np.array([here.change_to(one) for one in targets])
    assert bits(here.changes_to(targets)) == bits(apart)
    with pytest.raises(qr.ModelError, match="length one"):
        here.changes_to(2 * targets)


def test_no_link_comes_farther_than_the_bound_of_its_ways(rng):
    system = every_joint()
    ways = ReachBound(system)
    for size in (1e-3, 0.1, 1.0, 10.0):
        here = system.at(system.integrate(system.q_start, rng.normal(size=system.n_v)))
        changes = size * rng.normal(size=(20, system.n_v))
        changes[0] = 0.0
        bounds = ways.farthest(here.kinematics.t, changes)
        ends = [here.plus(change).kinematics.t for change in changes]
        far = np.linalg.norm(ends, axis=2).max(axis=1)
        assert (far <= bounds).all()
        assert bounds[0] <= far[0] * (1 + 1e-8)


def planar_push(certify):
    """A scenario in which a finger pushes a box on a floor whose friction is in private rises."""
    finger = qr.Body.of_shape(
        "finger", qr.Sphere(0.008), 0.05, base="planar", actuated=["base"], xyz=(0, -0.0279, 0.015)
    )
    box = qr.Body.of_shape("box", qr.Box((0.02, 0.02, 0.015)), 0.3, base="planar")
    bodies = {
        "finger": {"body": finger, "K_q": {"base": [500, 500, 1]}},
        "box": {"body": box, "support": {"mu_v": 0.3, "mu_omega": 0.012}},
    }
    push = {"alpha": "finger", "beta": "box", "mu_v": 0.3, "rows": 4}
    words = {"h": 0.02, "steps": 1, "bodies": bodies, "contacts": {"push": push}}
    return qr.load_scenario(words, {"solver.certify": certify}, backend="daqp")


COST = qr.Extra((), np.zeros((0, 6)), [], H=np.diag([0, 0, 0, 2.0, 1, 0]), g=np.full(6, 1e-4))
STOP = qr.Extra(("stop",), np.array([[0, -1.0, 0, 0, -1, 0]]), [-1e-3])
EXTENSIONS = {
    "support": None,
    "a row": lambda q: qr.Extension(rows=STOP),
    "a cost": lambda q: qr.Extension(rows=COST),
    "a term": lambda q: qr.Extension(terms=lambda x: [x.delta_q_u[0] <= 1e-4]),
    "a term of the target": lambda q: qr.Extension(
        terms=lambda x: [x.delta_q_a[0] <= 0.5 * x.delta_q_bar_a[0]]
    ),
}


@pytest.mark.parametrize("certify", ["full", "off"])
@cases("extension", EXTENSIONS)
def test_steps_with_an_extension_are_those_of_a_cold_simulator(extension, certify):
    scenario = planar_push(certify)
    simulator = scenario.simulator(extension) if extension else scenario.simulator()
    q = scenario.system.q_start
    rng = np.random.default_rng(0)
    targets = q[:4] + np.hstack([[0.0, 0.004] + 2e-3 * rng.normal(size=(N, 2)), np.zeros((N, 2))])
    loads = 0.1 * rng.normal(size=(N, scenario.system.n_v))
    results = simulator.steps(q, targets, loads)
    for k in range(N):
        simulator.start_cold()
        expected = simulator.step(q, targets[k], loads[k])
        said = expected.q, expected.solution.delta_q[:6], expected.solution.lam
        assert bits((results.q[k], results.delta_q[k], results.lam[k])) == bits(said)
        assert data(results[k]) == data(expected)
    assert len(simulator.steps(q, targets[:0], loads[:0])) == 0
    assert np.ptp(results.delta_q, axis=0)[:5].min() > 1e-5  # the box moves, too


def test_what_is_numbers_alone_is_asked_for_once():
    asked = []
    scenario = planar_push("off")
    simulator = scenario.simulator(lambda q: asked.append(q) or qr.Extension(rows=STOP))
    simulator.steps(scenario.system.q_start, np.zeros((9, 4)) + scenario.system.q_start[:4])
    assert len(asked) == 1
