"""Steps by compiled code against those of the plain path: equal bits, signs of zeros included."""

import pickle
from dataclasses import replace
from itertools import cycle

import numpy as np
import pytest

from quasistatic_ref import (
    Body,
    ContactPair,
    Extension,
    FastSimulator,
    HalfSpace,
    InputError,
    ModelError,
    PointCloud,
    Simulator,
    System,
    load_scenario,
    standard_form,
)
from quasistatic_ref.certify.groups import group_step, groups
from quasistatic_ref.formats.plain import bits
from quasistatic_ref.model.joints.axis_joint import Revolute
from quasistatic_ref.optional.compiled import library
from quasistatic_ref.optional.fast import simulator as of_fast
from quasistatic_ref.optional.fast import sums
from quasistatic_ref.optional.fast.joined import JoinedStep, spread
from quasistatic_ref.optional.fast.solver import FormedStep
from quasistatic_ref.step.standard_form import StandardForm
from tests.contact.solids_of_tests import SHAPES as SOLIDS
from tests.contact.still import placed_shape
from tests.files.urdf.urdf_texts import inertial, joint, link, mimic, robot
from tests.helpers import error, first_step, residuals_of
from tests.tolerances import ACTIVE_SET

BOX = SOLIDS["box"]
SHAPES = SOLIDS | {"cloud": PointCloud(BOX.corners(np.ones(3))[0])}
UP = np.array([2.0, 1.0, 2.0]) / 3
KNOWN = ("cloud", "box", "cloud", "hull", "cloud")
CONES = ("pyramid", "product", "facets-8", "frictionless")

needs_compiler = pytest.mark.extra("fast")
STONE = robot(link("stone", "", inertial("0.3", ("3e-4",) * 3)))
CART = robot(link("cart", "", inertial("2", ("0.1",) * 3)))
WHEELS = robot(
    *(link(name, "", inertial("1", ("0.1",) * 3)) for name in ("axle", "wheel", "near", "far")),
    joint("turn", "axle", "wheel", "continuous", "0 0 1"),
    joint("open", "axle", "near", "prismatic", "1 0 0"),
    joint("shut", "axle", "far", "prismatic", "-1 0 0", mimic("open")),
)


def bodies():
    """A body that is held, a free one, one in the plane, and joints that turn, slide and mimic."""
    return System(
        [
            Body("cart", CART, "planar", ()),
            Body("free", STONE, "floating", ()),
            Body("held", STONE, "floating", ("base",)),
            Body("wheels", WHEELS, "planar", ("base", "turn", "open"), xyz=(0.1, 0.2, 0.0)),
        ]
    )


def touching(system, names):
    """Contacts of a shape on each link with a slope, and of every two."""
    q = system.q_start
    shapes = cycle([SHAPES[name] for name in names])
    ball = SHAPES["sphere"]  # of 0.1 m
    pairs = []
    for at, name in enumerate(system.links[1:], start=1):
        R, t = system.pose(q, name)
        solid = placed_shape(next(shapes), at)
        down = -UP[None] @ R
        points = getattr(solid.shape, "points", None)  # of a cloud
        reach = solid.shape.support_value(down) if points is None else points @ down[0]
        nearest = UP @ t - reach.max()
        wall = placed_shape(HalfSpace(UP, nearest - 1e-4 * (at % 3)))
        mu_omega, rows = (0.01, 6) if at % 2 else (0.0, 4)
        pairs.append(ContactPair(f"p{at}", wall, solid, 0.1 * at, mu_omega, rows, 1 + at % 4))
        if at % 2 == 0:
            _, before = system.pose(q, system.links[at - 1])
            neighbour = placed_shape(ball, at, t=R.T @ (before - t + 0.2001 * UP))
            one = placed_shape(ball, at - 1)
            pairs.append(ContactPair(f"b{at}", one, neighbour, 0.3, 0.01, 6, 1))
    return pairs


OWN = {"extension": lambda q: Extension(lambda s: [s.delta_q_u[3] <= 1e-5])}
KINDS = {
    **{f"the cone {cone}": (bodies, KNOWN, {"cone": cone}) for cone in CONES},
    "no contacts": (bodies, (), {}),
    "nothing claimed": (bodies, KNOWN, {"certify": "off"}),
    "residuals": (bodies, KNOWN, {"certify": "residual"}),
    "the ellipsoid": (bodies, KNOWN, {"cone": "ellipsoid"}),
    "Coulomb's law": (bodies, KNOWN, {"law": "coulomb"}),
    "own rows": (bodies, KNOWN, OWN),
    "another backend": (bodies, KNOWN, {"backend": "clarabel"}),
    "no backend": (bodies, KNOWN, {"backend": "none"}),
    "a mass that varies": (None, KNOWN, {}),
    "solids alone": (bodies, ("box", "hull", "cylinder"), {}),
}
"""Bodies, shapes and settings."""


