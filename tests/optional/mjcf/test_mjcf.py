"""MJCF models read as MuJoCo reads them, and what is refused or listed of them."""

from importlib import import_module

import numpy as np
import pinocchio as pin
import pytest

from quasistatic_ref import Body, InputError, ModelError, System, load_scenario
from quasistatic_ref.optional.mjcf import compiler, mjcf
from quasistatic_ref.optional.mjcf.mjcf import mjcf_urdf
from quasistatic_ref.optional.show.figures.visuals import visuals
from quasistatic_ref.simulate.scene import Scene
from tests.closeness import assert_within
from tests.model.urdf.urdf_texts import urdf_of_text
from tests.oracles.mjcf_differences import CURVED, SAME, WORDS, differences, random_models

ARM = """<mujoco>
  <compiler angle="degree" eulerseq="zyx" autolimits="true"/>
  <option gravity="0 0 -3"/>
  <default>
    <geom density="700"/>
    <default class="thin"><geom type="capsule" size="0.02"/><joint damping="2"/></default>
  </default>
  <asset><mesh name="wedge" file="wedge.obj" scale="0.5 1 2"/></asset>
  <worldbody>
    <light pos="0 0 3"/>
    <geom name="floor" type="plane" size="1 1 0.1"/>
    <geom name="post" type="box" size="0.05 0.06 0.3" pos="0.5 0 0.3" euler="30 20 10"/>
    <body name="upper" pos="0 0 1" euler="10 -20 70" childclass="thin">
      <joint name="lift" type="slide" axis="0 0 1" range="-0.1 0.2"/>
      <joint name="swing" axis="0 1 0" pos="0.1 0 0.02" range="-90 90" ref="20" frictionloss="0.3"/>
      <joint name="roll" axis="1 0.5 0" pos="0 0.05 0" armature="0.01" stiffness="4"/>
      <geom fromto="0 0 0 0.3 0.1 0"/>
      <geom name="shell" type="ellipsoid" size="0.1 0.2 0.1" contype="0" conaffinity="0"/>
      <site name="tip" pos="0.3 0 0"/>
      <body name="hand" pos="0.3 0.1 0" quat="0.6 0 0.8 0">
        <joint name="turn" axis="0 0 1"/>
        <inertial pos="0.01 0.02 0.03" mass="0.4" fullinertia="2e-3 3e-3 4e-3 1e-4 2e-4 -1e-4"/>
        <geom name="pad" type="mesh" mesh="wedge" pos="0.1 0 0" axisangle="1 1 0 40"/>
        <geom type="box" size="0.01 0.02 0.03" contype="0" conaffinity="0"/>
      </body>
      <body pos="0 0 -0.2" xyaxes="0 1 0 -1 0 0">
        <joint axis="1 0 0" pos="0 0 0.1"/>
        <geom type="cylinder" size="0.03 0.05" mass="0.2"/>
        <geom type="sphere" size="0.04" pos="0 0 0.1"/>
      </body>
    </body>
  </worldbody>
  <actuator><position name="motor" joint="swing"/></actuator>
  <sensor><jointpos joint="roll"/></sensor>
</mujoco>
"""
WEDGE = """v 0 0 0
v 0.2 0 0
v 0 0.1 0
v 0 0 0.1
f 1 3 2
f 1 2 4
f 1 4 3
f 2 3 4
"""
BALL = '<mujoco><worldbody><body name="ball" pos="0 0 1"><freejoint/>{}</body></worldbody></mujoco>'


@pytest.fixture
def arm(tmp_path):
    urdf_of_text(tmp_path, WEDGE, "wedge.obj")
    return urdf_of_text(tmp_path, ARM, "arm.xml")


def test_everything_is_where_mujoco_has_it(arm):
    found = differences(arm, 5)
    assert (found.n_v, found.shapes) == (5, 5)
    assert max(found[3:8]) < SAME
    assert found.curved < CURVED


