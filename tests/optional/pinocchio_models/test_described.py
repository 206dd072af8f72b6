"""A pinocchio Model as a body: next to the reader of files, and next to pinocchio itself."""

import copy
import pickle
import re
from importlib.metadata import distribution
from pathlib import Path

import coal
import numpy as np
import pinocchio as pin
import pytest

from quasistatic_ref import (
    Body,
    InputError,
    ModelError,
    Simulator,
    System,
    derivatives,
    load_scenario,
)
from tests.closeness import assert_close, assert_within
from tests.files.urdf.urdf_texts import CHAIN, collision, inertial, joint, link, robot
from tests.pages import ROOT
from tests.tolerances import COAL, ROUNDING

SINGLE = 1e-7
"""Hulls of meshes [m]: pinocchio's reader of meshes keeps coordinates in single precision."""

DIRECTIONS = np.random.default_rng(3).normal(size=(40, 3))
DIRECTIONS /= np.linalg.norm(DIRECTIONS, axis=1)[:, None]
COMMITTED = sorted((ROOT / "models").glob("*/*.urdf"))
REPLACED = {"simple_humanoid.urdf"}
"""Its own element ``collision_checking`` has pinocchio take a capsule for a cylinder."""


def read_by_pinocchio(file, package_dirs=()):
    """Model and GeometryModel of a file or a text, as pinocchio's own reader makes them."""
    text = isinstance(file, str)
    model = (pin.buildModelFromXML if text else pin.buildModelFromUrdf)(str(file), mimic=True)
    shapes = pin.buildGeomFromUrdfString if text else pin.buildGeomFromUrdf
    kind, folders = pin.GeometryType.COLLISION, [".", *map(str, package_dirs)]
    return model, shapes(model, str(file), kind, package_dirs=folders)


def somewhere(system):
    """A configuration away from the start."""
    return system.integrate(system.q_start, 0.5 * np.random.default_rng(0).normal(size=system.n_v))


def assert_same_shapes(one, other):
    """Of each link the same shapes at the same places, whatever they are called."""
    order = [other.links.index(name) for name in one.links]
    assert len(one.shapes) == len(other.shapes)
    there = sorted(other.shapes, key=lambda shape: order.index(shape.link))
    for a, b in zip(sorted(one.shapes, key=lambda shape: shape.link), there, strict=True):
        assert order[a.link] == b.link
        assert type(a.shape) is type(b.shape), a.name
        tolerance = SINGLE if hasattr(a.shape, "vertices") else ROUNDING
        far_a, far_b = (
            one.shape.support_value(DIRECTIONS @ one.R) + DIRECTIONS @ one.t for one in (a, b)
        )
        assert_within(far_b, far_a, tolerance)


def read_both_ways(file, package_dirs=()):
    """A file as the own reader reads it, all actuated, and as pinocchio does."""
    read = read_by_pinocchio(file, package_dirs)
    return System([Body("r", file, actuated="all", package_dirs=package_dirs)]), *read


def assert_one_body(own, model, geometry):
    """What the own reader has of a file, and pinocchio's Model of it, are one body."""
    (body,) = own.bodies
    file, package_dirs = body.urdf, body.package_dirs
    theirs = System([Body.of_pinocchio("r", model, geometry, actuated="all")])
    assert [c.name for c in theirs.coordinates] == [c.name for c in own.coordinates]
    assert sorted(theirs.links) == sorted(own.links)
    order = [theirs.links.index(name) for name in own.links]
    q = somewhere(own)
    here, there = own.kinematics(q), theirs.kinematics(q)
    assert_close(there.R[order], here.R)
    assert_close(there.t[order], here.t)
    assert_close(there.J[order], here.J)
    for a, b in zip(own.joints, theirs.joints, strict=True):
        assert b.effort == a.effort
        if a.limits != (0.0, 0.0):  # which pinocchio also writes where there are none
            assert b.limits == a.limits
    assert sorted((m.name, m.of) for m in theirs.mimics) == sorted(
        (m.name, m.of) for m in own.mimics
    )
    if Path(str(file)[:200]).name not in REPLACED:
        assert_same_shapes(own, theirs)
    try:
        own = System([Body("r", file, package_dirs=package_dirs)])
    except ModelError:  # a link without mass, which must be actuated
        return
    theirs = System([Body.of_pinocchio("r", model, geometry)])
    q = somewhere(own)
    assert_close(theirs.M_u(q), own.M_u(q))
    down = (1.0, 2.0, -9.81)
    assert_close(theirs.at(q).gravity(down), own.at(q).gravity(down), 1e-10)


