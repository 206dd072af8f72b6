"""Waypoints of joints from poses of a link: kinematics puts the link back on its line."""

import re
import shutil

import numpy as np
import pytest

import quasistatic_ref as qr
from quasistatic_ref.errors import InputError
from quasistatic_ref.formats.resources import scenario_path
from quasistatic_ref.model.rotation import rotation
from quasistatic_ref.optional.targets.joint_targets import REACHED

SCENARIO = qr.load_scenario("arm_push")
SYSTEM = SCENARIO.system
START_R, START_T = SYSTEM.pose(SYSTEM.q_start, "arm/tip")
WHEELED = """<robot name="crane"><link name="foot"/><link name="arm"/><link name="hook"/>
  <joint name="turn" type="continuous"><parent link="foot"/><child link="arm"/>
  <axis xyz="0 0 1"/></joint>
  <joint name="lift" type="prismatic"><parent link="arm"/><child link="hook"/>
  <origin xyz="0.5 0 0"/><axis xyz="0 0 1"/>
  <limit lower="-0.2" upper="0.3" effort="1" velocity="1"/></joint></robot>"""
CRANE = {
    "h": 0.01, "steps": 1,
    "bodies": {
        "crane": {"urdf": WHEELED, "actuated": "all", "K_q": {"turn": 10.0, "lift": 10.0},
                  "pose": {"xyz": [1, 2, 3], "rpy": [0.2, 0, 0.5]}},
        "ball": qr.Body.of_shape("ball", qr.Sphere(0.05), 0.3),
    },
}  # fmt: skip


BASE_R = rotation(np.array([0.2, 0, 0.5]))


def q_of_waypoint(system, body, waypoint):
    return system.placed({f"{body}/{k}": v for k, v in waypoint.items() if k != "t"})


def test_the_link_moves_straight_and_turns_evenly_between_poses():
    turn = np.array([0.0, 0.0, 0.3])
    goals = [
        {"t": 1.0, "xyz": (0.02, 0.1, 0), "relative": True},
        {"t": 3.0, "rpy": turn, "relative": True},
    ]
    waypoints = qr.joint_targets(SCENARIO, "arm/tip", goals, spacing=0.01)
    times = [waypoint["t"] for waypoint in waypoints]
    assert times[0] == 0.0
    assert np.all(np.diff(times) > 0)
    for waypoint in waypoints:
        t = waypoint["t"]
        R, p = SYSTEM.pose(q_of_waypoint(SYSTEM, "arm", waypoint), "arm/tip")
        line = START_T + min(t, 1.0) * np.array([0.02, 0.1, 0])
        np.testing.assert_allclose(p, line, atol=REACHED)
        turned = rotation(np.clip((t - 1.0) / 2.0, 0, 1) * turn) @ START_R
        np.testing.assert_allclose(R, turned, atol=REACHED)
    way = np.hypot(0.02, 0.1)
    assert times.index(1.0) == int(np.ceil(way / 0.01))


def test_angles_of_a_continuous_joint_go_on_past_half_a_turn_and_the_base_counts():
    crane = qr.load_scenario(CRANE)
    goals = []
    for k in range(1, 9):
        hook = np.array([0.5 * np.cos(0.6 * k), 0.5 * np.sin(0.6 * k), 0.1])
        goals.append({"t": float(k), "xyz": BASE_R @ hook + [1, 2, 3], "rpy": "free"})
    waypoints = qr.joint_targets(crane, "crane/hook", goals, spacing=1.0)
    at_goals = {waypoint["t"]: waypoint for waypoint in waypoints}
    for k in range(1, 9):
        assert at_goals[float(k)]["turn"] == pytest.approx(0.6 * k, abs=1e-6)
        assert at_goals[float(k)]["lift"] == pytest.approx(0.1, abs=1e-6)


