"""Mistakes in Python get one sentence of the package, as those in TOML do."""

import numpy as np
import pytest

import quasistatic_ref as qr
from quasistatic_ref.errors import InputError
from quasistatic_ref.model.system import Body, System
from quasistatic_ref.scenario.scenario import load_scenario
from quasistatic_ref.shapes.placed_shape import Box, Capsule, Cylinder, Ellipsoid
from tests.model.urdf.urdf_texts import collision, inertial, link, robot, written
from tests.scenes import PUSH, written_scenario


@pytest.fixture(scope="module")
def scenario(tmp_path_factory):
    return load_scenario(written_scenario(tmp_path_factory.mktemp("scene")), steps=1, fast=True)


def w_first(scenario):
    q = scenario.system.q_start.copy()
    q[-4:] = [1, 0, 0, 0]
    return qr.rollout(scenario.simulator(), q, scenario.targets, 1, progress=False)


MISTAKES = {
    "an extension in place of a function": (
        lambda s: s.simulator(qr.Extension()),
        "extension: must be a function of q that returns an Extension, such as lambda q: own "
        "(got 'Extension')",
    ),
    "steps that are no whole number": (
        lambda s: qr.rollout(s.simulator(), s.system.q_start, s.targets, 3.0),
        "steps: must be a whole number, 0 or more (got 3.0)",
    ),
    "a misspelt array": (
        lambda s: s.run(progress=False)["wrenchs"],
        "wrenchs: is not an array of this trajectory; did you mean 'wrench'?",
    ),
    "a field as an argument of run": (
        lambda s: s.run(record="light"),
        "record: is not an argument of run (known: observers, resume, save, save_every); set "
        "fields when the scenario is loaded, as in load_scenario(path, record='light')",
    ),
    "w first": (
        w_first,
        "q[ball/base]: looks like the identity as [w x y z]; quaternions are [x y z w], and the "
        "identity is [0 0 0 1] (half a turn about x is [1 0 0 1e-16]) (got [1.0, 0.0, 0.0, 0.0])",
    ),
    "no size": (
        lambda s: Box(),
        "half_extents: must be given, or size, twice as long, and not both",
    ),
    "two lengths": (
        lambda s: Cylinder(0.1, 0.2, length=0.4),
        "half_length: must be given, or length, twice as long, and not both",
    ),
}


@pytest.mark.parametrize("case", MISTAKES)
def test_a_mistake_in_python_gets_one_sentence(scenario, case):
    made, sentence = MISTAKES[case]
    with pytest.raises(InputError) as caught:
        made(scenario)
    assert sentence in str(caught.value)


def test_a_body_that_is_not_said_to_float_is_offered_a_base(tmp_path):
    head, _, rest = PUSH.replace('base = "floating"\n', "").partition("[[bodies.ball")
    path = written_scenario(tmp_path, head + rest[rest.index("[shapes.floor]") :])
    with pytest.raises(InputError, match=r'if ball is to move freely, give it base = "floating"$'):
        load_scenario(path)


def test_shapes_are_made_of_whole_sizes_as_in_files():
    size = np.array([0.1, 0.2, 0.3])
    length = 0.4
    assert Box(size=size) == Box(size / 2)
    assert Ellipsoid(size=size) == Ellipsoid(size / 2)
    assert Cylinder(0.1, length=length) == Cylinder(0.1, length / 2)
    assert Capsule(0.1, length=length) == Capsule(0.1, length / 2)


def test_a_collision_keeps_its_name_and_contacts_may_use_it(tmp_path):
    ball = collision('<sphere radius="0.01"/>', '<origin xyz="0.04 0 0"/>')
    named = ball.replace("<collision>", '<collision name="handle">')
    mug = link("mug", collision('<sphere radius="0.03"/>') + named, inertial("0.2", ("1e-4",) * 3))
    written(tmp_path, robot(mug), "mug.urdf")
    path = tmp_path / "mug.toml"
    path.write_text(
        'format = "quasistatic-ref/scenario"\nversion = 1\nh = 0.01\nsteps = 1\n'
        '[bodies.mug]\nurdf = "mug.urdf"\nbase = "floating"\n'
        "[shapes.floor]\nhalfspace = { normal = [0, 0, 1] }\n"
        '[contacts.floor]\nalpha = "floor"\nbeta = "mug/handle"\nmu_v = 0.5\nrows = 4\n'
    )
    scenario = load_scenario(path)
    assert [shape.name for shape in scenario.system.shapes] == ["mug/mug#0", "mug/handle"]
    assert [pair.name for pair in scenario.pairs] == ["floor(floor, mug/handle)"]
    # The name of a link, or one that is there twice, would mean two things.
    for taken in ("mug", "a#b"):
        text = robot(mug.replace('name="handle"', f'name="{taken}"'))
        assert System([Body("mug", text)]).shapes[1].name == "mug/mug#1"