@pytest.mark.parametrize("file", COMMITTED, ids=lambda file: "/".join(file.parts[-2:]))
def test_a_committed_urdf_and_its_model_are_one_body(file):
    assert_one_body(*read_both_ways(file))


def test_a_chain_with_a_mimic_a_wheel_and_a_weld_and_its_model_are_one_body():
    assert_one_body(*read_both_ways(CHAIN))


@pytest.mark.extra("robots")
@pytest.mark.parametrize("part", range(4))
def test_robots_that_both_read_are_one_body_either_way(part):
    share = Path(distribution("example-robot-data").locate_file("cmeel.prefix/share"))
    files = sorted(share.glob("example-robot-data/robots/**/*.urdf"))[part::4]
    same = 0
    for file in files:
        try:
            ways = read_both_ways(file, [share])
        except (ValueError, RuntimeError):  # by one of both
            continue
        assert_one_body(*ways)
        same += 1
    assert same >= 0.8 * len(files)


def assert_as_in_pinocchio(model, geometry=None):
    """A Model's own frames, Jacobians and mass matrix next to those of the body made of it."""
    system = System([Body.of_pinocchio("r", model, geometry)])
    assert system.n_v == model.nv
    q = somewhere(system)  # all are un-actuated: in the Model's order
    data = model.createData()
    pin.computeJointJacobians(model, data, q)
    pin.updateFramePlacements(model, data)
    kinematics = system.kinematics(q)
    for i, frame in enumerate(model.frames):
        if frame.type != pin.FrameType.BODY:
            continue
        link = system.link(f"r/{frame.name}")
        assert_close(kinematics.R[link], data.oMf[i].rotation)
        assert_close(kinematics.t[link], data.oMf[i].translation)
        J = pin.getFrameJacobian(model, data, i, pin.ReferenceFrame.LOCAL_WORLD_ALIGNED)
        assert_close(kinematics.J[link], J)
    assert_close(system.M_u(q), pin.crba(model, data, q))
    if geometry is not None:
        placed = pin.GeometryData(geometry)
        pin.updateGeometryPlacements(model, data, geometry, placed, q)
        for each, place in zip(geometry.geometryObjects, placed.oMg, strict=True):
            shape = next(s for s in system.shapes if s.name == f"r/{each.name}")
            R, t = kinematics.R[shape.link], kinematics.t[shape.link]
            assert_close(R @ shape.t + t, place.translation)
            assert_close(R @ shape.R, place.rotation)
    return system


def test_pinocchio_s_own_samples_are_bodies():
    arm = pin.buildSampleModelManipulator()
    assert_as_in_pinocchio(arm, pin.buildSampleGeometryModelManipulator(arm))
    humanoid = pin.buildSampleModelHumanoid()
    system = assert_as_in_pinocchio(humanoid, pin.buildSampleGeometryModelHumanoid(humanoid))
    assert system.bodies[0].base == "floating"


ROOTS = {
    "floating": pin.JointModelFreeFlyer(),
    "planar": pin.JointModelPlanar(),
    "ball": pin.JointModelSpherical(),
}
INERTIA = pin.Inertia(2.0, np.array([0.1, -0.2, 0.3]), np.diag([0.02, 0.03, 0.04]))
PLACE = pin.SE3(pin.utils.rpyToMatrix(0.3, -0.2, 0.5), np.array([0.1, 0.2, 0.3]))
AXIS = np.array([2.0, -1.0, 2.0]) / 3


def hand_made(*joints, first=None):
    """A Model of joints in a row, named z, y, x, ..., each with a BODY frame off its origin."""
    model = pin.Model()
    last = 0
    for i, kind in enumerate(joints):
        place = first if i == 0 and first is not None else PLACE
        last = model.addJoint(last, kind, place, "zyxwvut"[i])
        model.appendBodyToJoint(last, INERTIA, PLACE)
        model.addBodyFrame(f"body {i}", last, PLACE, 0)
    return model


def hinged():
    """A Model of one link on a hinge."""
    return hand_made(pin.JointModelRX())


