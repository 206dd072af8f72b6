"""System: the paper's order, twists in the body frame, poses and Jacobians of links."""

from pathlib import Path

import numpy as np
import pytest
from scipy.linalg import expm
from scipy.spatial.transform import Rotation

from quasistatic_ref.errors import ModelError
from quasistatic_ref.model.system import Body, System
from tests.model.urdf.urdf_texts import BOX, CHAIN, inertial, joint, link, mimic, robot, written
from tests.tolerances import ROUNDING


def test_coordinates_are_actuated_first_then_in_order_of_the_bodies(scene: System) -> None:
    names = [coordinate.name for coordinate in scene.coordinates]
    twist = ("x", "y", "z", "rx", "ry", "rz")
    assert names == [
        *(f"arm/base.{axis}" for axis in twist), "arm/spin", "desk/slide",
        *(f"box/base.{axis}" for axis in twist), "arm/swing", "arm/slide", "desk/swing",
        "desk/spin",
    ]  # fmt: skip
    assert (scene.n_a, scene.n_u, scene.n_v) == (8, 10, 18)
    assert [coordinate.actuated for coordinate in scene.coordinates] == [True] * 8 + [False] * 10
    units = {coordinate.name: coordinate.unit for coordinate in scene.coordinates}
    assert units["arm/base.z"] == units["arm/slide"] == "m"
    assert units["arm/base.rx"] == units["arm/spin"] == units["arm/swing"] == "rad"


def test_a_mimic_has_no_coordinate_and_is_listed(scene: System) -> None:
    first = scene.mimics[0]
    assert (first.name, first.of) == ("arm/swing_mimic", "arm/swing")
    assert (first.multiplier, first.offset) == (-0.7, 0.2)
    assert "arm/swing_mimic" not in [joint.name for joint in scene.joints]


def test_the_start_is_as_written(scene: System) -> None:
    q = scene.q_start
    box = q[scene.joint("box/base").q]
    assert box[:3] == pytest.approx([0.5, 0.6, 0.7], abs=ROUNDING)
    turned = Rotation.from_euler("xyz", [0.1, 0.2, 0.3])  # fixed axes: Rz Ry Rx
    assert np.abs(Rotation.from_quat(box[3:]).as_matrix() - turned.as_matrix()).max() < ROUNDING
    assert q[scene.joint("arm/spin").q] == pytest.approx([np.cos(2), np.sin(2)], abs=ROUNDING)
    assert q[scene.joint("desk/slide").q] == 0.0


def test_moving_one_coordinate_moves_the_links_behind_it_and_no_other(scene: System) -> None:
    behind = {
        "desk/slide": {"desk/slider", "desk/follower", "desk/tool"},
        "box/base.x": {"box/box"},
        "arm/spin": {"arm/lower", "arm/slider", "arm/follower", "arm/tool"},
    }
    here = scene.kinematics(scene.q_start)
    for name, moved in behind.items():
        delta_q = np.array([0.1 * (c.name == name) for c in scene.coordinates])
        there = scene.kinematics(scene.integrate(scene.q_start, delta_q))
        off = np.abs(there.t - here.t).max(axis=1) + np.abs(there.R - here.R).max(axis=(1, 2))
        assert {scene.links[k] for k in np.flatnonzero(off > ROUNDING)} == moved


def test_a_fixed_base_stands_where_it_was_placed(scene: System) -> None:
    kinematics, desk = scene.kinematics(scene.q_start), scene.link("desk")
    assert scene.links[desk] == "desk/base_link"
    R = Rotation.from_euler("xyz", [0.4, -0.5, 0.6]).as_matrix()
    assert np.abs(kinematics.R[desk] - R).max() < ROUNDING
    assert kinematics.t[desk] == pytest.approx([1, 2, 3], abs=ROUNDING)
    upper = scene.link("desk/upper")
    assert kinematics.t[upper] == pytest.approx(R @ [0.1, 0.2, 0.3] + [1, 2, 3], abs=ROUNDING)


def test_a_mimic_follows_its_joint(scene: System) -> None:
    q = scene.q_start.copy()
    q[scene.joint("desk/swing").q] = 0.9
    R = scene.kinematics(q).R
    slider, follower = R[scene.link("desk/slider")], R[scene.link("desk/follower")]
    origin = Rotation.from_euler("xyz", [0, 0.4, 0])
    turned = Rotation.from_rotvec((-0.7 * 0.9 + 0.2) * np.array([0, 1, 1]) / np.sqrt(2))
    assert np.abs(slider.T @ follower - (origin * turned).as_matrix()).max() < ROUNDING


