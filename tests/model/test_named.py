"""Entries of q and of delta_q by name, named configurations, and loads in world axes."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import quasistatic_ref as qr
from quasistatic_ref import ModelError
from quasistatic_ref.lab.made_steps.systems import RAIL
from quasistatic_ref.optional.doctor.did.numbers import numbers_of
from tests.closeness import assert_same, assert_within
from tests.files.urdf.urdf_texts import inertial, joint, link, robot

BLOCK = qr.Body.of_shape("block", qr.Box((0.1, 0.2, 0.3)), 2.0, xyz=(0.5, 0, 0.3))
PUCK = qr.Body.of_shape("puck", qr.Sphere(0.1), 1.0, base="planar", xyz=(0, 1, 0.1))
RIM = inertial("0.5", ("1e-3",) * 3, '<origin xyz="0.1 0 0"/>')
WHEEL = robot(link("hub"), link("rim", "", RIM), joint("axle", "hub", "rim", "continuous"))
SYSTEM = qr.System([
    BLOCK, qr.Body("rail", RAIL, actuated=["slide"]), PUCK,
    qr.Body("wheel", WHEEL, actuated="all"),
])  # fmt: skip
RPY = np.array([0.2, -0.4, 1.3])


def test_each_entry_stands_under_the_name_that_tables_give_it():
    q = np.arange(SYSTEM.n_q) * 1.0
    for each in SYSTEM.joints:
        assert_same(np.atleast_1d(SYSTEM.of(q, each.name)), q[each.q])
        for i, position in enumerate(each.positions):
            assert SYSTEM.of(q, position.name) == q[each.q][i]
    delta_q = np.arange(SYSTEM.n_v) * 1.0
    for i, coordinate in enumerate(SYSTEM.coordinates):
        assert SYSTEM.change_of(delta_q, coordinate.name) == i


def test_a_trajectory_and_targets_have_the_same_names():
    q = np.arange(4.0 * SYSTEM.n_q).reshape(4, SYSTEM.n_q)
    start = SYSTEM.joint("block/base").q.start
    assert_same(SYSTEM.of(q, "block.z"), q[:, start + 2])
    assert SYSTEM.of(q, "block").shape == (4, 7)
    assert_same(SYSTEM.of(q[:, : SYSTEM.n_q_a], "rail"), SYSTEM.of(q, "rail/slide"))
    for name in ("block", "block.x"):  # x is the first that is not actuated
        with pytest.raises(ModelError, match=f"q: cannot hold {name}: the last axis must have"):
            SYSTEM.of(q[:, : SYSTEM.n_q_a], name)
    with pytest.raises(ModelError, match="did you mean 'block"):
        SYSTEM.of(q, "blok.z")


def test_a_change_of_another_length_is_called_what_it_is():
    n_v = SYSTEM.n_v
    with pytest.raises(ModelError, match=rf"^delta_q: .*take delta_q\[..., :{n_v}\]"):
        SYSTEM.change_of(np.zeros((2, n_v + 1)), "block")  # with a rise
    with pytest.raises(ModelError, match=rf"^delta_q: .* have {n_v} entries \(got"):
        SYSTEM.change_of(np.zeros(n_v - 1), "block")


def test_named_values_are_where_kinematics_puts_the_links():
    q = SYSTEM.placed({
        "block": {"xyz": (1, 2, 3), "rpy": RPY}, "puck": (4, 5, 0.7), "wheel/axle": 2.5,
        "rail/slide": 0.25,
    })  # fmt: skip
    q = SYSTEM.placed({"puck.y": 6.0}, q)
    R, t = SYSTEM.pose(q, "block")
    assert_within(R, Rotation.from_euler("xyz", RPY).as_matrix(), 1e-15)
    assert_same(t, [1, 2, 3])
    R, t = SYSTEM.pose(q, "puck/solid")
    assert_within(R, Rotation.from_euler("z", 0.7).as_matrix(), 1e-15)
    assert_same(t, [4, 6, 0.1])  # the height of a planar base stays
    R, _ = SYSTEM.pose(q, "wheel/rim")
    assert_within(R, Rotation.from_euler("z", 2.5).as_matrix(), 1e-15)
    assert SYSTEM.of(q, "rail/slide") == 0.25
    moved = SYSTEM.placed({"block": {"xyz": (0, 0, 9)}}, q)
    assert_same(SYSTEM.of(moved, "block"), [0, 0, 9, *SYSTEM.of(q, "block")[3:]])
    assert SYSTEM.of(moved, "puck.y") == 6.0


@pytest.mark.parametrize(
    ("values", "words"),
    [
        ({"block": 1.0}, "block: must be 7 numbers"),
        ({"block": {"pos": (0, 0, 1)}}, "block.pos: is unknown; did you mean 'xyz'"),
        ({"block": {"xyz": (0, 1)}}, r"block.xyz: must have shape \(3,\)"),
        ({"rail/slide": "far"}, "rail/slide: must be numbers"),
        ({"puck.cos": 0.5}, r"its \(cos, sin\) must have length one"),
        ({"wheel/axl": 0.5}, "did you mean 'wheel/axle'"),
    ],
)
def test_a_value_of_another_kind_is_refused_by_name(values, words):
    with pytest.raises(ModelError, match=words):
        SYSTEM.placed(values)


def test_the_work_of_a_load_is_force_times_the_way_of_its_point_and_torque_times_the_turn():
    """Tau' delta_q = f' (way of the point) + m' turn, of a small step."""
    rng = np.random.default_rng(5)
    q = SYSTEM.placed({"block": {"rpy": RPY}, "wheel/axle": 0.4, "rail/slide": 0.1})
    for name in ("block", "puck", "wheel/rim", "rail/finger"):
        for own_point in (True, False):
            force, torque = rng.normal(size=(2, 3))
            R, t = SYSTEM.pose(q, name)
            local = SYSTEM.centres[SYSTEM.link(name)] if own_point else rng.normal(size=3)
            at = None if own_point else R @ local + t
            tau = SYSTEM.load(q, name, force, torque, at=at)
            delta_q = 1e-6 * rng.normal(size=SYSTEM.n_v)
            R_next, t_next = SYSTEM.pose(SYSTEM.integrate(q, delta_q), name)
            way = (R_next - R) @ local + t_next - t
            turn = Rotation.from_matrix(R_next @ R.T).as_rotvec()
            assert tau @ delta_q == pytest.approx(force @ way + torque @ turn, abs=1e-10)
    with pytest.raises(ModelError, match="name: has a fixed base, so a load has no effect"):
        SYSTEM.load(q, "rail", force=(1, 0, 0))