@pytest.mark.parametrize("base", ROOTS)
def test_a_root_joint_is_the_base(base):
    slide = pin.JointModelPrismaticUnaligned(AXIS)
    model = hand_made(ROOTS[base], slide, first=pin.SE3.Identity())
    system = assert_as_in_pinocchio(model)
    assert system.bodies[0].base == base
    assert [joint.name for joint in system.joints] == ["r/base", "r/y"]
    moved = Body.of_pinocchio("r", model, xyz=(0.0, 0.0, 0.4), actuated=["base"])
    assert System([moved]).n_a == system.joints[0].v.stop
    with pytest.raises(ModelError, match=rf"r\.base: must be '{base}', as the root joint"):
        Body.of_pinocchio("r", model, base="fixed")


def test_joints_keep_the_model_s_order_and_axes():
    joints = [
        pin.JointModelRX(), pin.JointModelPZ(), pin.JointModelSpherical(), pin.JointModelRUBY(),
        pin.JointModelRevoluteUnaligned(AXIS), pin.JointModelPrismaticUnaligned(AXIS),
    ]  # fmt: skip
    system = assert_as_in_pinocchio(hand_made(*joints))
    assert [joint.name for joint in system.joints] == [f"r/{letter}" for letter in "zyxwvu"]


def test_without_mimic_its_joints_are_free_ones():
    system = System([Body.of_pinocchio("r", pin.buildModelFromXML(CHAIN))])
    assert not system.mimics
    assert system.n_v == 1 + System([Body("r", CHAIN)]).n_v


SHAPES = {
    "box": coal.Box(0.1, 0.2, 0.3),
    "sphere": coal.Sphere(0.1),
    "capsule": coal.Capsule(0.1, 0.3),
    "cylinder": coal.Cylinder(0.1, 0.3),
    "cone": coal.Cone(0.1, 0.3),
    "ellipsoid": coal.Ellipsoid(0.1, 0.2, 0.3),
}


def geometry_of(shape, joint=1, frame=1):
    geometry = pin.GeometryModel()
    geometry.addGeometryObject(pin.GeometryObject("s", joint, frame, PLACE, shape))
    return geometry


@pytest.mark.parametrize("name", SHAPES)
def test_a_shape_has_coal_s_size_and_place(name):
    """Its distance to a point, along many directions, is coal's."""
    shape = SHAPES[name]
    model = hinged()
    system = System([Body.of_pinocchio("r", model, geometry_of(shape))])
    placed = system.shapes[0]
    here = coal.Transform3s(placed.R, placed.t)
    for direction in DIRECTIONS[:10]:
        far = placed.t + direction
        apart = coal.distance(
            shape, here, coal.Sphere(0.0), coal.Transform3s(np.eye(3), far),
            coal.DistanceRequest(), coal.DistanceResult(),
        )  # fmt: skip
        local = (far - placed.t) @ placed.R
        assert_within(placed.shape.signed_distance(local[None])[0], apart, COAL)


DENTED = """v 0 0 0\nv 0.1 0 0\nv 0 0.1 0\nv 0 0 0.1\nv 0.02 0.02 0.02
f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 5\nf 3 4 5\nf 4 2 5\n"""
"""A tetrahedron, in whose fourth face a fifth corner is pressed."""


def test_a_mesh_is_its_hull_and_says_whether_it_is_convex(tmp_path):
    file = tmp_path / "dented.obj"
    file.write_text(DENTED)
    dented = coal.MeshLoader().load(str(file), np.ones(3))
    system = System([Body.of_pinocchio("r", hinged(), geometry_of(dented))])
    hull = system.shapes[0].shape
    assert len(hull.vertices) == 4
    assert not hull.is_convex
    assert any("hull = true" in note for note in system.notes)


def test_a_scene_holds_a_model_and_runs():
    arm = pin.buildSampleModelManipulator()
    body = Body.of_pinocchio(
        "arm", arm, pin.buildSampleGeometryModelManipulator(arm), actuated="all"
    )
    table = {"urdf": body, "K_q": 100.0}
    scene = {"h": 0.01, "steps": 2, "bodies": {"arm": table}, "contacts": {}}
    scenario = load_scenario(scene)
    assert scenario.run(progress=False, findings=False).steps == 2
    system = scenario.system
    assert system == pickle.loads(pickle.dumps(system)) == copy.deepcopy(system)
    assert re.fullmatch(r"pinocchio Model '', sha256 [0-9a-f]{64}", system.texts[0])
    (note,) = [note for note in system.notes if "has no URDF" in note]
    assert note.startswith("arm: is made of a pinocchio Model")
    for word in ("joint_friction", "joint_limits"):
        scene["bodies"]["arm"] = table | {word: "urdf"}
        with pytest.raises(InputError, match="made of a pinocchio Model, which has no URDF: give"):
            load_scenario(scene)


