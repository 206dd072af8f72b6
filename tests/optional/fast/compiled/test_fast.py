"""Compiled steps against those of the plain path: equal bits, the signs of zeros included."""

import os
import subprocess
import sys
from dataclasses import replace
from itertools import cycle
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from quasistatic_ref import (
    Body,
    ContactPair,
    Contacts,
    Extension,
    HalfSpace,
    PlacedShape,
    PointCloud,
    Simulator,
    StepData,
    StepDataError,
    System,
    load_scenario,
    standard_form,
)
from quasistatic_ref.contact.distance import closest_points
from quasistatic_ref.formats.plain import bits
from quasistatic_ref.model.joints.axis_joint import Revolute
from tests.helpers import always_in_blocks, error, residuals_of
from tests.model.urdf.urdf_texts import inertial, joint, link, robot, urdf_of_text
from tests.optional.fast.compiled.test_fast_pairs import SHAPES
from tests.scenes import chain_scene
from tests.tolerances import ACTIVE_SET

ROOT = Path(__file__).parents[4]
UP = np.array([2.0, 1.0, 2.0]) / 3
KNOWN = ("box", "sphere", "capsule", "hull", "cylinder")
CONES = ("pyramid", "product", "facets-8", "frictionless")

# The rest of the suite holds without a compiler, which QUASISTATIC_REF_CC=none shows.
needs_compiler = pytest.mark.extra("fast")
STONE = robot(link("stone", "", inertial("0.3", ("3e-4",) * 3)))
CART = robot(link("cart", "", inertial("2", ("0.1",) * 3)))
WHEELS = robot(
    link("axle", "", inertial("1", ("0.1",) * 3)),
    link("wheel", "", inertial("1", ("0.1",) * 3)),
    joint("turn", "axle", "wheel", "continuous", "0 0 1"),
    link("near", "", inertial("1", ("0.1",) * 3)),
    joint("open", "axle", "near", "prismatic", "1 0 0"),
    link("far", "", inertial("1", ("0.1",) * 3)),
    joint("shut", "axle", "far", "prismatic", "-1 0 0", '<mimic joint="open"/>'),
)


