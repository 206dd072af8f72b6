"""A ball joint, of a base and between links: the trial of a kind of joint that is added."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from quasistatic_ref import (
    Body,
    ModelError,
    ScenarioError,
    System,
)
from quasistatic_ref.optional.doctor.did.numbers import numbers_of
from tests.closeness import assert_within
from tests.files.urdf.urdf_texts import collision, inertial, joint, link, mimic, robot
from tests.scenes import scene
from tests.tolerances import ROUNDING

BOB = link(
    "bob",
    collision('<sphere radius="0.1"/>', '<origin xyz="0 0.05 -0.3"/>'),
    inertial("2", ("0.02", "0.03", "0.04"), '<origin xyz="0 0.05 -0.3"/>'),
)
HANGING = robot(link("hook"), BOB, joint("ball", "hook", "bob", "ball", "1 0 0"))


def leaning(base, **more):
    """The pendulum leans on the floor; actuated, it presses."""
    body = {"urdf": robot(BOB), "base": "ball"} if base else {"urdf": HANGING}
    body |= {"pose": {"xyz": [0, 0, 0.2475], "rpy": [0.9, 0, 0]}}
    touch = {"floor": ("floor", "arm/bob", 0.4, 1, 0.01)}
    return scene({"arm": body | more}, touch, 12, record="full")


@pytest.mark.parametrize("base", [True, False])
def test_runs_are_exact_and_have_the_same_bits_at_both_speeds(base):
    plain = leaning(base).run()
    fast = replace(leaning(base), fast=True)
    run = fast.run()
    assert (plain["certificate"] == "exact").all()
    assert plain["q"].tobytes() == run["q"].tobytes()
    assert np.abs(np.diff(run["q"], axis=0)).max() > 1e-4  # it moves
    assert (run.forces[:, 0, 2] > 0).all()  # the floor carries a part of the weight
    ((name, numbers),) = numbers_of(run, fast.simulator())["bodies"].items()
    assert name == ("arm" if base else "arm/ball")
    ends = Rotation.from_quat(run["q"][[0, -1]])
    turned = (ends[0].inv() * ends[1]).magnitude()
    assert_within(np.radians(numbers["largest_rotation_deg"]), turned, 16 * ROUNDING)


@pytest.mark.parametrize(("base", "name"), [(True, "base"), (False, "ball")])
def test_a_target_turns_a_ball_the_shorter_way(base, name):
    roll = 0.9 if base else 0.0
    goal = [roll, 0.3, 0.1]
    targets = [{"t": 0.0, name: {"rpy": [roll, 0, 0]}}, {"t": 0.1, name: {"rpy": goal}}]
    held = leaning(base, actuated=[name], K_q={name: [40, 50, 60]}, targets=targets)
    q_bar = held.targets(1.0)
    expected = Rotation.from_euler("xyz", goal).as_quat()
    assert_within(q_bar, expected, 4 * ROUNDING)
    start = Rotation.from_quat(held.targets(0.0))
    half = start * Rotation.from_rotvec((start.inv() * Rotation.from_quat(q_bar)).as_rotvec() / 2)
    assert_within(held.targets(0.05), half.as_quat(), 8 * ROUNDING)


def test_coordinates_of_a_ball_are_turns_and_its_entries_a_quaternion():
    system = leaning(True).system
    assert [c.name for c in system.coordinates] == ["arm/base.rx", "arm/base.ry", "arm/base.rz"]
    headings = [p.heading for p in system.joints[0].positions]
    assert headings == ["arm.qx [-]", "arm.qy [-]", "arm.qz [-]", "arm.qw [-]"]


def test_positions_and_targets_that_a_ball_lacks_are_refused():
    with pytest.raises(ModelError, match=r"arm\.positions: has no position that is one number"):
        System([Body("arm", HANGING, positions={"ball": 0.1})])
    away = [{"t": 0.0, "base": {"xyz": [0, 0, 1], "rpy": [0, 0, 0]}}]
    with pytest.raises(ScenarioError, match="moves or turns by x, y, z"):
        leaning(True, actuated=["base"], K_q={"base": 40}, targets=away)
    with pytest.raises(ModelError, match=r"arm\.xyz: is unknown"):
        leaning(True).system.placed({"arm": {"xyz": [0, 0, 1]}})


def test_a_file_may_have_balls_and_mimics():
    """The follower is where its leader is, 0.3 about z, and the ball's link where it was."""
    both = robot(
        link("hook"), BOB, link("a"), link("b"), joint("ball", "hook", "bob", "ball", "1 0 0"),
        joint("swing", "hook", "a"), joint("follow", "hook", "b", more=mimic("swing")),
    )  # fmt: skip
    system = System([Body("arm", both, positions={"swing": 0.3})])
    R = dict(zip(system.links, system.kinematics(system.q_start).R, strict=True))
    assert_within(R["arm/b"], R["arm/a"])
    assert_within(R["arm/b"][0, 0], np.cos(0.3))
    assert_within(R["arm/bob"], np.eye(3))
