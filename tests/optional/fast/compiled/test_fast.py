"""Compiled steps against those of the plain path: equal bits, the signs of zeros included."""

import os
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from quasistatic_ref import (
    Body,
    ContactPair,
    Extension,
    PlacedShape,
    PointCloud,
    Simulator,
    System,
    load_scenario,
    standard_form,
)
from quasistatic_ref.contact.distance import closest_points
from quasistatic_ref.formats.plain import bits
from quasistatic_ref.model.joints.axis_joint import Revolute
from tests.model.urdf.urdf_texts import inertial, joint, link, robot, urdf_of_text
from tests.optional.fast.compiled.test_fast_pairs import CLOUDS, SHAPES, cloud

ROOT = Path(__file__).parents[4]
KNOWN = ("sphere", "box", "capsule", "cylinder", "half-space", "tilted half-space")
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


def shapes_and_clouds(system, names, rng):
    """Each solid on some link, a cloud of every kind on another; some clouds are alpha."""
    pairs = []
    links = list(range(1, len(system.links)))
    for i, name in enumerate(names):
        at, other = rng.permutation(links)[:2]
        R = Rotation.random(rng=rng).as_matrix()
        t = rng.uniform(-0.05, 0.05, size=3)
        solid = PlacedShape(name, int(at) * (i % 3 != 2), R, t, SHAPES[name])
        points = PointCloud(cloud(CLOUDS[i % len(CLOUDS)], 200, rng))
        some = PlacedShape("cloud", int(other), np.eye(3), np.zeros(3), points)
        sides = (solid, some) if i % 2 else (some, solid)
        mu_omega, rows = (0.01, 6) if i % 2 else (0.0, 4)
        pairs.append(ContactPair(f"p{i}", *sides, 0.5 * (i % 4), mu_omega, rows, 3))
    return pairs


def solids(system, rng):
    """Pairs of solids on some links, of which each keeps another number of contacts."""
    links = np.arange(1, len(system.links))
    pairs = []
    kinds = (("box", "half-space"), ("sphere", "box"), ("box", "capsule"), ("box", "hull"))
    for k, names in enumerate(kinds):
        sides = []
        for name, at in zip(names, rng.permutation(links), strict=False):
            place = Rotation.random(rng=rng).as_matrix(), rng.uniform(-0.1, 0.1, size=3)
            sides.append(PlacedShape(name, int(at), *place, SHAPES[name]))
        pairs.append(ContactPair(f"s{k}", *sides, 0.5, 0.0, 4, 1 + 3 * k))
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
    step = Simulator.step_data(simulator, q, q_bar_a, force, points, kinematics)
    return step, standard_form(step), points


def arrays(step, form, points):
    contacts = {name: getattr(step.contacts, name) for name in ("phi", "n", "d1", "d2", "J")}
    own = {name: getattr(step, name) for name in ("tau_a", "tau_u", "delta_q_bar_a", "H")}
    return {**points._asdict(), **contacts, **own, **form._asdict()}


def differing_names(one, other):
    return [name for name in one if one[name].tobytes() != other[name].tobytes()]


def wrong_arrays(system, pairs, cone, rng):
    """Names of the arrays in which compiled steps differ from the plain path's."""
    K_q = np.diag(rng.uniform(1, 100, size=system.n_a))
    simulator = Simulator(system, pairs, h=0.01, K_q=K_q, certify="off", cone=cone, fast=True)
    wrong = set()
    for q, move in places(system, rng):
        force = rng.normal(size=system.n_v)
        goal = system.integrate(q, move)[: system.n_q_a]
        expected = arrays(*of_plain(simulator, q, goal, force))
        simulator.poses.move(q)
        simulator.contacts.find(simulator.poses)
        found = arrays(*simulator.posed_step(goal, force))
        assert simulator.gap == expected["phi"].min()
        wrong.update(differing_names(found, expected))
        after = simulator.screws.integrate(move)
        wrong.update(["q"] if after.tobytes() != system.integrate(q, move).tobytes() else [])
    return sorted(wrong)