HALF = 2**-0.5
ELSEWHERE = {
    "refpos": ('refpos="0.3 0 0"', "", "wedge.obj", (-0.1, 0.1, 0.1)),
    "refquat": (f'refquat="{HALF} 0 0 {HALF}"', "", "wedge.obj", (0.1, 0.0, 0.1)),
    "strippath": ("", 'strippath="true"', "deep/wedge.obj", (0.2, 0.1, 0.1)),
    "meshdir": ("", 'meshdir="deep"', "wedge.obj", (0.4, 0.1, 0.1)),
}


@pytest.mark.parametrize(("mesh", "compiler", "file", "reach"), ELSEWHERE.values(), ids=ELSEWHERE)
@pytest.mark.parametrize("attached", [False, True])
@pytest.mark.usefixtures("in_this_process")
def test_a_mesh_is_where_and_what_the_format_says(tmp_path, mesh, compiler, file, reach, attached):
    """How far it reaches along x, y and z; the wedge in the folder `deep` is twice as long.

    Vertices v become R(refquat)' (v - refpos): a quarter turn about z leads x to -y, and y to x.
    """
    geom = '<body name="b"><geom name="pad" type="mesh" mesh="wedge"/></body>'
    asset = f'<asset><mesh name="wedge" file="{file}" {mesh}/></asset>'
    own = f"<mujoco><compiler {compiler}/>{asset}<worldbody>{geom}</worldbody></mujoco>"
    folder = tmp_path / "child" if attached else tmp_path
    (folder / "deep").mkdir(parents=True)
    urdf_of_text(folder, WEDGE, "wedge.obj")
    urdf_of_text(folder / "deep", WEDGE.replace("v 0.2", "v 0.4"), "wedge.obj")
    path = urdf_of_text(folder, own, "own.xml")
    if attached:  # beside the outer model, files of the same names are three times as long
        (tmp_path / "deep").mkdir()
        for place in (tmp_path, tmp_path / "deep"):
            urdf_of_text(place, WEDGE.replace("v 0.2", "v 0.6"), "wedge.obj")
        parts = '<asset><model name="m" file="child/own.xml"/></asset>'
        world = '<frame><attach model="m" body="b" prefix="p"/></frame>'
        strip = compiler if "strippath" in compiler else ""
        outer = f"<mujoco><compiler {strip}/>{parts}<worldbody>{world}</worldbody></mujoco>"
        path = urdf_of_text(tmp_path, outer, "outer.xml")
    system = System([Body("a", mjcf_urdf(path))])
    (placed,) = system.shapes
    found = placed.shape.support_value(placed.R) + placed.t  # along x, y and z of the body
    assert_within(found, reach, WORDS)


@pytest.mark.usefixtures("in_this_process")
def test_meshes_are_where_mujoco_has_them_however_they_are_written():
    tried = random_models(range(8))
    assert tried.right + len(tried.refused) == 8
    assert not tried.wrong
    assert not tried.refused
    assert {
        "refpos",
        "refquat",
        "scale",
        "strippath",
        "attach",
        "vertex",
        "builtin",
        "file",
    } <= set(tried.kinds)


def test_a_shape_that_is_not_mujocos_is_refused_by_its_name(arm, monkeypatch):
    def longer(model, g):
        shape = honest(model, g)
        if shape is not None and shape.tag == "mesh":
            shape.set("vertex", shape.get("vertex").replace("0.1", "0.100001", 1))
        return shape

    honest = mjcf._shape
    assert "<mesh " in mjcf_urdf(arm)
    monkeypatch.setattr(mjcf, "_shape", longer)
    with pytest.raises(ModelError, match=r"arm.xml: geom\[pad\]: is another shape, or elsewhere"):
        mjcf_urdf(arm)


def test_a_body_without_a_name_is_called_like_no_other(tmp_path):
    other = '<body name="body1"><geom name="of_body1" size="0.2"/></body>'
    world = f'<mujoco><worldbody><body><geom size="0.1"/></body>{other}</worldbody></mujoco>'
    system = System([Body("a", mjcf_urdf(urdf_of_text(tmp_path, world, "two.xml")))])
    assert system.links[1:] == ("a/worldbody", "a/body1_", "a/body1")
    masses = dict(zip(system.links, system.masses.tolist(), strict=True))
    # 1000 kg/m^3 times 4/3 pi r^3
    assert masses["a/body1_"] == pytest.approx(4e3 / 3 * np.pi * 0.1**3)
    assert masses["a/body1"] == pytest.approx(4e3 / 3 * np.pi * 0.2**3)


