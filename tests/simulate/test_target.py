"""Targets: linear per joint, geodesic for a base, held at both ends."""

import numpy as np
import pytest
from scipy.linalg import expm, logm
from scipy.spatial.transform import Rotation

from quasistatic_ref import InputError, ScenarioError, Targets, load_scenario
from quasistatic_ref.simulate.target import JointTrack
from quasistatic_ref.simulate.user_functions import target_function
from tests.cases import cases, refusal
from tests.closeness import assert_close, assert_same, assert_within
from tests.tolerances import DIFFERENCE

TIMES = [1.0, 2.0, 4.0]


def track(scene, joint, values, times=TIMES):
    """What a joint of the arm or the desk follows."""
    return JointTrack(scene.joint(joint), np.array(times), np.array(values))


def targets_of(scene, *tracks):
    """The targets of the scene, of which some joints follow tracks."""
    return Targets(scene.q_start[: scene.n_q_a], tracks)


def test_a_continuous_joint_may_turn_beyond_pi(scene):
    angle = np.array([0.0, 3.5, 6.3, 7.0, 7.0])
    turning = track(scene, "arm/spin", [[0.0], [7.0]], [0.0, 1.0])
    found = turning.over(np.array([0.0, 0.5, 0.9, 1.0, 2.0]))
    assert_close(found, np.column_stack([np.cos(angle), np.sin(angle)]))


def transform(value):
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = Rotation.from_quat(value[3:]).as_matrix(), value[:3]
    return T


def target_at_random(rng):
    turned = Rotation.from_rotvec(rng.normal(size=3))
    return np.concatenate([rng.normal(size=3), turned.as_quat()])


def test_a_base_follows_the_screw_between_its_waypoints(scene, rng):
    values = [target_at_random(rng) for _ in TIMES]
    moving = track(scene, "arm/base", values)
    for t, i, s in ((1.25, 0, 0.25), (1.9, 0, 0.9), (3.0, 1, 0.5)):
        start = transform(values[i])
        end = transform(values[i + 1])
        xi = np.real(logm(np.linalg.inv(start) @ end))
        expected = start @ expm(s * xi)
        assert_close(transform(moving.over(np.array([t]))[0]), expected, DIFFERENCE)


def test_waypoints_of_a_base_may_be_whole_numbers(scene):
    moving = track(scene, "arm/base", [[0, 0, 0, 0, 0, 0, 1], [1, 2, 0, 0, 0, 0, 1]], [0.0, 1.0])
    for t in (np.array([0.25]), np.linspace(0.0, 0.75, 8)):
        assert_same(moving.over(t)[:, 0], t)


def test_targets_of_many_steps_have_the_bits_of_each(scene, rng):
    """Of a base, a wheel and a slide, where each of them is between, at and beyond waypoints."""
    slides = rng.normal(size=(3, 1))
    targets = targets_of(
        scene,
        track(scene, "arm/base", [target_at_random(rng) for _ in TIMES]),
        track(scene, "arm/spin", rng.normal(size=(3, 1))),
        track(scene, "desk/slide", slides),
    )
    h = 0.02
    steps = 250
    at = target_function(scene, h, targets, steps)
    found = [at((k + 1) * h, scene.q_start, None) for k in range(steps)]
    assert not any(q_bar_a.flags.writeable for q_bar_a in found)
    for k, q_bar_a in enumerate(found):
        t = (k + 1) * h
        one = scene.checked(scene.with_actuated(scene.q_start, targets(t)))[: scene.n_q_a]
        assert q_bar_a.tobytes() == one.tobytes()
    slide = scene.joint("desk/slide").q.start
    t = h * np.arange(1, steps + 1)
    assert_within(np.array(found)[:, slide], np.interp(t, TIMES, slides[:, 0]))


@pytest.mark.parametrize("bad", [[1.0, 0, 0, 0], [0, 0, 0, 2.0], [0, 0, 0, np.nan]])
def test_a_bad_waypoint_is_refused_before_the_first_step(scene, bad):
    start = scene.q_start[scene.joint("arm/base").q]
    targets = targets_of(scene, track(scene, "arm/base", [start, start, [*start[:3], *bad]]))
    with pytest.raises(InputError):
        target_function(scene, 1.0, targets, 10)


TURNS = {
    # What is set, and the words for it where it is refused.
    "a wheel that starts at 4 rad and shall be at 0": (
        {"bodies.rail.positions": {"turn": 4.0}}, "rail.targets[0].turn: turns by -4 rad",
    ),
    "a wheel that starts at 3 rad": ({"bodies.rail.positions": {"turn": 3.0}}, "",),
    "a base by a whole turn": (
        {"bodies.ball.targets": [{"t": 0, "base": {"rpy": [0, 0, 6.283]}}]},
        "ball.targets[0].base: turns by 6.283 rad",
    ),
    "a base by a turn in quarters": (
        {"bodies.ball.targets": [
            {"t": k, "base": {"rpy": [0, 0, 1.5708 * k]}} for k in range(1, 5)
        ]}, "",
    ),
    "a base by two thirds of a turn after a third": (
        {"bodies.ball.targets": [
            {"t": 0, "base": {"rpy": [0, 0, 2.1]}}, {"t": 1, "base": {"rpy": [0, 0, 6.3]}},
        ]}, "ball.targets[1].base: turns by 4.2 rad",
    ),
    "a planar base by a whole turn": (
        {
            "bodies.ball.base": "planar",
            "bodies.ball.targets": [
                {"t": 0, "base": {"xyz": [0, 0, 0.05], "rpy": [0, 0, -6.283]}}
            ],
        }, "ball.targets[0].base: turns by -6.283 rad",
    ),
}  # fmt: skip


@cases("changes, says", TURNS)
def test_more_than_half_a_turn_at_once_is_refused(load, tmp_path, changes, says):
    load()
    path = tmp_path / "scene.toml"
    if "turn" not in str(changes):
        changes = changes | {"bodies.ball.actuated": ["base"], "bodies.ball.K_q.base": 1.0}
    if not says:
        load_scenario(path, changes)
        return
    # Where the changes write the target, the file is not to blame.
    file = f"{path}: " if says.startswith("rail") else ""
    with refusal(ScenarioError, f"{file}bodies.{says} from the pose before"):
        load_scenario(path, changes)
