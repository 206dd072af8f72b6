"""Scenario files: what each table comes to, and refusals that name file, field and value."""

import numpy as np
import pytest

from quasistatic_ref import (
    Body,
    Box,
    Capsule,
    ContactPair,
    HalfSpace,
    ScenarioError,
    System,
    load_scenario,
)
from tests.cases import cases
from tests.closeness import assert_close, assert_relative, assert_same, assert_within
from tests.files.urdf.urdf_texts import joint, link, robot, urdf_of_text
from tests.helpers import Place
from tests.scenes import PUSH

K_Q = "K_q = { slide = 500, turn = 2.5 }"


def test_the_pairs_are_those_of_the_contact_tables_in_order(load):
    floor, push = load().pairs
    assert isinstance(floor, ContactPair)
    assert (floor.name, push.name) == (
        "floor(floor, ball/ball#0)",
        "push(rail/plate#0, ball/ball#0)",
    )
    assert (floor.mu_v, floor.mu_omega, floor.rows, floor.k) == (0.5, 0.01, 6, 1)
    assert (push.mu_v, push.mu_omega, push.rows, push.k) == (0.3, 0.0, 4, 1)
    assert isinstance(floor.alpha.shape, HalfSpace)
    assert isinstance(push.alpha.shape, Box)


ALPHAS = {
    '["rail/plate", "floor"]': ["push(rail/plate#0, ball/ball#0)", "push(floor, ball/ball#0)"],
    '"rail/*"': ["push(rail/plate#0, ball/ball#0)"],  # all links with shapes
}


@pytest.mark.parametrize("alpha", ALPHAS)
def test_every_alpha_meets_every_beta(load, alpha):
    _, *pushes = load(('alpha = "rail/plate"', f"alpha = {alpha}")).pairs
    assert [pair.name for pair in pushes] == ALPHAS[alpha]


STIFFNESS = {
    "numbers": ("K_q = { slide = 500, turn = 2.5 }", [[500, 0], [0, 2.5]]),
    "matrices": ("K_q = { slide = [[500]], turn = [[2.5]] }", [[500, 0], [0, 2.5]]),
    "a number of the whole body": ("K_q = 500", [[500, 0], [0, 500]]),
    "a diagonal of the whole body": ("K_q = [500, 2.5]", [[500, 0], [0, 2.5]]),
    "a matrix of the whole body": ("K_q = [[500, 3], [3, 2.5]]", [[500, 3], [3, 2.5]]),
}


@cases("line, expected", STIFFNESS)
def test_stiffness_may_be_given_by_joint_or_by_body(load, line, expected):
    assert_same(load((K_Q, line)).K_q, expected)


def test_stiffness_is_filled_in_by_joint_in_any_order_of_bodies():
    # In pinocchio's order "b" comes first; each body's matrix belongs to its own joints.
    text = robot(link("a"), link("b"), joint("j", "a", "b"), link("c"), joint("i", "b", "c"))
    bodies = {
        name: {"urdf": text, "actuated": ["j", "i"], "K_q": [[of_j, 1], [1, of_i]]}
        for name, of_j, of_i in (("b", 10, 20), ("a", 30, 40))
    }
    scenario = load_scenario({"h": 0.01, "steps": 1, "bodies": bodies})
    stiffness = {"b/j": 10, "b/i": 20, "a/j": 30, "a/i": 40}
    names = [c.name for c in scenario.system.coordinates]
    assert sorted(names) == sorted(stiffness)
    assert_same(np.diag(scenario.K_q), [stiffness[name] for name in names])


def test_targets_are_the_waypoints(load):
    q_bar_a = load().targets(0.05)
    expected = [0.01, np.cos(3.5), np.sin(3.5)]
    assert_relative(q_bar_a, expected)


def test_a_waypoint_may_leave_joints_out(load):
    scenario = load(("t = 0.1\nslide = 0.02\nturn = 7.0", "t = 0.1\nturn = 7.0"))
    assert_same(scenario.targets(0.05)[0], 0.0)


def test_wrenches_are_linear_in_time_and_act_at_the_centre_of_mass(load):
    scenario = load()
    system = scenario.system
    q = scenario.system.q_start
    force = scenario.force(0.04, q)
    # The ball's frame is the world's and its origin the centre of mass: 0.4 of the last waypoint.
    expected = [0, 0, 0, 0.04, 0, 0, 0, 0.0004]
    assert_close(force, expected)
    assert force.shape == (system.n_v,)