def test_a_free_body_is_the_root_and_moves_as_mujocos(tmp_path):
    shapes = '<geom type="sphere" size="0.1" pos="0.1 0.2 0"/><geom type="box" size="0.1 0.2 0.3"/>'
    path = urdf_of_text(tmp_path, BALL.format(shapes), "ball.xml")
    found = differences(path, 3)
    assert (found.n_v, found.shapes) == (6, 2)
    assert max(found[3:8]) < SAME
    with pytest.raises(ModelError, match=r'ball.xml: joint\[joint0\]\.type: moves .* "floating"'):
        mjcf_urdf(path)


def test_what_is_not_carried_over_is_listed_by_its_name(arm):
    system = System([Body("a", mjcf_urdf(arm), actuated="all")])
    assert system.links[1:] == (
        "a/worldbody", "a/upper:lift", "a/upper:swing", "a/upper:roll", "a/upper", "a/hand",
        "a/body3:joint4", "a/body3",
    )  # fmt: skip
    (swing,) = [joint for joint in system.joints if joint.name == "a/swing"]
    assert swing.limits == pytest.approx(np.radians([-110, 70]))  # from ref on
    assert {name.removeprefix("a: ") for name in system.ignored} == {
        "option", "actuator.general[motor]", "sensor.jointpos", "site[tip]", "light",
        "joint[swing].dynamics.friction", "joint[swing].ref", "joint[roll].armature",
        "joint[roll].stiffness", "default[thin].joint.damping", "geom[floor]", "geom[shell]",
        "asset.mesh[wedge].content_type",
        *(f"joint[{name}].limit" for name in ("lift", "swing", "roll", "turn", "joint4")),
        *(f"link[{name}].visual" for name in ("worldbody", "upper", "hand", "body3")),
        *(f"link[{name}].collision[0].friction" for name in ("worldbody", "upper", "hand")),
        *(f"link[body3].collision[{i}].friction" for i in (0, 1)),
    }  # fmt: skip


COLOURED = """<mujoco>
  <asset><material name="blue" rgba="0 0 1 1"/></asset>
  <worldbody>
    <geom size="0.1"/><geom size="0.1" rgba="1 0 0 1"/><geom size="0.1" material="blue"/>
    <geom size="0.1" rgba="0 1 0 0"/><geom size="0.1" group="3"/>
  </worldbody>
</mujoco>"""


def test_what_mujoco_draws_is_seen_in_its_colours(tmp_path):
    path = urdf_of_text(tmp_path, COLOURED, "scene.xml")
    found = visuals(Scene(System([Body("a", mjcf_urdf(path))]), ()))
    assert [visual.colour for visual in found] == ["#808080", "#ff0000", "#0000ff"]


def test_the_reader_of_pinocchio_still_drops_bodies_and_masses(tmp_path):
    """Why it is not used: once this fails, it may be."""
    ball = (
        '<body name="{0}"><joint name="{0}" axis="0 0 1"/>'
        '<geom size="0.1" mass="2" contype="{1}" conaffinity="{1}"/></body>'
    )
    world = "<mujoco><worldbody>{}</worldbody></mujoco>"
    two = urdf_of_text(tmp_path, world.format(ball.format("a", 1) + ball.format("b", 1)), "two.xml")
    assert pin.buildModelFromMJCF(str(two)).nv == 1
    apart = urdf_of_text(tmp_path, world.format(ball.format("a", 0)), "apart.xml")
    assert pin.buildModelFromMJCF(str(apart)).inertias[1].mass == 0.0
    assert System([Body("a", mjcf_urdf(apart), actuated="all")]).masses[-1] == 2.0


def test_without_mujoco_one_sentence_says_what_to_install(arm, monkeypatch):
    def missing(name):
        raise ImportError(name)

    monkeypatch.setattr(compiler, "import_module", missing)
    with pytest.raises(ModelError, match=r"needs MuJoCo: pip install 'quasistatic-ref\[engines\]'"):
        mjcf.mjcf_urdf(arm)