def bodies(folder):
    """A body that is held, a free one, one in the plane, and joints that turn, slide and mimic."""
    stone = urdf_of_text(folder, STONE, "stone.urdf")
    cart = urdf_of_text(folder, CART, "cart.urdf")
    wheels = urdf_of_text(folder, WHEELS, "wheels.urdf")
    return System(
        [
            Body("cart", cart, "planar", ()),
            Body("free", stone, "floating", ()),
            Body("held", stone, "floating", ("base",)),
            Body("wheels", wheels, "planar", ("base", "turn", "open"), xyz=(0.1, 0.2, 0.0)),
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
        solid = PlacedShape("solid", at, np.eye(3), np.zeros(3), next(shapes))
        nearest = UP @ t - solid.shape.support_value(-UP[None] @ R).item()
        side = HalfSpace(UP, nearest - 1e-4 * (at % 3))
        wall = PlacedShape.in_world("wall", side)
        mu_omega, rows = (0.01, 6) if at % 2 else (0.0, 4)
        k = max(1, min(1 + at % 4, solid.shape.corner_count))
        pairs.append(ContactPair(f"p{at}", wall, solid, 0.1 * at, mu_omega, rows, k))
        if at % 2 == 0:
            _, before = system.pose(q, system.links[at - 1])
            neighbour = PlacedShape("ball", at, np.eye(3), R.T @ (before - t + 0.2001 * UP), ball)
            one = PlacedShape("ball", at - 1, np.eye(3), np.zeros(3), ball)
            pairs.append(ContactPair(f"b{at}", one, neighbour, 0.3, 0.01, 6, 1))
    return pairs


def places(system, rng):
    """Configurations: a start, small moves, jumps, and turns by exact halves."""
    q = system.q_start
    for k in range(24):
        size = 0.3 if k % 4 == 0 else 1e-4
        q = system.integrate(q, size * rng.normal(size=system.n_v) * (k != 0))
        yield q, 1e-3 * rng.normal(size=system.n_v)


def of_plain(simulator, q, q_bar_a, force):
    """What the plain path makes of a step."""
    kinematics = simulator.system.kinematics(q)
    points = closest_points(simulator.pairs, kinematics)
    contacts = simulator.geometry.contacts(points, kinematics)
    tau = simulator.generalised_force(q, force)
    step = Simulator.step_under(simulator, q, q_bar_a, tau, contacts)
    return step, standard_form(step), points


def arrays(step, form, points):
    contacts = {name: getattr(step.contacts, name) for name in ("phi", "n", "d1", "d2", "J")}
    own = {name: getattr(step, name) for name in ("tau_a", "tau_u", "delta_q_bar_a", "H")}
    found = {**points._asdict(), **contacts, **own, **form._asdict()}
    return {name: array.tobytes() for name, array in found.items()}


def differing_names(one, other):
    return [name for name in one if one[name] != other[name]]


@needs_compiler
def test_a_target_that_is_no_number_is_refused_in_the_words_of_the_plain_path():
    scenario = load_scenario("block_push", fast=True)
    simulator = scenario.simulator()
    q = scenario.system.q_start
    kinematics = scenario.system.kinematics(q)
    points = closest_points(simulator.pairs, kinematics)
    target = np.full_like(scenario.targets(0.0), np.nan)
    with pytest.raises(StepDataError, match="delta_q_bar_a: must contain finite numbers only"):
        simulator.step_data(q, target, 0.0, points, kinematics)


@needs_compiler
@pytest.mark.parametrize("cone", CONES)
def test_the_data_of_a_step_are_those_of_the_plain_path_wherever_it_is(tmp_path, cone):
    rng = np.random.default_rng(CONES.index(cone))
    system = bodies(tmp_path)
    K_q = np.diag(rng.uniform(1, 100, size=system.n_a))
    pairs = touching(system, KNOWN)
    simulator = Simulator(system, pairs, h=0.01, K_q=K_q, certify="off", cone=cone, fast=True)
    for q, move in places(system, rng):
        force = rng.normal(size=system.n_v)
        goal = system.integrate(q, move)[: system.n_q_a]
        expected = arrays(*of_plain(simulator, q, goal, force))
        simulator.poses.move(q)
        simulator.contacts.find(simulator.poses)
        found = arrays(*simulator.posed_step(goal, force))
        assert differing_names(found, expected) == []
        assert simulator.gap == np.frombuffer(expected["phi"]).min()
        assert simulator.screws.integrate(move).tobytes() == system.integrate(q, move).tobytes()


def boxes(folder):
    """40, of which the first is held."""
    return System(
        [
            Body.of_shape(
                f"b{i}", SHAPES["box"], 1.0, xyz=(i, 0.0, 0.0), actuated=() if i else ("base",)
            )
            for i in range(40)
        ]
    )


def with_a_ball(folder):
    return System([*bodies(folder).bodies, Body.of_shape("b", SHAPES["box"], 1.0, base="ball")])


def some(make, own):
    """Some of the bodies of a system."""
    return lambda folder: System(make(folder).bodies[own])


OFF = {"certify": "off"}
OWN = {"extension": lambda q: Extension(lambda s: [s.delta_q_u[3] <= 1e-5])}
KINDS = {
    **{f"the cone {cone}": (bodies, KNOWN, {"cone": cone}) for cone in CONES},
    "no contacts": (bodies, (), {}),
    "one body": (some(bodies, slice(1)), KNOWN, {}),
    "40 boxes": (boxes, KNOWN[:1], {}),
    "40 boxes of which nothing is claimed": (boxes, KNOWN[:1], OFF),
    "nothing claimed": (bodies, KNOWN, OFF),
    "residuals": (bodies, KNOWN, {"certify": "residual"}),
    "the ellipsoid": (bodies, KNOWN, {"cone": "ellipsoid"}),
    "Coulomb's law": (bodies, KNOWN, {"law": "coulomb"}),
    "own rows": (bodies, KNOWN, OWN),
    "another backend": (bodies, KNOWN, {"backend": "clarabel"}),
    "no backend": (bodies, KNOWN, {"backend": "none"}),
    "in blocks": (some(bodies, slice(1, 4)), KNOWN, {"backend": "piqp"}),
    "a joint that C does not know": (with_a_ball, KNOWN, {}),
    "a mass that varies": (some(chain_scene, slice(2)), KNOWN, {}),
    "shapes that C does not know": (bodies, ("cone", "box", "ellipsoid"), {}),
}
"""Bodies, shapes and settings."""


def all_of(result):
    """What no choice is left of in a result; of q and delta_q, if the step is certified exactly."""
    solution = result.solution
    certificate = solution.certificate
    found = {"points": result.points, "forces": result.forces, "H": result.step.H}
    for part in (result.step, result.step.contacts):  # in blocks or not
        kind = Contacts if isinstance(part, Contacts) else StepData
        found |= {name: getattr(part, name) for name in kind.kept() if name != "contacts"}
    if certificate.kind == "exact":
        found |= {"q": result.q, "delta_q": solution.delta_q, "A'lam": solution.net_impulse}
        unique = {"multipliers_unique", "differentiable", "smallest_inactive_slack", "error_bound"}
        if certificate.multipliers_unique:
            found |= {"lam": solution.lam, "lam_extra": solution.lam_extra}
            unique |= {"active", "smallest_active_multiplier"}
        found |= {name: getattr(certificate, name) for name in unique}
    return {name: bits(value) for name, value in found.items()}


def scene(kind, folder):
    """Arguments of a simulator."""
    make, names, own = KINDS[kind]
    system = make(folder)
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
def test_all_of_a_result_is_the_plain_path_s(tmp_path, monkeypatch, kind):
    """An answer that is not certified exactly is near to it, and q+ its sum by the core."""
    if kind == "in blocks":
        always_in_blocks(monkeypatch)
    same = scene(kind, tmp_path)
    system = same["system"]
    q = system.q_start
    proved = {} if kind == "the ellipsoid" else {"backend": "none", "certify": "full"}
    plain = Simulator(**same | proved)
    fast = Simulator(**same, fast=True)
    said = {"off": "none", "residual": "residual"}
    for one, other in two_steps([plain, fast], q):
        found = other.solution
        claimed = found.certificate.kind
        assert claimed == said.get(fast.certify, one.solution.certificate.kind)
        assert fast.by_c
        assert (fast.blocks is not None) == ("boxes" in kind or "blocks" in kind)
        assert differing_names(all_of(other), all_of(one)) == []
        if claimed != "exact":
            assert error(one.step, found.delta_q, one.solution.delta_q) < ACTIVE_SET
            assert residuals_of(other.step, found.delta_q, found.lam).worst < ACTIVE_SET
            assert bits(other.q) == bits(system.integrate(q, found.delta_q))
        q = other.q
    assert not same["pairs"] or np.abs(other.forces).max() > 0.1


def test_clouds_along_the_axes_of_the_world_have_the_zeros_of_the_plain_path():
    """Products with the zeros of a normal are zeros of either sign; the plain path has 0.0."""
    box = SHAPES["box"]
    shape = PointCloud(box.corners(np.ones(3))[0])
    for W in Rotation.create_group("O").as_matrix().round():
        system = System([Body.of_shape("top", box, 1.0, xyz=W @ [0.0, 0.0, 0.5])])
        low = PlacedShape("low", 0, W, np.zeros(3), box)
        top = PlacedShape("top", system.link("top/solid"), W, np.zeros(3), shape)
        pair = ContactPair("p", top, low, 0.5, 0.01, 6, 4)
        found = []
        for made in ({"backend": "none"}, {"backend": "daqp", "fast": True}):
            simulator = Simulator(system, [pair], h=0.01, K_q=np.zeros((0, 0)), **made)
            result = simulator.step(system.q_start, np.zeros(0))
            found.append(arrays(result.step, standard_form(result.step), result.points))
        assert differing_names(*found) == []


def python(source, **settings):
    command = [sys.executable, "-W", "error", "-c", source]
    done = subprocess.run(
        command, capture_output=True, text=True, cwd=ROOT, timeout=300, check=False,
        env={**os.environ, **settings},
    )  # fmt: skip
    return done.stdout.strip(), done.stderr


NO_COMPILERS = {
    "none": "QUASISTATIC_REF_CC says none",
    "gcc '": "QUASISTATIC_REF_CC cannot be read as a command: No closing quotation",
    "/nowhere/cc": "it could not be compiled or loaded: [Errno 2] No such file or directory: "
    "'/nowhere/cc'",
    "false": "false could not compile it: without a word",
    r"""sh -c 'printf "\377 an error\n" >&2; exit 1'""": "sh could not compile it: \ufffd an error",
    "sh -c 'kill -9 $$'": "sh could not compile it: it was ended by signal 9",
    "sh -c 'sleep 60'": "sh could not compile it: it did not end in 0.5 s "
    "(QUASISTATIC_REF_CC=none asks for no compiler)",
}
NOT_COMPILED = f"""
import os, pathlib
from quasistatic_ref.optional.fast import speed
from quasistatic_ref.optional.fast.compiled import library
from quasistatic_ref.scenario.scenario import load_scenario
def taken():
    for cached in (speed.usable, library._found):
        cached.cache_clear()
    scenario = load_scenario("sphere_spin", ["record=light"], fast=True)
    simulator = scenario.simulator()
    simulator.step(scenario.system.q_start, scenario.targets(scenario.h))
    print(type(simulator).__name__, simulator.backend, library.why_not())
patience = library.PATIENCE
for os.environ["QUASISTATIC_REF_CC"] in {[*NO_COMPILERS]}:
    library.PATIENCE = 0.5 if "sleep" in os.environ["QUASISTATIC_REF_CC"] else patience
    taken()
library.PATIENCE = patience
os.environ["QUASISTATIC_REF_CC"] = "true"
taken()
del os.environ["XDG_CACHE_HOME"]
def unknown():
    raise RuntimeError("Could not determine home directory.")
pathlib.Path.home = unknown
taken()
"""


def test_without_a_compiler_the_plain_path_takes_the_steps_and_says_so(tmp_path):
    said, error = python(NOT_COMPILED, XDG_CACHE_HOME=str(tmp_path))
    plain = "Simulator clarabel "
    *lines, no_library, no_home = [line.removeprefix(plain) for line in said.splitlines()]
    assert lines == [*NO_COMPILERS.values()], error
    assert no_library.startswith("true is not used: it cannot be loaded: ")
    assert no_home == "there is no home folder to keep it in: set XDG_CACHE_HOME or HOME"
    told = [line for line in error.splitlines() if line.startswith("quasistatic-ref: fast needs")]
    assert len(told) == len(NO_COMPILERS) + 2
    assert all(reason in line for reason, line in zip(lines, told, strict=False))
    assert all('pip install "quasistatic-ref[fast]"' in line for line in told)


@needs_compiler
@pytest.mark.parametrize("name", ["coefficient", "moves_beta", "kind"])
def test_steps_that_compiled_code_forms_wrong_are_left_to_the_plain_path(name):
    scenario = load_scenario("sphere_spin", ["record=light"], fast=True)
    one = scenario.simulator()
    if name == "kind":
        one.screws.sums["kind"][:] = Revolute.in_c  # as if a base were a joint of another kind
    else:
        one.numbers[name][:] *= 2  # as if the compiled code were wrong
    q = scenario.system.q_start
    goal = scenario.targets(scenario.h)
    expected = replace(scenario, fast=False).simulator().step(q, goal)
    assert one.step(q, goal).q.tobytes() == expected.q.tobytes()
    assert not one.by_c
