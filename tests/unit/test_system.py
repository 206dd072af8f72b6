"""System: the paper's order, twists in the body frame, Jacobians, inertia and gravity."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.linalg import expm
from scipy.spatial.transform import Rotation

from quasistatic_ref.errors import ModelError
from quasistatic_ref.model.system import Body, System
from quasistatic_ref.model.urdf_file import urdf_file
from quasistatic_ref.tolerances import UNIT_QUATERNION
from tests.tolerances import DIFFERENCE, DIFFERENCE_STEP, ROUNDING
from tests.unit.urdf_texts import BOX, CHAIN, inertial, joint, link, mimic, robot, written

GRAVITY = np.array([1.0, -2.0, -9.81])
PENDULUM = robot(
    link("pivot", inertial=""),
    '<link name="bob"><inertial><origin xyz="0 0 -0.7"/><mass value="3"/>'
    '<inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial></link>',
    joint("swing", "pivot", "bob", "continuous", "0 1 0"),
)


@pytest.fixture
def scene(tmp_path: Path) -> System:
    """A floating arm, actuated in part; a fixed one on a tilted desk; a free box."""
    chain, box = written(tmp_path, CHAIN, "chain.urdf"), written(tmp_path, BOX, "box.urdf")
    return System(
        [
            Body("box", box, "floating", xyz=(0.5, 0.6, 0.7), rpy=(0.1, 0.2, 0.3)),
            Body("arm", chain, "floating", ("spin", "base"), positions={"spin": 2.0}),
            Body("desk", chain, "fixed", ("slide",), xyz=(1, 2, 3), rpy=(0.4, -0.5, 0.6)),
        ]
    )


@pytest.fixture
def q(scene: System, rng: np.random.Generator) -> np.ndarray:
    """A configuration without symmetries."""
    return scene.integrate(scene.neutral(), rng.normal(size=scene.n_v))


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


def test_slices_of_joints_tile_q_and_delta_q(scene: System) -> None:
    kinds = {joint.name: joint.kind for joint in scene.joints}
    assert kinds["arm/base"] == "floating"
    assert kinds["arm/spin"] == "continuous"
    assert kinds["arm/swing"] == "revolute"
    assert kinds["desk/slide"] == "prismatic"
    widths = {"floating": (7, 6), "continuous": (2, 1), "revolute": (1, 1), "prismatic": (1, 1)}
    at_q = at_v = 0
    for each in scene.joints:
        n_q, n_v = widths[each.kind]
        assert (each.q, each.v) == (slice(at_q, at_q + n_q), slice(at_v, at_v + n_v))
        at_q, at_v = at_q + n_q, at_v + n_v
    assert (at_q, at_v) == (scene.n_q, scene.n_v)
    assert scene.n_q_a == 7 + 2 + 1


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


def test_jacobians_of_all_links_are_those_of_central_differences(
    scene: System, q: np.ndarray
) -> None:
    J = scene.kinematics(q).J
    assert J.shape == (len(scene.links), 6, scene.n_v)
    assert np.array_equal(scene.body_jacobians(q), J)
    for k, direction in enumerate(DIFFERENCE_STEP * np.eye(scene.n_v)):
        one, two = (scene.kinematics(scene.integrate(q, s * direction)) for s in (1, -1))
        linear = (one.t - two.t) / (2 * DIFFERENCE_STEP)
        turns = Rotation.from_matrix(one.R @ np.swapaxes(two.R, 1, 2)).as_rotvec()
        difference = np.hstack([linear, turns / (2 * DIFFERENCE_STEP)])
        assert np.abs(J[:, :, k] - difference).max() < DIFFERENCE, scene.coordinates[k]
    # Every kind of joint must have been seen to move something.
    assert (np.abs(J).max(axis=(0, 1)) > 0.1).all()


def test_the_world_is_link_zero_and_stands_still(scene: System, q: np.ndarray) -> None:
    kinematics = scene.kinematics(q)
    assert scene.link("world") == 0
    assert np.array_equal(kinematics.R[0], np.eye(3))
    assert not kinematics.t[0].any()
    assert not kinematics.J[0].any()


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


def test_a_continuous_joint_turns_past_pi(scene: System) -> None:
    spin, q = scene.joint("arm/spin"), scene.q_start  # at 2 rad
    delta_q = np.zeros(scene.n_v)
    delta_q[spin.v] = 2.5
    q_next = scene.integrate(q, delta_q)
    assert q_next[spin.q] == pytest.approx([np.cos(4.5), np.sin(4.5)], abs=ROUNDING)
    assert scene.difference(q, q_next)[spin.v] == pytest.approx(2.5, abs=ROUNDING)


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


def cross_matrix(c: np.ndarray) -> np.ndarray:
    return np.cross(c, np.eye(3)).T


def test_the_mass_matrix_of_a_free_box_is_the_formula(tmp_path: Path) -> None:
    system = System([Body("box", written(tmp_path, BOX), "floating")])
    m, C = 1.5, cross_matrix(np.array([0.01, -0.02, 0.03]))
    I_c = np.array([[0.02, 0.001, 0], [0.001, 0.03, 0], [0, 0, 0.04]])
    expected = np.block([[m * np.eye(3), -m * C], [m * C, I_c - m * C @ C]])
    assert np.abs(system.M_u(system.q_start) - expected).max() < ROUNDING


def mass_matrix(scene: System, q: np.ndarray) -> np.ndarray:
    """Sum over links of m J_c' J_c + J_w' I J_w, by the numbers in the files."""
    k, M = scene.kinematics(q), np.zeros((scene.n_v, scene.n_v))
    for body in scene.bodies:
        for name, said in urdf_file(body.urdf).links.items():
            at = scene.link(f"{body.name}/{name}")
            J_w = k.J[at, 3:]
            J_c = k.J[at, :3] - cross_matrix(k.R[at] @ said.com) @ J_w
            M += said.mass * J_c.T @ J_c + J_w.T @ k.R[at] @ said.inertia @ k.R[at].T @ J_w
    return M


def test_M_u_is_the_unactuated_block_of_the_sum_over_links(scene: System, q: np.ndarray) -> None:
    M_u = scene.M_u(q)
    expected = mass_matrix(scene, q)[scene.n_a :, scene.n_a :]
    assert np.abs(M_u - expected).max() < ROUNDING * np.abs(expected).max()
    assert np.array_equal(M_u, M_u.T)
    # Off-diagonal entries between the arm's joints: the symmetry is not one of zeros.
    arm = [k for k, c in enumerate(scene.coordinates[scene.n_a :]) if c.name.startswith("arm/")]
    assert np.abs(M_u[arm[0], arm[1]]) > 0.01


@pytest.mark.parametrize("angle", [0.0, 0.3, np.pi / 2, -2.5])
def test_gravity_turns_a_pendulum_by_m_g_l_sin(tmp_path: Path, angle: float) -> None:
    body = Body("p", written(tmp_path, PENDULUM), actuated="all", positions={"swing": angle})
    system = System([body])
    force = system.gravity_force(system.q_start, [0, 0, -9.81])
    assert force == pytest.approx([-3 * 9.81 * 0.7 * np.sin(angle)], abs=20 * ROUNDING)


def test_gravity_on_a_free_box_is_its_weight_in_the_body_frame(tmp_path: Path) -> None:
    system = System([Body("box", written(tmp_path, BOX), "floating", rpy=(0.3, 0.4, 0.5))])
    weight = 1.5 * Rotation.from_euler("xyz", [0.3, 0.4, 0.5]).inv().apply(GRAVITY)
    moment = np.cross([0.01, -0.02, 0.03], weight)
    force = system.gravity_force(system.q_start, GRAVITY)
    assert force == pytest.approx(np.r_[weight, moment], abs=20 * ROUNDING)


def test_gravity_is_the_slope_of_the_potential(scene: System, q: np.ndarray) -> None:
    def work(q: np.ndarray) -> float:
        k, total = scene.kinematics(q), 0.0
        for body in scene.bodies:
            for name, said in urdf_file(body.urdf).links.items():
                at = scene.link(f"{body.name}/{name}")
                total += said.mass * GRAVITY @ (k.t[at] + k.R[at] @ said.com)
        return total

    force = scene.gravity_force(q, GRAVITY)
    for k, direction in enumerate(DIFFERENCE_STEP * np.eye(scene.n_v)):
        rise = work(scene.integrate(q, direction)) - work(scene.integrate(q, -direction))
        # The potential is of size 100: weights of 100 N at a metre.
        assert abs(force[k] - rise / (2 * DIFFERENCE_STEP)) < 100 * DIFFERENCE


def test_gravity_of_another_call_leaves_no_trace(scene: System, q: np.ndarray) -> None:
    one, kinematics = scene.gravity_force(q, GRAVITY), scene.kinematics(q)
    scene.gravity_force(scene.q_start, [3, 2, 1])
    scene.M_u(scene.q_start)
    assert np.array_equal(scene.gravity_force(q, GRAVITY), one)
    assert np.array_equal(scene.kinematics(q).J, kinematics.J)
    assert not scene.gravity_force(q, np.zeros(3)).any()


def test_a_force_at_the_centre_of_mass_does_the_work_of_its_point(
    scene: System, q: np.ndarray, rng: np.random.Generator
) -> None:
    force, torque, box = rng.normal(size=3), rng.normal(size=3), scene.link("box")

    def centre(q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        k = scene.kinematics(q)
        return k.t[box] + k.R[box] @ [0.01, -0.02, 0.03], k.R[box]

    generalised = scene.centre_of_mass_force(q, "box", force, torque)
    for k, direction in enumerate(DIFFERENCE_STEP * np.eye(scene.n_v)):
        (c1, R1), (c2, R2) = (centre(scene.integrate(q, s * direction)) for s in (1, -1))
        work = force @ (c1 - c2) + torque @ Rotation.from_matrix(R1 @ R2.T).as_rotvec()
        assert abs(generalised[k] - work / (2 * DIFFERENCE_STEP)) < DIFFERENCE


def test_weight_at_the_centre_of_mass_is_gravity(tmp_path: Path) -> None:
    welded = robot(
        link("a"), link("b"), joint("w", "a", "b", "fixed", more='<origin xyz="1 2 3"/>')
    )
    system = System([Body("a", written(tmp_path, welded), "floating", rpy=(1, 2, 3))])
    q, weight = system.q_start, system.mass("a") * GRAVITY
    force = system.centre_of_mass_force(q, "a", weight, np.zeros(3))
    assert force == pytest.approx(system.gravity_force(q, GRAVITY), abs=100 * ROUNDING)


def test_masses_are_those_of_the_files(scene: System) -> None:
    assert scene.mass("box") == 1.5
    assert scene.mass("arm") == scene.mass("desk") == 10.0
    assert scene.masses[scene.link("world")] == scene.masses[scene.link("arm/tool")] == 0.0
    assert scene.masses[scene.link("arm/upper")] == 2.0


def test_shapes_sit_on_the_links_that_they_are_named_after(scene: System) -> None:
    names = {shape.name: scene.links[shape.link] for shape in scene.shapes}
    assert names == {
        f"{body}/{at}#0": f"{body}/{at}"
        for body, links in (("box", ["box"]), ("arm", ["base_link", "upper", "tool"]))
        for at in links
    } | {f"desk/{at}#0": f"desk/{at}" for at in ["base_link", "upper", "tool"]}
    upper = next(shape for shape in scene.shapes if shape.name == "desk/upper#0")
    assert upper.t == pytest.approx([0, 0.1, 0.2], abs=ROUNDING)


def test_what_is_ignored_says_whose_it_is(scene: System) -> None:
    assert "arm: joint[swing].limit" in scene.ignored


def test_a_configuration_keeps_its_bits_when_checked(
    scene: System, q: np.ndarray, rng: np.random.Generator
) -> None:
    for _ in range(100):
        q = scene.integrate(q, rng.normal(size=scene.n_v))
        assert np.array_equal(scene.checked(q), q)


def test_a_quaternion_off_by_the_rounding_of_a_file_is_normalised(
    scene: System, q: np.ndarray
) -> None:
    off = q.copy()
    off[scene.joint("box/base").q.start + 3 :][:4] *= 1 + UNIT_QUATERNION / 2
    off[scene.joint("arm/spin").q] *= 1 - UNIT_QUATERNION / 2
    assert not np.array_equal(off, q)
    assert np.abs(scene.checked(off) - q).max() < ROUNDING
    assert np.array_equal(scene.checked(scene.checked(off)), scene.checked(off))


BAD_Q: dict[str, tuple[str, int, float, str]] = {
    "nan": ("arm/swing", 0, np.nan, r"q\[arm/swing\]: must be finite"),
    "inf": ("box/base", 1, np.inf, r"q\[box/base\]: must be finite"),
    "zero quaternion": ("box/base", -1, 0.0, r"q\[box/base\]: its quaternion must have length"),
    "zero turn": ("arm/spin", -1, 0.0, r"q\[arm/spin\]: its \(cos, sin\) must have length one"),
}


@pytest.mark.parametrize(("name", "entry", "value", "words"), BAD_Q.values(), ids=BAD_Q)
def test_a_configuration_that_is_none_is_refused(
    scene: System, name: str, entry: int, value: float, words: str
) -> None:
    q, at = scene.q_start.copy(), scene.joint(name).q
    if entry < 0:
        start = at.start + 3 if scene.joint(name).kind == "floating" else at.start
        q[start : at.stop] = value
    else:
        q[at.start + entry] = value
    with pytest.raises(ModelError, match=words):
        scene.checked(q)


def test_a_configuration_of_another_length_is_refused(scene: System) -> None:
    with pytest.raises(ModelError, match=rf"q: must have shape \({scene.n_q},\)"):
        scene.checked(scene.q_start[:-1])
    with pytest.raises(ModelError, match="q: must be numbers"):
        scene.checked(["zero"] * scene.n_q)
    with pytest.raises(ValueError, match="expected shape"):
        scene.integrate(scene.q_start[:1], np.zeros(scene.n_v))


def test_unknown_names_are_answered_with_the_nearest(scene: System) -> None:
    with pytest.raises(ModelError, match="joint: is no joint; did you mean 'arm/slide'"):
        scene.joint("arm/slid")
    with pytest.raises(ModelError, match="link: is no link; did you mean 'desk/upper'"):
        scene.link("desk/uper")
    with pytest.raises(ModelError, match="body: is no body; did you mean 'desk'"):
        scene.mass("dessk")
    with pytest.raises(ModelError, match="body: has a fixed base, on which a wrench does nothing"):
        scene.centre_of_mass_force(scene.q_start, "desk", np.ones(3), np.ones(3))


BAD_BODY: dict[str, tuple[dict[str, Any], str]] = {
    "no name": ({"name": ""}, "body.name: must be a name"),
    "world": ({"name": "world"}, "body.name: must be a name other than 'world'"),
    "slash": ({"name": "a/b"}, "body.name: must not contain"),
    "hash": ({"name": "a#0"}, "body.name: must not contain"),
    "star": ({"name": "a*"}, "body.name: must not contain"),
    "space": ({"name": "a b"}, "body.name: must not contain"),
    "planar": ({"base": "planar"}, r"c.base: is not a base; known: fixed, floating \(got 'planar"),
    "bare string": ({"actuated": "swing"}, 'c.actuated: must be "all" or a sequence'),
    "unknown joint": ({"actuated": ("swong",)}, "c.actuated: has no such joint; did you mean 'swi"),
    "link as a joint": ({"actuated": ("tool",)}, "c.actuated: has no such joint"),
    "mimic joint": ({"actuated": ("swing_mimic",)}, "c.actuated: mimics 'swing' and has no coord"),
    "welded joint": ({"actuated": ("weld",)}, "c.actuated: has no such joint"),
    "fixed base": ({"actuated": ("base",)}, 'c.actuated: is fixed; say base = "floating"'),
    "twice": ({"actuated": ("swing", "swing")}, "c.actuated: names a joint twice"),
    "xyz": ({"xyz": (1, 2)}, "c.xyz: must be three finite numbers"),
    "rpy": ({"rpy": (0, np.nan, 0)}, "c.rpy: must be three finite numbers"),
    "unknown position": ({"positions": {"swin": 1}}, "c.positions: has no such joint; did you"),
    "nan position": ({"positions": {"swing": np.nan}}, "c.positions.swing: must be a finite"),
    "mimic position": ({"positions": {"swing_mimic": 1}}, "c.positions: mimics 'swing' and has no"),
    "base position": (
        {"base": "floating", "positions": {"base": 1}},
        "c.positions: is placed by xyz and rpy",
    ),
    "no file": ({"urdf": "nowhere.urdf"}, "nowhere.urdf: no such file"),
}  # fmt: skip


@pytest.mark.parametrize(("changes", "words"), BAD_BODY.values(), ids=BAD_BODY)
def test_a_body_that_cannot_be_is_refused(
    tmp_path: Path, changes: dict[str, Any], words: str
) -> None:
    good = {"name": "c", "urdf": written(tmp_path, CHAIN)}
    System([Body(**good)])
    with pytest.raises(ModelError, match=words):
        System([Body(**(good | changes))])


def test_two_bodies_of_one_name_are_refused(tmp_path: Path) -> None:
    body = Body("box", written(tmp_path, BOX))
    with pytest.raises(ModelError, match=r"body.name: is the name of two bodies \(got 'box'\)"):
        System([body, body])


def test_a_singular_mass_matrix_is_refused_where_it_is_unactuated(tmp_path: Path) -> None:
    mote = inertial("1", ("1", "1", "1")).replace(
        "<inertial>", '<inertial><origin xyz="1e9 0 0"/>'
    )  # its moment about the base, 1e18 + 1, has no room for the 1
    path = written(tmp_path, robot(link("a", inertial=mote)))
    with pytest.raises(ModelError, match="mote: its mass matrix M_u is singular in float64"):
        System([Body("mote", path, "floating")])
    assert System([Body("mote", path, "floating", "all")]).n_u == 0


def test_everything_actuated_leaves_an_empty_block(tmp_path: Path) -> None:
    system = System([Body("c", written(tmp_path, CHAIN), "floating", "all")])
    assert (system.n_a, system.n_u) == (9, 0)
    assert system.M_u(system.q_start).shape == (0, 0)
    assert system.n_q_a == system.n_q


def test_a_world_without_joints_is_a_system(tmp_path: Path) -> None:
    system = System([Body("stone", written(tmp_path, BOX), xyz=(1, 0, 0))])
    assert (system.n_v, system.n_q, system.links) == (0, 0, ("world", "stone/box"))
    assert system.kinematics(system.q_start).t[1] == pytest.approx([1, 0, 0], abs=ROUNDING)
    assert system.gravity_force(system.q_start, GRAVITY).shape == (0,)


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