REFUSED = {
    '<geom size="0.1 0.2 0.1" type="ellipsoid"/>': (
        r"geom\[geom0\]\.type: is not supported for ellipsoids that bodies touch with"
    ),
    '<geom size="0.1"/></body><body><geom size="0.1"/>': (
        r"joint\[joint0\]\.type: is supported for one body without others"
    ),
    '<geom size="0.1"/></body><body mocap="true">': r"body\[body2\]\.mocap: is not supported",
    '<geom size="0.1"/></body></worldbody><equality><weld name="w" body1="ball"/></equality>'
    "<worldbody><body>": r"equality\[w\]: ties bodies or joints",
    "<geon/>": r"ball\.xml: geon: MuJoCo refuses it: XML Error: Schema violation",
}


@pytest.mark.parametrize(("inside", "says"), REFUSED.items())
def test_what_a_urdf_cannot_say_is_refused_by_element(tmp_path, inside, says):
    path = urdf_of_text(tmp_path, BALL.format(inside), "ball.xml")
    with pytest.raises(ModelError, match=says):
        mjcf_urdf(path, "floating")


SCENE = """format = "quasistatic-ref/scenario"
version = 1
h = 0.01
steps = 3
[bodies.arm]
mjcf = "arm.xml"
actuated = ["lift", "roll", "turn"]
K_q = { lift = 500, roll = 5, turn = 5 }
joint_friction = "urdf"
"""


def test_a_scenario_takes_mjcf_where_it_takes_a_urdf(arm):
    scene = urdf_of_text(arm.parent, SCENE, "scene.toml")
    assert load_scenario(scene).system.n_a == 3  # its un-actuated slides and hinges have no mass
    everything = {"bodies.arm.actuated": "all", "bodies.arm.K_q": np.diag([500.0] * 5).tolist()}
    scenario = load_scenario(scene, everything)
    assert scenario.of_bodies.rises.loads.tolist() == [0.3]
    assert set(scenario.run(progress=False)["certificate"].tolist()) == {"exact"}
    for change, says in (
        ({"bodies.arm.urdf": "arm.urdf"}, r"bodies.arm.mjcf: cannot be combined with urdf"),
        ({"bodies.arm.mjcf": "none.xml"}, r"none.xml: no such file"),
    ):
        with pytest.raises(InputError, match=says):
            load_scenario(scene, everything | change)
    with pytest.raises(InputError, match=r'must be <robot>; give an MJCF model as mjcf = "FILE"'):
        System([Body("arm", arm)])


BALLS = """<mujoco><worldbody><body name="arm" pos="0 0 1" euler="10 20 30">
  <joint name="a" type="ball" pos="0.05 0.02 -0.1" range="0 50" limited="true" frictionloss="0.2"/>
  <geom type="capsule" size="0.03" fromto="0 0 0 0.3 0.1 0"/>
  <body name="fore" pos="0.3 0.1 0" euler="0 40 0"><joint name="b" type="ball"/>
    <geom type="box" size="0.03 0.04 0.1" pos="0 0 0.1"/></body></body></worldbody></mujoco>"""


def test_balls_have_the_mass_matrix_and_the_weight_that_mujoco_gives_them(tmp_path, rng):
    mujoco = import_module("mujoco")
    path = urdf_of_text(tmp_path, BALLS, "balls.xml")
    system = System([Body("robot", mjcf_urdf(path))])
    assert {"robot: joint[a].range", "robot: joint[a].frictionloss"} <= set(system.ignored)
    model = mujoco.MjModel.from_xml_path(str(path))
    data = mujoco.MjData(model)
    q = system.integrate(system.q_start, rng.normal(size=6))
    data.qpos[:] = q.reshape(2, 4)[:, [3, 0, 1, 2]].ravel()  # w first
    mujoco.mj_forward(model, data)
    M = np.zeros((6, 6))
    for e, column in zip(np.eye(6), M, strict=True):
        mujoco.mj_mulM(model, data, column, e)
    assert_within(system.M_u(q), M, 1e-14)
    weight = system.gravity_force(q, model.opt.gravity)
    assert_within(weight, -data.qfrc_bias, 1e-13)
