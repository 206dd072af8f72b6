"""Fingers led astray, fillers in the sentence of idle contacts, and runs without targets."""

import mujoco
import numpy as np
import pytest

import quasistatic_ref as qr
from quasistatic_ref.simulate.target import JointTrack, Targets
from tests.files.urdf.urdf_texts import collision, link, robot
from tests.optional.doctor.words import TIP, block, driven, fingers, free, joint, scene, slides


def grasp(kind="prismatic", axis="0 -1 0", at=0.0):
    """What is found where two fingers close by 10 mm on a block that stands between them.

    The left one slides, or is a lever of 0.1 m that turns by 0.15 rad.
    """
    tip = '<box size="0.02 0.02 0.02"/>'
    turns = kind == "revolute"
    lever = 0.1 if turns else 0.0
    hand = robot(
        link("hand", inertial=""),
        link("l", collision(tip, f'<origin xyz="{lever} 0 0"/>'), inertial=""),
        link("r", collision(tip), inertial=""),
        joint("left", "hand", "l", axis, kind, (-lever, 0.05, 0)),
        joint("right", "hand", "r", "0 1 0", at=(0, -0.05, 0)),
    )
    K_q = {"left": 5.0 if turns else 500.0, "right": 500.0}
    closed = {"t": 1.0, "left": 0.15 if turns else 0.015, "right": 0.015}
    bodies = {
        "gripper": driven(hand, (0, 0, 0.03), K_q, [{"t": 0.0, "left": 0.0, "right": 0.0}, closed]),
        "block": free(block(0.3, (0.06, 0.06, 0.06)), (at, 0, 0.03)),
    }
    contacts = {
        "floor": ("floor", "block", 0.5, 4),
        "grip": (["gripper/l", "gripper/r"], "block", 0.5, 4),
    }
    return scene(bodies, contacts, 50, h=0.02, fast=True).run(progress=False).findings


@pytest.mark.parametrize(("kind", "right", "wrong"), [
    ("prismatic", "0 -1 0", "0 1 0"),
    ("revolute", "0 0 -1", "0 0 1"),
])  # fmt: skip
def test_a_finger_whose_axis_is_reversed_is_named(kind, right, wrong):
    assert not any(one.grave for one in grasp(kind, right))
    said = [one for one in grasp(kind, wrong) if one.grave]
    assert [one.name for one in said] == ["idle-contacts"]
    assert said[0].remedy == "check the axis of gripper/left, or the sign of its targets"
    assert said[0].numbers["away_mm"] == pytest.approx(
        15.0, rel=0.11
    )  # a lever's corner, to first order


def test_a_finger_that_comes_near_is_not_led_astray():
    """The block is beside both fingers."""
    (found,) = [one for one in grasp(at=0.2) if one.name == "idle-contacts"]
    assert found.remedy.startswith("check where block/solid stands")


HAND = """<mujoco><worldbody><geom name="floor" type="plane" size="1 1 .1"/>
<body name="finger" pos="{at} 0 0.05"><joint name="slide" type="slide" axis="1 0 0"/>
<geom name="tip" type="box" size="0.02 0.02 0.02" mass="0.1"/></body>
<body name="box" pos="0 0 0.05"><freejoint/>
<geom name="box" type="box" size="0.05 0.05 0.05" mass="1"/></body></worldbody>
<actuator><position name="slide" joint="slide" kp="100"/></actuator></mujoco>"""


@pytest.mark.parametrize(
    ("at", "words"),
    [(-0.4, "none comes near enough to have a distance"), (-0.1, "is 28.2 mm apart")],
    ids=["beyond the margin", "within it"],
)
def test_a_filler_is_no_distance_of_idle_contacts(at, words):
    model = mujoco.MjModel.from_xml_string(HAND.format(at=at))
    scene = qr.mujoco_scenario(model, h=0.01, margin=0.1)
    (joint,) = [one for one in scene.system.joints if one.actuated]
    start = scene.system.q_start
    track = JointTrack(joint, np.array([0.0, 0.1]), np.array([[0.0], [0.002]]))
    targets = Targets(start[: scene.system.n_q_a], [track])
    run = qr.rollout(scene.simulator(), start, targets, 10, progress=False)
    (found,) = [one for one in run.findings if one.name == "idle-contacts"]
    assert words in found.cause
    assert "e+0" not in found.sentence


def test_a_mujoco_scene_may_be_run_without_targets():
    """To see how it stands: what is missing is said, and is no grave mistake."""
    run = qr.mujoco_scenario(mujoco.MjModel.from_xml_string(HAND.format(at=-0.4)), steps=3)
    (found,) = run.run(progress=False).findings
    assert (found.name, found.grave) == ("no-motion", False)
    assert "--targets" in found.remedy
    assert "contacts." not in found.sentence