@pytest.mark.parametrize(
    ("link", "pose", "words"),
    [
        ("crane/hook", {"xyz": BASE_R @ [0, 0, 0.5], "relative": True, "rpy": "free"},
         r"poses\[0\].*is missed by [\d.]+ mm.*lift is at its limit, 0.3"),
        ("crane/hook", {"xyz": (0.1, 0, 0), "relative": True}, "is missed by .* mm"),
        ("crane/foot", {"xyz": (0, 0, 0)}, "is moved by no actuated joint of crane"),
        ("ball", {"xyz": (0, 0, 0)}, "whose base is floating"),
        ("crane/hok", {"xyz": (0, 0, 0)}, "did you mean 'crane/hook'"),
        ("crane/hook", {"xyz": (0, 0)}, r"poses\[0\].xyz: must have shape \(3,\)"),
        ("crane/hook", {"pos": (0, 0, 0)}, r"poses\[0\].pos: is unknown; did you mean 'xyz'"),
    ],
)  # fmt: skip
def test_a_pose_that_is_not_reached_is_named_with_what_is_left(link, pose, words):
    with pytest.raises(InputError, match=words):
        qr.joint_targets(qr.load_scenario(CRANE), link, [{"t": 1.0, **pose}])


@pytest.mark.parametrize(
    ("joint", "moving", "words"),
    [
        (
            'type="prismatic"><mimic joint="turn"/>',
            ["turn"],
            "moved by crane/lift, which mimics crane/turn",
        ),
        ('type="ball">', ["turn", "lift"], "whose joint crane/lift is no joint of one coordinate"),
    ],
)
def test_a_chain_with_a_joint_that_is_not_sought_is_refused(joint, moving, words):
    urdf = WHEELED.replace("continuous", "revolute").replace('type="prismatic">', joint)
    limit = '<limit lower="-3" upper="3" effort="1" velocity="1"/>'
    urdf = urdf.replace('<axis xyz="0 0 1"/></joint>', f'<axis xyz="0 0 1"/>{limit}</joint>', 1)
    crane = {"urdf": urdf, "actuated": "all", "K_q": dict.fromkeys(moving, 10.0)}
    scenario = qr.load_scenario(CRANE | {"bodies": CRANE["bodies"] | {"crane": crane}})
    with pytest.raises(InputError, match=words):
        qr.joint_targets(scenario, "crane/hook", [{"t": 1.0, "xyz": (0, 0, 0)}])


def test_the_command_writes_what_the_scenario_of_the_package_holds(tmp_path, cli):
    folder = scenario_path("arm_push").parent
    shutil.copytree(folder, tmp_path / "copy")
    poses = (folder / "poses" / "line.toml").read_text()
    line = re.search(r"^# quasistatic-ref (.*)$", poses, re.M)
    copy = tmp_path / "copy"
    words = [str(copy / word) if word.endswith(".toml") else word for word in line[1].split()]
    cli(*words)
    assert (copy / "arm_push.toml").read_text() == (folder / "arm_push.toml").read_text()
    assert "[[bodies.arm.targets]]\nt = 0.0\nshoulder = -0.6\n" in cli(*words[:-2]).out
    assert (
        "must be in the scenario's folder"
        in cli(*words[:-1], tmp_path / "elsewhere.toml", status=2).err
    )


def test_the_tip_lags_behind_its_target_by_the_yielding_of_the_springs():
    """J K_q^-1 J' f, with the force f of the hand on the block, to first order in the angles."""
    run = qr.load_scenario("arm_push", fast=True, steps=100).run(progress=False)
    last = 99  # the hand has pushed since step 74, and its target still moves
    q = run.q[last + 1]
    goal = SYSTEM.with_actuated(q, run.q_bar_a[last])
    lag = SYSTEM.pose(goal, "arm/tip")[1] - SYSTEM.pose(q, "arm/tip")[1]
    J = SYSTEM.kinematics(q).J[SYSTEM.link("arm/tip")][:, : SYSTEM.n_a]
    push = -run.forces_on("arm/tip")[last]
    yielding = J @ np.linalg.solve(SCENARIO.K_q, J.T @ push)
    np.testing.assert_allclose(lag, yielding[:3], atol=0.02 * np.abs(lag).max())
    assert push[1] > 0.4 * 0.4 * 9.81 * 0.99