def test_wrenches_of_all_bodies_place_the_links_once(monkeypatch):
    """A wrench a body: with placements for each of them, a run goes with the square of them."""
    wrench = [{"t": 0, "force": [1, 2, 3], "torque": [0.4, 0.5, 0.6]}]
    bodies = ("lower", "middle", "upper")
    scenario = load_scenario("stack", {f"bodies.{body}.wrenches": wrench for body in bodies})
    system = scenario.system
    q = system.q_start
    each = [system.load(q, name, (1, 2, 3), (0.4, 0.5, 0.6)) for name in bodies]
    placements = []
    place = System.kinematics
    monkeypatch.setattr(System, "kinematics", lambda *a: placements.append(a) or place(*a))
    assert_same(scenario.force(0.0, q), sum(each))
    assert len(placements) == 1


@pytest.mark.parametrize(("within", "reach"), [("5 mm", 0.005), ("0.5cm", 0.005), ("2e-2 m", 0.02)])
def test_k_may_be_how_near_points_are_at_the_start(within, reach):
    """Of a box on the floor its four lower corners, of a cloud all points that low."""
    k = {"within": within}
    box, _ = load_scenario("block_push", {"contacts.floor.k": k}).pairs
    assert (box.k, box.n_c) == (4, 4)
    bunny = load_scenario(
        "bunny_grasp", {"contacts.floor.k": k, "bodies.bunny.pose.rpy": [0, 0, 0]}
    )
    height = np.loadtxt(bunny.path.parent / "bunny_992.csv", delimiter=",", skiprows=1)[:, 2]
    assert bunny.pairs[0].k == np.count_nonzero(height <= height.min() + reach) > 5


def test_without_wrenches_there_is_no_force(load):
    text = PUSH[PUSH.index("[[bodies.ball.wrenches]]") : PUSH.index("[shapes.floor]")]
    assert load((text, "")).force is None


@pytest.mark.parametrize(("compensated", "expected"), [("true", 0.0), ("false", 2.0)])
def test_gravity_is_in_tau_a_only_where_it_is_not_compensated(load, compensated, expected):
    scenario = load(
        (K_Q, f"{K_Q}\ngravity_compensated = {compensated}"),
        ("gravity = [0, 0, -9.81]", "gravity = [1, 0, -9.81]"),
    )
    simulator = scenario.simulator()
    q = scenario.system.q_start
    step = simulator.step(q, scenario.targets(0.0)).step
    # The plate of 2 kg slides along x, where gravity pulls at 1 m/s^2; the wheel is off its axis
    # by 0.1 and -0.2 m, but turns about z: the torque is r x f = 0.2 * 2 * 1.
    assert_close(step.tau_a, [expected, 0.2 * expected])
    assert_close(step.tau_u, [0.3, 0, -0.3 * 9.81, 0, 0, 0])


WORLD = {
    "box": ("box = { size = [0.2, 0.4, 0.6] }", Box((0.1, 0.2, 0.3))),
    "capsule": ("capsule = { radius = 0.2, length = 0.6 }", Capsule(0.2, 0.3)),
    "halfspace": (
        "halfspace = { normal = [0, 3, 4], offset = 10 }",
        HalfSpace((0.0, 0.6, 0.8), 2.0),
    ),
}


@cases("line, expected", WORLD)
def test_shapes_of_the_world_have_the_sizes_that_are_written(load, line, expected):
    pose = "\npose = { xyz = [1, 2, 3], rpy = [0, 0, 1.5707963267948966] }"
    scenario = load(("halfspace = { normal = [0, 0, 1], offset = 0 }", line + pose))
    placed = scenario.pairs[0].alpha
    assert (placed.name, placed.link) == ("floor", 0)
    assert type(placed.shape) is type(expected)
    for key, value in vars(expected).items():
        assert_relative(getattr(placed.shape, key), value)
    assert_same(placed.t, [1, 2, 3])
    assert_within(placed.R, [[0, -1, 0], [1, 0, 0], [0, 0, 1]])


def test_every_path_is_taken_that_python_opens(tmp_path):
    urdf = urdf_of_text(tmp_path, robot(link("a")))
    scene = 'format = "quasistatic-ref/scenario"\nversion = 1\nh = 0.01\nsteps = 1\n'
    scene += '[bodies.r]\nurdf = "r.urdf"\nbase = "floating"\n'
    file = Place(urdf_of_text(tmp_path, scene, "s.toml"))
    scenario = load_scenario(file, {"bodies.r.urdf": Place(urdf)}, contacts={})
    assert scenario.bodies["r"] == Body("r", Place(urdf), "floating", package_dirs=[tmp_path])
    with pytest.raises(ScenarioError, match=r"nowhere\.toml: no such file"):
        load_scenario(Place("nowhere.toml"))