def data_of(result):
    """The bits of a step's data and of its closest points."""
    return bits((result.step, result.points))


def arguments(kind, chain):
    """Arguments of a simulator; where it has no bodies, the first two of a scene with a chain."""
    make, names, own = KINDS[kind]
    system = make() if make else System(chain.bodies[:2])
    pairs = touching(system, names) if names else []
    K_q = np.diag(np.arange(500.0, 500.0 + system.n_a))
    same = {"system": system, "pairs": pairs, "h": 0.01, "K_q": K_q, "gravity": -9.81 * UP}
    return same | own


def two_steps(simulators, q):
    """Results of some simulators, each step from where the last of them has led."""
    system = simulators[0].system
    force = np.linspace(-1.0, 1.0, system.n_v)
    for _ in range(2):
        goal = system.integrate(q, np.full(system.n_v, 1e-3))[: system.n_q_a]
        found = [simulator.step(q, goal, force) for simulator in simulators]
        yield found
        q = found[-1].q


@needs_compiler
@pytest.mark.parametrize("kind", KINDS)
def test_data_and_next_configuration_are_the_plain_path_s(scene, kind):
    """An answer that is not certified exactly is near to it, and q+ its sum by the core."""
    same = arguments(kind, scene)
    system = same["system"]
    q = system.q_start
    proved = {} if kind == "the ellipsoid" else {"backend": "none", "certify": "full"}
    plain = Simulator(**same | proved)
    fast = FastSimulator(Simulator(**same))
    kinds = {"off": "none", "residual": "residual"}
    for one, other in two_steps([plain, fast], q):
        answer = other.solution
        claimed = answer.certificate.kind
        assert claimed == kinds.get(fast.certify, one.solution.certificate.kind)
        assert fast.by_c
        assert data_of(other) == data_of(one)
        if claimed == "exact":
            assert bits(other.q) == bits(one.q)
        else:
            assert error(one.step, answer.delta_q, one.solution.delta_q) < ACTIVE_SET
            assert residuals_of(other.step, answer.delta_q, answer.lam).worst < ACTIVE_SET
            assert bits(other.q) == bits(system.integrate(q, answer.delta_q))
        q = other.q
    assert not same["pairs"] or np.abs(other.forces).max() > 0.1


@needs_compiler
@pytest.mark.parametrize("cone", CONES)
def test_the_data_of_a_step_are_those_of_the_plain_path_wherever_it_is(cone):
    """The guard of the first step compares one configuration; here are small moves and jumps."""
    rng = np.random.default_rng(CONES.index(cone))
    system = bodies()
    K_q = np.diag(rng.uniform(1, 100, size=system.n_a))
    plain = Simulator(system, touching(system, KNOWN), h=0.01, K_q=K_q, cone=cone)
    fast = FastSimulator(plain)
    q = system.q_start
    for k in range(24):
        size = 0.3 if k % 4 == 0 else 1e-4
        q = system.integrate(q, size * rng.normal(size=system.n_v) * (k != 0))
        move = 1e-3 * rng.normal(size=system.n_v)
        goal = system.integrate(q, move)[: system.n_q_a]
        force = rng.normal(size=system.n_v)
        kinematics = system.kinematics(q)
        points = plain.closest_points(kinematics)
        step = plain.step_data(q, goal, force, points)
        fast._poses.move(q)
        fast._steps.closest()
        in_c, points_in_c = fast._steps.form(system.actuated_difference(q, goal) + 0.0, force)
        rows = fast._steps.rows
        column = fast._steps.column
        A = spread(rows["A"][:, None], np.repeat(column, rows["rows"], axis=0), system.n_v)[:, 0]
        form = StandardForm(in_c.H, rows["g"], A, rows["b"])
        plain_form = standard_form(step)
        assert bits((in_c, form, points_in_c)) == bits((step, plain_form, points))
        tau = plain.generalised_force(q, force)
        given = fast._steps.at(points, system.actuated_difference(q, goal) + 0.0, tau)
        some = np.arange(k % 3, step.contacts.n_c, 2)
        every = np.arange(system.n_v)
        fewer, fewer_in_c = (
            one.with_fields(contacts=one.contacts.some(some, every), cone="product")
            for one in (step, given)
        )
        assert type(fewer_in_c) is JoinedStep
        assert bits((given, fewer_in_c)) == bits((step, fewer))
        assert bits(given.with_fields(h=0.02)) == bits(step.with_fields(h=0.02))
        assert bits(in_c.contacts.motion(move)) == bits(step.contacts.motion(move))
        for group in fast._steps.groups:
            assert group_step(in_c, group) == group_step(step, group)
        assert bits(fast._sums.integrate(move)) == bits(system.integrate(q, move))


