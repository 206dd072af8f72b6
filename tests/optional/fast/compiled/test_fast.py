"""Compiled steps against those of NumPy: equal to the last bit, the signs of zeros included."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from quasistatic_ref.contact.distance import closest_points
from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.model.system import Body, System
from quasistatic_ref.optional.fast.compiled import compiled
from quasistatic_ref.scenario.scenario import load_scenario
from quasistatic_ref.shapes.placed_shape import PlacedShape, PointCloud
from quasistatic_ref.simulate.simulator import Simulator
from quasistatic_ref.step.standard_form import standard_form
from tests.model.urdf.urdf_texts import inertial, joint, link, robot, written
from tests.properties.test_tracker import CLOUDS, SHAPES, cloud

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
    stone = written(folder, STONE, "stone.urdf")
    cart = written(folder, CART, "cart.urdf")
    wheels = written(folder, WHEELS, "wheels.urdf")
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


def of_numpy(simulator, q, q_bar_a, force):
    kinematics = simulator.system.kinematics(q)
    points = closest_points(simulator.pairs, kinematics)
    step = simulator.step_data(q, q_bar_a, force, points, kinematics)
    return points, step, standard_form(step)


def arrays(points, step, form):
    contacts = {name: getattr(step.contacts, name) for name in ("phi", "n", "d1", "d2", "J")}
    own = {name: getattr(step, name) for name in ("tau_a", "tau_u", "delta_q_bar_a", "H")}
    return {**points._asdict(), **contacts, **own, **form._asdict()}


def differing(one, other):
    return [name for name in one if one[name].tobytes() != other[name].tobytes()]


def compared(system, pairs, cone, rng):
    """Names of the arrays in which compiled steps differ from NumPy's."""
    K_q = np.diag(rng.uniform(1, 100, size=system.n_a))
    made = {"h": 0.01, "K_q": K_q, "certify": "off", "cone": cone}
    one, other = (Simulator(system, pairs, **made, fast=True) for _ in range(2))
    assert one.compiled is not None
    wrong = set()
    for q, move in places(system, rng):
        force = rng.normal(size=system.n_v)
        goal = system.integrate(q, move)[: system.n_q_a]
        expected = arrays(*of_numpy(other, q, goal, force))
        one.compiled.poses.move(q)
        one.compiled.find_points(one)
        *data, gap = one.compiled.step_data(one, q, goal, force)
        found = arrays(*data)
        assert gap == expected["phi"].min()
        wrong.update(differing(found, expected))
        after = one.compiled.screws.integrate(move)
        wrong.update(["q"] if after.tobytes() != system.integrate(q, move).tobytes() else [])
    return sorted(wrong)


@needs_compiler
@pytest.mark.parametrize("cone", CONES)
def test_known_shapes_and_all_polyhedral_cones_have_the_bits_of_numpy(tmp_path, cone):
    rng = np.random.default_rng(CONES.index(cone))
    system = bodies(tmp_path)
    pairs = [*shapes_and_clouds(system, KNOWN, rng), *solids(system, rng)]
    assert compared(system, pairs[::-1], cone, rng) == []


@needs_compiler
def test_shapes_that_compiled_code_does_not_know_are_measured_by_numpy(tmp_path):
    rng = np.random.default_rng(11)
    system = bodies(tmp_path)
    pairs = shapes_and_clouds(system, [*KNOWN, "cone", "ellipsoid", "hull"], rng)
    pairs += solids(system, rng)
    assert compared(system, pairs, "pyramid", rng) == []
    simulator = Simulator(system, pairs, h=0.01, K_q=np.eye(system.n_a), fast=True)
    said = compiled("step").taken_by(simulator)
    assert said == "compiled code; closest points by NumPy, which p6, p7, p8 need"


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
            found.append(arrays(result.points, result.step, standard_form(result.step)))
        assert differing(*found) == []


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
from quasistatic_ref.optional.fast.compiled import compiled, why_not
from quasistatic_ref.optional.fast.compiled import library
from quasistatic_ref.scenario.scenario import load_scenario
scenario = load_scenario("sphere_spin", ["record=light"], fast=True)
def taken():
    for cached in (compiled, why_not, library._found):
        cached.cache_clear()
    simulator = scenario.simulator()
    simulator.step(scenario.system.q_start, scenario.targets(scenario.h))
    print(simulator.compiled, compiled("step"), why_not())
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


def test_without_a_compiler_numpy_takes_the_steps(tmp_path):
    said, error = python(NOT_COMPILED, XDG_CACHE_HOME=str(tmp_path))
    *lines, no_library, no_home = [line.removeprefix("None None ") for line in said.splitlines()]
    assert lines == [*NO_COMPILERS.values()], error
    assert no_library.startswith("true is not used: it cannot be loaded: ")
    assert no_home == "there is no home folder to keep it in: set XDG_CACHE_HOME or HOME"


@needs_compiler
def test_a_step_that_numpy_forms_otherwise_is_left_to_numpy():
    scenario = load_scenario("sphere_spin", ["record=light"], fast=True)
    one = scenario.simulator()
    other = scenario.simulator()
    one.compiled.scene["coefficient"][:] *= 2  # as if the compiled code were wrong
    other.compiled = None
    q = scenario.system.q_start
    goal = scenario.targets(scenario.h)
    assert one.step(q, goal) == other.step(q, goal)
    assert one.compiled is None


@needs_compiler
def test_simulators_that_compiled_code_does_not_take_say_why():
    step = compiled("step")
    scenario = load_scenario("sphere_spin", ["record=light"], fast=True)
    simulator = scenario.simulator()
    assert step.unknown(simulator) is None
    assert step.taken_by(simulator).startswith("compiled code")
    for settings, reason in (
        (["solver.backend=scs"], "'scs' has no interface of its own here"),
        (["cone=ellipsoid"], "the ellipsoid has no rows"),
    ):
        other = load_scenario("sphere_spin", ["record=light", *settings], fast=True).simulator()
        assert other.compiled is None
        assert step.taken_by(other) == f"NumPy: {reason}"
    simulator.extension = lambda q: None
    assert step.taken_by(simulator) == "NumPy: the scene has an extension"