def arm(**angles):
    """A hub with wheels about z, all actuated, at these angles."""
    wheels = (link(name) + joint(name, "hub", name, "continuous") for name in angles)
    text = robot(link("hub"), *wheels)
    return qr.System([qr.Body("arm", text, actuated="all", positions=angles)])


def test_a_name_with_a_space_moves_its_own_joint():
    """K_q and targets by name are of the same joint, whatever another joint is called."""
    system = arm(**{"left": 0.1, "left [knee]": 0.2})
    stiffness = {"arm/left": 100.0, "arm/left [knee]": 200.0}
    simulator = qr.Simulator(system, [], h=0.01, K_q=stiffness)
    assert_same(simulator.K_q, np.diag([100.0, 200.0]))
    run = qr.rollout(simulator, system.q_start, {"arm/left": 0.5}, 3)
    assert_within([system.of(run.q[-1], f"{name}.sin") for name in stiffness], np.sin([0.5, 0.2]))
    assert [*numbers_of(run, simulator)["joints"]] == [*stiffness]


MUG = {"xyz": (0, 0, 0.3)}


@pytest.mark.parametrize("names", [("mug", "mug.x"), ("mug.x", "mug")])
def test_a_name_that_two_things_have_is_refused_when_it_is_asked_for(names):
    system = qr.System([qr.Body.of_shape(name, qr.Sphere(0.05), 0.3) for name in names])
    says = r"can mean an entry of mug/base or the body mug.x; ask .* \(got 'mug.x'\)"
    with pytest.raises(ModelError, match=says):
        system.of(system.q_start, "mug.x")
    with pytest.raises(ModelError, match=says):
        system.placed({"mug.x": MUG})
    q = system.placed({"mug.x/base": MUG})
    assert_same(system.of(q, "mug.x/base"), [0, 0, 0.3, 0, 0, 0, 1])
    assert system.of(q, "mug.z") == 0
    assert system.of(q, "mug.x.z") == 0.3
    arms = arm(**{"wheel": 0.0, "wheel.cos": 0.0})
    with pytest.raises(ModelError, match=r"an entry of arm/wheel or the joint arm/wheel.cos"):
        arms.of(arms.q_start, "arm/wheel.cos")


POSE = {"xyz": (1, 2, 3)}
OVERLAPS = {
    "a body and its joint": {"wheel": (1.0, 0.0), "wheel/axle": 0.3},
    "a joint and its body": {"wheel/axle": 0.3, "wheel": (1.0, 0.0)},
    "a body and its base": {"block": POSE, "block/base": POSE},
    "a base and an entry": {"block/base": POSE, "block.z": 0.3},
}


@pytest.mark.parametrize("name", OVERLAPS)
def test_two_names_of_one_entry_are_refused(name):
    first, second = OVERLAPS[name]
    with pytest.raises(ModelError, match=f"^{second}: names something that '{first}' names, too"):
        SYSTEM.placed(OVERLAPS[name])


@pytest.mark.parametrize("names", [("rail", "rail/slide"), ("rail/slide", "rail")])
def test_two_names_of_one_spring_are_refused(names):
    K_q = dict.fromkeys([*names, "wheel/axle"], 100.0)
    first, second = names
    refused = rf"^K_q\[{second}\]: names something that '{first}' names, too"
    with pytest.raises(qr.StepDataError, match=refused):
        qr.Simulator(SYSTEM, [], h=0.01, K_q=K_q)