@needs_compiler
def test_groups_of_a_step_are_those_of_its_numbers():
    """Whether all of J differs from zero where it can or, as of a turned joint, not."""
    seen = set()
    for name in ("bunny_grasp", "stack", "two_finger_pinch", "door"):
        run = load_scenario(name, ["record=light"], fast=True)
        simulator = run.simulator()
        q = run.system.q_start
        for _ in range(4):
            step = simulator.step(q, q[: run.system.n_q_a]).step
            formed = FormedStep(step, None, [], simulator.solver.program)
            assert bits([group for group, _ in formed.groups]) == bits(groups(step))
            seen.add((name, step.couples_all))
            q = run.system.integrate(q, np.linspace(-1e-6, 1e-6, run.system.n_v))
    assert {couples_all for _, couples_all in seen} == {False, True}


@needs_compiler
def test_changes_of_actuated_joints_are_those_of_the_core(rng):
    """Of bases that are held and joints that turn on, from a hair to more than half a turn."""
    held, wheels = bodies().bodies[2:]
    system = System([held, replace(wheels, actuated=("turn", "open"))])
    plain = Simulator(system, [], h=0.01, K_q=1.0)
    sums = FastSimulator(plain)._sums
    q = system.q_start
    decided = 0
    for k in range(400):
        move = rng.normal(size=system.n_v) * 10.0 ** rng.integers(-12, 1) * (k % 7 > 0)
        goal = system.integrate(q, move)[: system.n_q_a]
        expected = system.actuated_difference(q, goal) + 0.0
        assert bits(sums.actuated_difference(q, goal)) == bits(expected)
        decided += library.library().differences(sums.structure.pointer)
        q = system.integrate(q, rng.normal(size=system.n_v))
    assert decided > 300
    with pytest.raises(ModelError, match="length one"):
        sums.actuated_difference(q, 2 * goal)


@needs_compiler
@pytest.mark.parametrize("name", ["coefficient", "moves_beta", "kind"])
def test_steps_that_compiled_code_forms_wrong_are_left_to_the_plain_path(name, capfd):
    of_fast.say.cache_clear()
    scenario = load_scenario("sphere_spin", ["record=light"], fast=True)
    one = scenario.simulator()
    if name == "kind":
        one._sums.structure["kind"][:] = sums.KINDS[Revolute]  # as if a base were another joint
    else:
        one._steps.rows[name][:] *= 2  # as if the compiled code were wrong
    expected = first_step(replace(scenario, fast=False))
    assert bits(first_step(scenario, one).q) == bits(expected.q)
    assert not one.by_c
    assert "compiled code forms another step than the core" in capfd.readouterr().err


def test_without_compiled_code_the_plain_path_takes_the_steps_and_says_so(monkeypatch, capfd):
    of_fast.say.cache_clear()
    monkeypatch.setattr(of_fast, "missing", lambda: "there is none")
    scenario = load_scenario("sphere_spin", fast=True)
    one = scenario.simulator()
    expected = first_step(replace(scenario, fast=False))
    assert bits(first_step(scenario, one).q) == bits(expected.q)
    assert (one.by_c, one.backend) == (False, "clarabel")
    (line,) = capfd.readouterr().err.splitlines()
    assert line.startswith("quasistatic-ref: fast needs compiled code: there is none; the plain ")


def test_what_is_no_plain_simulator_is_refused():
    class Own(Simulator):
        def solution(self, step):
            return None

    plain = load_scenario("sphere_spin").simulator()
    with pytest.raises(InputError, match=r"^simulator: has steps of its own.*got 'Own'"):
        FastSimulator(Own(**plain.settings()))
    with pytest.raises(InputError, match=r"^simulator: "):
        FastSimulator(load_scenario("sphere_spin"))


@needs_compiler
def test_a_copy_is_a_fast_simulator_of_its_own():
    scenario = load_scenario("sphere_spin", fast=True)
    one = scenario.simulator()
    other = pickle.loads(pickle.dumps(one))
    assert type(other) is FastSimulator
    assert other.simulator is not one.simulator
    assert bits(first_step(scenario, other).q) == bits(first_step(scenario, one).q)