def on_springs(urdf, K, targets, xyz=(0, 0, 0), base="floating"):
    """Table of a body whose base has springs."""
    return driven(urdf, xyz, {"base": K}, targets) | {"base": base}


@pytest.mark.parametrize(("K", "far"), [(1000.0, True), (2100.0, False)])
def test_a_base_on_springs_that_ends_far_from_its_target_is_named(K, far):
    """A palm that lifts 1 kg by 50 mm ends 9.81 N / K lower; a tenth of its way is 1962 N/m."""
    way = [(0, -0.01), (0.5, -0.01), (2, 0.04), (2.5, 0.04)]
    targets = [{"t": t, "base": {"xyz": [0, 0, z]}} for t, z in way]
    palm = on_springs(block(0.1, (0.2, 0.2, 0.02)), [K] * 6, targets, (0, 0, -0.01))
    bodies = {"p": palm, "b": free(block(1.0, (0.1, 0.1, 0.1)), (0, 0, 0.05))}
    made = scene(bodies, {"c": ("p", "b", 0.5, 4)}, 130, h=0.02, fast=True)
    found = made.run(progress=False).findings
    said = [one for one in found if one.name == "far-from-target"]
    assert [one.remedy for one in said] == ["raise K_q of p/base to 2e+03 or more"] * far
    assert all(one.numbers["error_m"] == pytest.approx(9.81 / K, rel=1e-3) for one in said)


@pytest.mark.parametrize("limits", [[-0.002, 0.0], [0.0, 0.0]])
def test_a_joint_at_a_limit_of_its_table_is_not_short_of_its_target(limits):
    """No spring is stiff enough: of 10 mm the limit leaves 2 mm, or nothing."""
    targets = [{"t": 0.0, "z": 0.0}, {"t": 0.05, "z": -0.01}]
    finger = driven(slides("z", TIP), (0, 0, 1), {"z": 10.0}, targets)
    run = scene({"finger": finger | {"joint_limits": {"z": limits}}}, {}, 10).run(progress=False)
    assert run.q[-1] == limits[0]
    assert "far-from-target" not in [one.name for one in run.findings]


@pytest.mark.parametrize("load", [0.0, 1.0])
def test_forces_on_a_base_that_cancel_do_not_stop_it(load):
    """A finger in front stops it 50 mm short. With one behind, which presses as much, a load does.

    The fingers press with 2.5 N each; the load is that of the base's spring at 50 mm.
    """
    hand = robot(link("hand", inertial=""), *fingers("hand", 0, 0.05))
    rest = {"t": 0.0, "left": 0.0, "right": 0.0}
    closed = {"t": 0.5, "left": 0.015, "right": 0.015 * load}
    way = [{"t": t, "base": {"xyz": [0, y, 0]}} for t, y in [(0, 0), (0.5, 0.05), (0.8, 0.05)]]
    body = on_springs(block(0.1, (0.06, 0.06, 0.06)), [20.0] * 6, way)
    body["wrenches"] = [{"t": t, "force": [0, f, 0]} for t, f in [(0, 0), (0.5, -load)]]
    gripper = driven(hand, (0, 0, 0), {"left": 500.0, "right": 500.0}, [rest, closed])
    grip = ("gripper/*", "b", 0.5, 1)
    made = scene({"gripper": gripper, "b": body}, {"grip": grip}, 45, h=0.02, fast=True)
    found = made.run(progress=False).findings
    said = [one for one in found if one.name == "far-from-target"]
    assert [one.remedy for one in said] == ["raise K_q of b/base to 200 or more"] * (load > 0)
    assert all(one.numbers["error_m"] == pytest.approx(0.05, rel=1e-6) for one in said)


def test_an_angle_of_a_planar_base_is_no_length():
    """A torque of 0.5 N m turns a spring of 1 N m/rad by 0.5 rad; x ends at its target."""
    way = [(0.0, 0.0), (0.5, 0.05), (0.8, 0.05)]
    targets = [{"t": t, "base": {"xyz": [x, 0, 0]}} for t, x in way]
    body = on_springs(block(0.1, (0.2, 0.2, 0.02)), [1e3, 1e3, 1.0], targets, base="planar")
    body["wrenches"] = [{"t": 0.0, "force": [0, 0, 0], "torque": [0, 0, 0.5]}]
    run = scene({"p": body}, {}, 45, h=0.02, fast=True).run(progress=False)
    assert run["q"][-1] == pytest.approx([0.05, 0.0, np.cos(0.5), np.sin(0.5)])
    assert run.findings == ()