@needs_compiler
@pytest.mark.parametrize("cone", CONES)
def test_known_shapes_and_all_polyhedral_cones_have_the_bits_of_the_plain_path(tmp_path, cone):
    rng = np.random.default_rng(CONES.index(cone))
    system = bodies(tmp_path)
    pairs = [*shapes_and_clouds(system, KNOWN, rng), *solids(system, rng)]
    assert wrong_arrays(system, pairs[::-1], cone, rng) == []


@needs_compiler
def test_pairs_that_compiled_code_does_not_know_are_those_of_the_plain_path(tmp_path):
    rng = np.random.default_rng(11)
    system = bodies(tmp_path)
    pairs = shapes_and_clouds(system, [*KNOWN, "cone", "ellipsoid", "hull"], rng)
    pairs += solids(system, rng)
    assert wrong_arrays(system, pairs, "pyramid", rng) == []
    simulator = Simulator(system, pairs, h=0.01, K_q=np.eye(system.n_a), fast=True)
    known = zip(pairs, simulator.contacts.known, strict=True)
    assert [pair.name for pair, is_known in known if not is_known] == ["p6", "p7"]


@needs_compiler
@pytest.mark.parametrize("contacts", [True, False])
def test_whatever_follows_the_numbers_of_a_step_are_those_of_the_plain_path(tmp_path, contacts):
    """An extension, Coulomb's law, the ellipsoid, other backends, and a scene without contacts."""
    rng = np.random.default_rng(5)
    system = bodies(tmp_path)
    pairs = solids(system, rng)[:1] if contacts else []
    K_q = np.diag(rng.uniform(1, 100, size=system.n_a))
    following = (
        {"extension": lambda q: Extension(lambda s: [s.delta_q_u[0] <= 1.0])},
        {"law": "coulomb"},
        {"cone": "ellipsoid"},
        {"backend": "clarabel", "certify": "residual"},
        {"backend": "none"},
        *([{"backend": "scs", "certify": "off"}] if contacts else []),  # it needs rows
    )
    q = system.q_start
    for settings in following:
        plain, fast = (
            Simulator(system, pairs, h=0.01, K_q=K_q, **settings, fast=speed)
            for speed in (False, True)
        )
        one, other = (some.step(q, q[: system.n_q_a]) for some in (plain, fast))
        assert fast.by_c
        assert one.step == other.step, settings
        assert [bits(one.points), bits(one.step)] == [bits(other.points), bits(other.step)]
        if settings.get("certify", "full") == "full" and settings.get("cone") is None:
            assert one.q.tobytes() == other.q.tobytes(), settings


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
@pytest.mark.parametrize("name", ["coefficient", "moves_beta"])
def test_steps_that_compiled_code_forms_wrong_are_left_to_the_plain_path(name):
    scenario = load_scenario("sphere_spin", ["record=light"], fast=True)
    one = scenario.simulator()
    one.numbers[name][:] *= 2  # as if the compiled code were wrong
    q = scenario.system.q_start
    goal = scenario.targets(scenario.h)
    expected = replace(scenario, fast=False).simulator().step(q, goal)
    assert one.step(q, goal).q.tobytes() == expected.q.tobytes()
    assert not one.by_c


@needs_compiler
def test_a_sum_that_compiled_code_makes_wrong_is_left_to_the_plain_path():
    scenario = load_scenario("sphere_spin", ["record=light"], fast=True)
    one = scenario.simulator()
    one.screws.sums["kind"][:] = Revolute.in_c  # as if a base were a joint of another kind
    q = scenario.system.q_start
    goal = scenario.targets(scenario.h)
    expected = replace(scenario, fast=False).simulator().step(q, goal)
    assert one.step(q, goal).q.tobytes() == expected.q.tobytes()
    assert not one.by_c