def test_a_floating_base_moves_by_the_screw_of_its_body_frame_twist(
    scene: System, q: np.ndarray, rng: np.random.Generator
) -> None:
    base = scene.joint("box/base")
    twist = rng.normal(size=6)
    delta_q = np.zeros(scene.n_v)
    delta_q[base.v] = twist
    x, y, z = twist[3:]
    xi = np.zeros((4, 4))
    xi[:3, :3] = [[0, -z, y], [z, 0, -x], [-y, x, 0]]
    xi[:3, 3] = twist[:3]

    def pose(q: np.ndarray) -> np.ndarray:
        T = np.eye(4)
        T[:3, :3], T[:3, 3] = Rotation.from_quat(q[base.q][3:]).as_matrix(), q[base.q][:3]
        return T

    q_next = scene.integrate(q, delta_q)
    assert np.abs(pose(q_next) - pose(q) @ expm(xi)).max() < ROUNDING
    others = np.delete(np.arange(scene.n_q), np.arange(scene.n_q)[base.q])
    assert np.abs(q_next - q)[others].max() < ROUNDING


def test_difference_is_the_inverse_of_integrate(
    scene: System, q: np.ndarray, rng: np.random.Generator
) -> None:
    delta_q = rng.uniform(-1, 1, size=scene.n_v)  # turns below pi
    assert np.abs(scene.difference(q, scene.integrate(q, delta_q)) - delta_q).max() < ROUNDING
    q_next = scene.integrate(scene.neutral(), rng.normal(size=scene.n_v))
    there = scene.integrate(q, scene.difference(q, q_next))
    for each in scene.joints:
        part, other = there[each.q].copy(), q_next[each.q].copy()
        if each.kind == "floating":  # x and -x are the same orientation
            part[3:] *= np.sign(part[3:] @ other[3:])
        assert np.abs(part - other).max() < ROUNDING


def test_actuated_entries_are_replaced_and_the_others_kept(scene: System, q: np.ndarray) -> None:
    q_a = scene.q_start[: scene.n_q_a]
    mixed = scene.with_actuated(q, q_a)
    assert np.array_equal(mixed[: scene.n_q_a], q_a)
    assert np.array_equal(mixed[scene.n_q_a :], q[scene.n_q_a :])
    assert not np.array_equal(mixed, q)
    with pytest.raises(ModelError, match=r"q_a: must have shape \(10,\)"):
        scene.with_actuated(q, q)


def test_masses_are_those_of_the_files(scene: System) -> None:
    assert scene.mass("box") == 1.5
    assert scene.mass("arm") == scene.mass("desk") == 10.0
    assert scene.masses[scene.link("world")] == scene.masses[scene.link("arm/tool")] == 0.0
    assert scene.masses[scene.link("arm/upper")] == 2.0


def test_everything_actuated_leaves_an_empty_block(tmp_path: Path) -> None:
    system = System([Body("c", written(tmp_path, CHAIN), "floating", "all")])
    assert (system.n_a, system.n_u) == (9, 0)
    assert system.M_u(system.q_start).shape == (0, 0)
    assert system.n_q_a == system.n_q


def test_a_world_without_joints_is_a_system(tmp_path: Path) -> None:
    system = System([Body("stone", written(tmp_path, BOX), xyz=(1, 0, 0))])
    assert (system.n_v, system.n_q, system.links) == (0, 0, ("world", "stone/box"))
    assert system.kinematics(system.q_start).t[1] == pytest.approx([1, 0, 0], abs=ROUNDING)
    assert system.gravity_force(system.q_start, [0, 0, -9.81]).shape == (0,)


def test_m_u_of_free_bodies_alone_is_one_array_without_negative_zeros(
    tmp_path: Path, scene: System, q: np.ndarray
) -> None:
    centred = robot(link("a", inertial=inertial()))  # no product of inertia, no lever
    system = System([Body("a", written(tmp_path, centred, "a.urdf"), "floating")])
    assert system.constant_mass_matrix
    M_u = system.M_u(system.q_start)
    expected = np.diag([2, 2, 2, 0.02, 0.03, 0.04])
    np.testing.assert_allclose(M_u, expected, rtol=ROUNDING, atol=ROUNDING)
    assert not np.signbit(M_u).any()
    assert system.M_u(system.integrate(system.q_start, np.ones(6))) is M_u
    assert not scene.constant_mass_matrix
    assert np.abs(scene.M_u(q) - scene.M_u(scene.q_start)).max() > 0.1


def test_many_bodies_of_one_file_do_not_meet(tmp_path: Path) -> None:
    path = written(tmp_path, robot(
        link("a"), link("b"), link("c"), joint("j", "a", "b", "prismatic", "1 0 0"),
        joint("k", "a", "c", "prismatic", "1 0 0", mimic("j", -1.0)),
    ))  # fmt: skip
    names = [f"hand{k}" for k in range(4)]
    system = System([Body(name, path, actuated=("j",)) for name in names])
    q = system.q_start.copy()
    for k, name in enumerate(names):
        q[system.joint(f"{name}/j").q] = k
    t = system.kinematics(q).t
    for k, name in enumerate(names):
        assert t[system.link(f"{name}/b")] == pytest.approx([k, 0, 0], abs=ROUNDING)
        assert t[system.link(f"{name}/c")] == pytest.approx([-k, 0, 0], abs=ROUNDING)