def of_inertia(mass=1.0, lever=0.0):
    model = hinged()
    model.inertias[1].mass = mass
    model.inertias[1].lever = np.full(3, lever)
    return model


def twice_named():
    model = hinged()
    model.addBodyFrame("z", 1, PLACE, 0)
    return model


def with_a_swollen_box():
    box = coal.Box(0.1, 0.1, 0.1)
    box.setSweptSphereRadius(0.01)
    return hinged(), geometry_of(box)


ROOT = hand_made(pin.JointModelFreeFlyer(), first=pin.SE3.Identity())
REFUSED = {
    "a joint of two axes": (
        lambda: (hand_made(pin.JointModelTranslation()),),
        r"joint\[z\]: is a JointModelTranslation; known are joints of one axis",
    ),
    "a composite": (
        lambda: (hand_made(pin.JointModelComposite(pin.JointModelRX())),),
        r"joint\[z\]: is a JointModelComposite; .* make it joints of one axis, each on a body with",
    ),
    "a planar joint in the middle": (
        lambda: (hand_made(pin.JointModelRX(), pin.JointModelPlanar()),),
        r"joint\[y\]: is a JointModelPlanar that is not at the world's origin, or does not carry",
    ),
    "a free flyer off the origin": (
        lambda: (hand_made(pin.JointModelFreeFlyer()),),
        r"joint\[z\]: is a JointModelFreeFlyer that is not at the world's origin",
    ),
    "a plane": (
        lambda: (hinged(), geometry_of(coal.Plane(np.eye(3)[2], 0.0))),
        r"geometry\[s\]: is a Plane; known are Box, .* and meshes",
    ),
    "a swept-sphere radius": (with_a_swollen_box, r"geometry\[s\]: has a swept-sphere radius"),
    "a shape of the world": (
        lambda: (ROOT, geometry_of(coal.Sphere(0.1), 0, 0)),
        r"geometry\[s\]: stands still in the world: give it as a shape of the scene",
    ),
    "a negative mass": (lambda: (of_inertia(mass=-1.0),), r"must not have a negative mass"),
    "no number": (lambda: (of_inertia(lever=np.nan),), r"link\[z\].inertia: must hold finite"),
    "a name twice": (lambda: (twice_named(),), r"frame\[z\]: is the name of two links, or of a"),
    "a file": (lambda: ("arm.urdf",), r"model: must be a pinocchio.Model, as pin"),
    "a wrong geometry": (lambda: (ROOT, "arm.urdf"), r"geometry: must be a pinocchio.Geometry"),
}


@pytest.mark.parametrize("what", REFUSED)
def test_a_part_of_pinocchio_without_a_place_is_refused_by_name(what):
    made, message = REFUSED[what]
    with pytest.raises(InputError, match=message):
        Body.of_pinocchio("r", *made())


BOX = collision('<box size="1 1 1"/>')
SILENT = {
    "an unknown shape": (link("b", BOX + collision('<cone radius="1" length="1"/>')), 2.0, 0),
    "a number with a tail": (link("b", collision('<sphere radius="0.1m"/>')), 2.0, 0),
    "a box of two sizes": (link("b", collision('<box size="1 1"/>')), 2.0, 0),
    "a mass with a tail": (link("b", BOX, inertial("1kg")), 0.0, 0),
    "a negative radius": (link("b", collision('<sphere radius="-0.1"/>')), 2.0, 1),
    "a negative mass": (link("b", BOX, inertial("-1")), -1.0, 1),
    "no inertia": (link("b", BOX, ""), 0.0, 1),
    "an impossible inertia": (link("b", BOX, inertial(moments=("5", "1", "1"))), 2.0, 1),
    "a misspelt element": (link("b", BOX.replace("<geo", '<orgin xyz="1 2 3"/><geo', 1)), 2.0, 1),
    "two shapes": (link("b", collision('<box size="1 1 1"/><sphere radius="1"/>')), 2.0, 1),
    "two inertials": (link("b", BOX, inertial() + inertial("3")), 2.0, 1),
}
"""A link; its mass [kg] and number of shapes in pinocchio. docs/libraries.md lists them."""


@pytest.mark.parametrize("what", SILENT)
def test_texts_that_pinocchio_takes_in_silence_are_refused(what):
    moved, mass, count = SILENT[what]
    text = robot(link("a"), moved, joint("j", "a", "b"))
    model, geometry = read_by_pinocchio(text)
    assert model.inertias[1].mass == mass
    assert geometry.ngeoms == count
    with pytest.raises(ModelError, match=r"link\[b\]"):
        System([Body("r", text)])


def test_an_axis_of_length_0_is_refused_by_the_own_reader_alone():
    text = robot(link("a"), link("b"), joint("j", "a", "b", axis="0 0 0"))
    assert read_by_pinocchio(text)[0].nv == 1
    with pytest.raises(ModelError, match=r"joint\[j\]\.axis\.xyz: must not be zero"):
        System([Body("r", text)])


def test_a_capsule_of_version_1_0_has_no_shape_in_pinocchio():
    rod = link("b", collision('<capsule radius="0.1" length="0.2"/>'))
    text = robot(link("a"), rod, joint("j", "a", "b")).replace("1.1", "1.0", 1)
    assert read_by_pinocchio(text)[1].ngeoms == 0
    assert len(System([Body("r", text)]).shapes) == 1


@pytest.mark.parametrize(
    ("lower", "upper", "limits"),
    [(-1.0, np.inf, (-1.0, np.inf)), (-np.inf, np.inf, None), (0.0, 0.0, None), (1.0, -1.0, None)],
)
def test_a_joint_may_be_bounded_on_one_side(lower, upper, limits):
    model = hand_made(pin.JointModelPZ())
    model.lowerPositionLimit[:] = lower
    model.upperPositionLimit[:] = upper
    (joint,) = System([Body.of_pinocchio("r", model)]).joints
    assert joint.limits == limits


ARM = robot(
    link("w", inertial=""),
    link("arm"),
    link("hand"),
    link("tool"),
    link("cup"),
    joint("turn", "w", "arm", axis="0 1 0"),
    joint("weld", "arm", "hand", "fixed", more='<origin xyz="0 0 0.3"/>'),
    joint("bend", "hand", "tool", axis="1 0 0", more='<origin xyz="0 0 0.2"/>'),
    joint("glue", "tool", "cup", "fixed", more='<origin xyz="0.1 0 0"/>'),
)
"""Two bodies of two links each."""


def arm_simulator(body):
    system = System([body])
    return Simulator(system, [], h=0.01, K_q=10.0, gravity_acts=[True] * system.n_a)


def test_masses_of_welded_links_of_a_model_have_no_derivative_and_those_of_its_urdf_do():
    """The URDF has the masses of all links, the Model that of each two."""
    model = pin.buildModelFromXML(ARM)
    of_file = arm_simulator(Body("arm", ARM, actuated="all"))
    of_model = arm_simulator(Body.of_pinocchio("arm", model, actuated="all"))
    q = np.array([0.3, -0.2])
    right = derivatives(of_file, q, q, by="masses")
    found = derivatives(of_model, q, q, by=("masses", "q"))
    welded = [of_model.system.links.index(f"arm/{name}") for name in ("arm", "hand", "tool", "cup")]
    assert np.isfinite(right.dq_dmasses).all()
    assert np.isnan(found.dq_dmasses[:, welded]).all()
    assert np.isfinite(found.dq_dq).all()
    assert {reason.fields for reason in found.reasons} == {("dq_dmasses",)}
    assert "one mass for all links that are welded" in found.reasons[0].sentence
    with pytest.raises(InputError, match=r"along: .* one mass for all links .*: arm/hand"):
        found.along(masses=np.eye(len(of_model.system.links))[welded[1]])
    for copied in (copy.deepcopy(of_model), pickle.loads(pickle.dumps(of_model))):
        assert copied.system.welded == of_model.system.welded


def test_a_model_whose_joints_move_one_link_each_has_derivatives_by_masses():
    model = pin.Model()
    inertia = pin.Inertia(2.0, np.array([0.1, 0.0, 0.2]), 0.02 * np.eye(3))
    number = model.addJoint(0, pin.JointModelRY(), pin.SE3.Identity(), "turn")
    model.appendBodyToJoint(number, inertia, pin.SE3.Identity())
    model.addBodyFrame("arm", number, pin.SE3.Identity(), 0)
    simulator = arm_simulator(Body.of_pinocchio("arm", model, actuated="all"))
    q = np.array([0.3])
    found = derivatives(simulator, q, q, by="masses").dq_dmasses[0]
    lever = 9.81 * (0.1 * np.cos(0.3) + 0.2 * np.sin(0.3)) / 10.0
    assert_within(found[simulator.system.links.index("arm/arm")], lever, 1e-10)
