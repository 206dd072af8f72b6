"""What stands and what is missing, by hand: just inside of a threshold and just outside of it."""

import math
import re

import numpy as np
import pytest

from quasistatic_ref import (
    Body,
    Box,
    Extension,
    InputError,
    RunFailed,
    Sphere,
    load_scenario,
    rollout,
)
from quasistatic_ref.lab.commands.stands import asked_steps, over_steps
from tests.closeness import assert_relative
from tests.files.urdf.urdf_texts import collision, inertial, joint, link, robot
from tests.optional.rows import CASES, made, params, rows_of

G = 9.81
ROWS = rows_of("stands/scenes.toml")


def row_of(what):
    """The row whose name begins so."""
    (row,) = (row for row in ROWS if row["what"].startswith(what))
    return row


FALLS = {"free-fall", "lost-grip", "unsupported-body", "locked-guide"}
"""Findings on what does not stand, or may fall by one of several solutions of Coulomb's law."""


def run_of(scenario):
    """A run, though it may end early."""
    try:
        return scenario.run(progress=False, findings=False)
    except RunFailed as failure:
        return failure.trajectory


def standings(scenario, run, step=None, certify="off"):
    """What stands after a step of a run, or where it starts."""
    if step is not None:
        return run.stands(step, scenario, certify=certify)
    q = scenario.system.q_start
    force = None if scenario.force is None else scenario.force(0.0, q)
    return scenario.simulator().stands(q, scenario.targets(0.0), force, certify=certify)


def assert_by_hand(scenario, run, stands):
    """Of each body whether it stands, the reason why that is not known, or what it lacks."""
    for body, hand in stands.items():
        lacks = hand if isinstance(hand, dict) else {}
        row = standings(scenario, run, lacks.get("step"))[body]
        if isinstance(hand, str):
            assert row.stands is None
            assert re.fullmatch(hand, row.reason)
            continue
        assert row.stands is (hand is True)
        if row.stands:
            assert row.held_with == ()
        if "missing_N" in lacks or "missing_Nm" in lacks:
            for key in ("missing_N", "missing_Nm"):
                value, off = lacks.get(key, (0.0, 0.0))
                assert getattr(row, key) == pytest.approx(value, rel=off, abs=1e-9)
        if "held_with" in lacks:
            assert sorted(row.held_with) == lacks["held_with"]
        if "direction" in lacks:
            assert row.direction == pytest.approx(lacks["direction"], abs=1e-3)
        if "still" in lacks:
            assert standings(scenario, run, lacks["still"])[body].stands is True


def backwards(scene):
    """The same scene with all of it in another order."""
    contacts = {
        name: table | {"alpha": table["beta"], "beta": table["alpha"]}
        for name, table in reversed(scene["contacts"].items())
    }
    return scene | {"bodies": dict(reversed(scene["bodies"].items())), "contacts": contacts}


ASKED = [
    pytest.param(row, ask, id=f"{row['what']}: {number}")
    for row in ROWS
    for number, ask in enumerate(row["ask"])
]


@pytest.mark.parametrize("also", [dict, backwards], ids=["in order", "backwards"])
@pytest.mark.parametrize(("row", "ask"), ASKED)
def test_a_body_lacks_what_a_clamp_on_it_would_bear_whatever_the_order(row, ask, also):
    scenario = made(row, ask.get("set", {}), also)
    assert_by_hand(scenario, run_of(scenario), ask["stands"])


@pytest.mark.shared
@pytest.mark.parametrize("case", params(one for one in CASES if not {"before", "mjcf"} & {*one}))
def test_a_body_of_the_doctors_cases_lacks_what_a_clamp_on_it_would_bear(case):
    """`why` derives numbers that a row's name does not say. Others stand in the end, or fall."""
    scenario = made(case)
    run = run_of(scenario)
    if "stands" not in case and run.steps and FALLS.isdisjoint(case["hand"]):
        assert False not in {row.stands for row in run.stands(run.steps - 1, scenario)}
    assert_by_hand(scenario, run, case.get("stands", {}))


def box(m, *size):
    return f"box {' '.join(map(str, size))} {m}"


def drawn_slope(draw):
    """Gravity is turned, and not the floor."""
    a, mu, m = draw(0.1, 0.6), draw(0.1, 0.8), draw(0.1, 5.0)
    down = [G * math.sin(a), 0, -G * math.cos(a)]
    changes = {"bodies.b.urdf": box(m, 0.1, 0.1, 0.1), "bodies.b.wrenches": [], "gravity": down}
    lacks = m * G * (math.sin(a) - mu * math.cos(a))
    return "6 N", changes | {"contacts.f.mu_v": mu}, {"b": (lacks, "N")}


def drawn_fall(draw):
    m = draw(0.01, 10.0)
    changes = {"bodies.b.urdf": box(m, 0.1, 0.1, 0.1), "bodies.b.wrenches": []}
    return "6 N", changes | {"bodies.b.pose.xyz": [0, 0, 1]}, {"b": (m * G, "N")}


def drawn_rider(draw):
    mu, m_1, m_2, F = draw(0.1, 0.4), draw(0.5, 3.0), draw(0.5, 3.0), draw(2.0, 20.0)
    mu_2 = draw(0.02, 0.5)
    changes = {"bodies.low.urdf": box(m_1, 0.2, 0.2, 0.05), "contacts.c.mu_v": mu}
    changes |= {"bodies.up.urdf": box(m_2, 0.1, 0.1, 0.02), "contacts.on.mu_v": mu_2}
    changes["bodies.low.wrenches"] = [{"t": 0, "force": [F, 0, 0]}]
    lacks = F - mu * (m_1 + m_2) * G
    return "a sled", changes, {"low": (lacks, "N"), "up": (min(lacks, mu_2 * m_2 * G), "N")}


def drawn_seesaw(draw):
    at, m, friction = draw(0.03, 0.15), draw(0.2, 3.0), draw(0.05, 2.0)
    changes = {"bodies.b.urdf": box(m, 0.04, 0.04, 0.04), "bodies.b.pose.xyz": [at, 0, 0.03]}
    changes["bodies.s.joint_friction.j"] = friction
    return "a seesaw", changes, {"s/j": (m * G * at - friction, "Nm")}


def drawn_grip(draw):
    a, b, force = draw(0.1, 1.0), draw(0.1, 1.0), draw(3.0, 15.0)
    changes = {f"bodies.{name}.urdf": box(m, 0.04, 0.04, 0.04) for name, m in (("A", a), ("B", b))}
    for name, side in (("l", -1), ("r", 1)):
        target = {"t": 0, "base": {"xyz": [side * (0.03 - force / 1e4), 0, 0]}}
        changes[f"bodies.{name}.targets"] = [target]
    lacks = (a + b) * G - force
    return "fingers that bear", changes, {"A": (lacks, "N"), "B": (min(lacks, b * G), "N")}


DRAWN = (drawn_slope, drawn_rider, drawn_seesaw, drawn_grip, drawn_fall)


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("drawn", DRAWN)
def test_r49_what_is_missing_of_drawn_scenes(drawn, seed):
    rng = np.random.default_rng(seed)
    what, changes, lacks = drawn(lambda *ends: float(rng.uniform(*ends)))
    scenario = made(row_of(what), changes)
    hand = {b: x <= 0 or {f"missing_{unit}": (x, 0.01)} for b, (x, unit) in lacks.items()}
    assert_by_hand(scenario, None, hand)


def test_every_step_is_asked_however_many_bodies_lack_something_at_times_of_their_own():
    """Each of 14 boxes is pushed for two steps: it lacks F - mu m g, 2.55 to 5.15 N."""
    one = row_of("6 N")
    bodies, contacts = {}, {}
    for i in range(14):
        at, F = 0.01 * (1 + i), 5 + 0.2 * i
        loads = ((0.0, 0.0), (at, 0.0), (at + 0.001, F), (at + 0.019, F), (at + 0.02, 0.0))
        bodies[f"b{i}"] = {
            "urdf": box(0.5, 0.06, 0.06, 0.04),
            "base": "floating",
            "pose": {"xyz": [i % 5 * 0.2, i // 5 * 0.2, 0.02]},
            "wrenches": [{"t": t, "force": [x, 0, 0]} for t, x in loads],
        }
        contacts[f"c{i}"] = one["scene"]["contacts"]["f"] | {"beta": f"b{i}"}
    scenario = made(one, {"bodies": bodies, "contacts": contacts, "steps": 16})
    run = scenario.run(progress=False, findings=False)
    steps = asked_steps(run.steps, run.header.h, None)
    asked = [run.stands(k, scenario) for k in steps]
    for i in range(14):
        row = over_steps([(k, rows[f"b{i}"]) for k, rows in zip(steps, asked, strict=True)])
        assert row["missing_N"] == pytest.approx(5 + 0.2 * i - 0.25 * G, rel=1e-3)
        assert row["lacks"] in (1, 2)


def test_proved_ends_say_the_same_and_bad_words_are_refused():
    incline = load_scenario("block_incline", steps=2, backend="daqp")
    run = incline.run(progress=False, findings=False)
    asked = [(incline, run, 1)]
    pile = row_of("a ball presses")
    asked += [(made(pile, ask.get("set", {})), None) for ask in pile["ask"]]
    for of in asked:
        off, full = (standings(*of, certify=word) for word in ("off", "full"))
        for row in off:
            same = full[row.body]
            assert (same.stands, same.held_with) == (row.stands, row.held_with)
            assert same.missing_N == pytest.approx(row.missing_N, rel=1e-6)
    with pytest.raises(InputError, match="certify: must be full or off"):
        run.stands(1, certify="residual")
    with pytest.raises(InputError, match="step: must be 0 to 1"):
        run.stands(2)
    with pytest.raises(InputError, match="is no body"):
        off["blok"]


def test_a_light_record_needs_the_scenario_and_a_scene_of_no_free_body_says_so():
    scenario = load_scenario("sphere_spin", {"record": "light"}, steps=60, backend="daqp")
    run = scenario.run(progress=False, findings=False)
    with pytest.raises(InputError, match="holds no loads; give its scenario"):
        run.stands(59)
    assert run.stands(59, scenario)["sphere"].missing_Nm > 0
    actuated = load_scenario("peg_in_hole", steps=1, backend="daqp")
    assert "nothing in this scene is free" in str(actuated.run(progress=False).stands(0))


@pytest.mark.parametrize("off", [0.0, 0.3, -0.2])
def test_a_plank_over_an_edge_lacks_the_same_wherever_its_origin_is(off):
    """About the edge, d before the centre and h below it, a = g d / (k^2 + d^2 + h^2).

    A clamp on it bears m a r and I a; the plank of 1 kg is 0.6 m by 0.02 m.
    """
    k2, d, h = (0.6**2 + 0.02**2) / 12, 0.1, 0.01
    moments = tuple(str(k2) for _ in range(3))
    origin = f'<origin xyz="{off} 0 0"/>'
    size = collision('<box size="0.6 0.1 0.02"/>', origin)
    plank = robot(link("b", size, inertial("1", moments, origin)))
    floor = row_of("a board of 0.4 m")
    changes = {"bodies.b.urdf": plank, "bodies.b.pose.xyz": [d - off, 0, h]}
    row = standings(made(floor, changes), None)["b"]
    a = G * d / (k2 + d**2 + h**2)
    assert_relative([row.missing_N, row.missing_Nm], [a * np.hypot(d, h), k2 * a], 1e-3)


def double_pendulum(moment, **tables):
    """Horizontal links of 1 kg and 1 m, centred, on hinges without friction."""
    first = inertial("1", (str(moment),) * 3, '<origin xyz="0.5 0 0"/>')
    second = inertial("1", ("0.001",) * 3, '<origin xyz="0.5 0 0"/>')
    arm = robot(
        link("w", inertial=""), link("a", inertial=first), link("b", inertial=second),
        joint("j", "w", "a", axis="0 1 0"),
        joint("k", "a", "b", axis="0 1 0", more='<origin xyz="1 0 0"/>'),
    )  # fmt: skip
    return load_scenario({"h": 0.02, "steps": 3, "bodies": {"arm": {"urdf": arm}}} | tables)


@pytest.mark.parametrize("moment", [0.42, 0.46])
def test_a_joint_with_a_small_share_of_the_power_counts(moment):
    """What hinges lack is (m c + m (l + c), m c) g = (2, 0.5) g, also where k has 4 % of r a."""
    row = standings(double_pendulum(moment), None)["arm/j"]
    assert_relative(row.missing_Nm, G * np.hypot(2.0, 0.5))
    assert_relative(np.abs(row.direction) * row.missing_Nm, [2 * G, G / 2])


def test_a_full_record_is_asked_by_its_simulator_where_the_arm_is():
    scenario = double_pendulum(0.42, record="full")
    simulator = scenario.simulator()
    run = scenario.run(progress=False, findings=False)
    there = simulator.stands(run["q"][3], run["q_bar_a"][2], None)["arm/j"]
    at_the_start = simulator.stands(run["q"][0], run["q_bar_a"][0], None)["arm/j"]
    assert run.stands(2, simulator)["arm/j"].missing_Nm == there.missing_Nm
    assert there.missing_Nm < at_the_start.missing_Nm  # r falls as the arm goes down


def test_a_full_record_gives_a_turned_block_its_load_in_the_world():
    """5 N along x on 1 kg, turned by 0.5 rad, lack 5 N - mu m g along x."""
    changes = {"bodies.b.pose.rpy": [0, 0, 0.5], "contacts.f.mu_v": 0.2, "bodies.b.wrenches": []}
    scenario = made(row_of("6 N"), changes)
    simulator, q = scenario.simulator(), scenario.system.q_start
    F = scenario.system.load(q, "b", force=(5.0, 0.0, 0.0))
    run = rollout(simulator, q, [], 2, force=F, record="full", progress=False, findings=False)
    row = run.stands(0, simulator)["b"]
    m = 1.0
    assert_relative(row.missing_N, 5.0 - 0.2 * m * G)
    assert row.direction == pytest.approx([-1, 0, 0], abs=1e-9)


def test_a_block_on_a_prestressed_spring_of_the_user_stands():
    """Its cost h k |x - m g / k|^2 / 2 bears m g; one that begins slack gives way by m g / k."""
    import cvxpy as cp

    h, k = 0.01, 500.0
    scenario = made(row_of("6 N"), {"bodies.b.pose.xyz": [0, 0, 1], "bodies.b.wrenches": []})
    rows = []
    for sag in (G / k, 0.0):
        up = np.array([0.0, 0.0, sag])
        spring = Extension(lambda s, up=up: [h * k / 2 * cp.sum_squares(s.delta_q[:3] - up)])
        rows.append(scenario.simulator(lambda q, spring=spring: spring).stands()["b"])
    assert (rows[0].stands, rows[0].reason) == (True, "")
    assert rows[1].stands is None
    assert rows[1].reason.startswith("gives way by 19.6 mm first")


def bar_in_a_grip(cone, friction, torsion):
    """A bar between two fingers of 10 N each, off its middle: shares of friction and torsion."""
    mu_v, mu_omega, N = 0.6, 0.008, 10.0
    mass = friction * 2 * mu_v * N / G
    off = torsion * 2 * mu_omega * N / (mass * G)
    size = Box((0.12, 0.008, 0.02))
    bodies = {"bar": Body.of_shape("bar", size, mass=mass, xyz=(off, 0.0, 1.0))}
    for name, side in (("left", -0.018), ("right", 0.018)):
        finger = Body.of_shape(name, Sphere(0.01), 0.1, xyz=(0.0, side, 1.0), actuated=["base"])
        pressed = {"t": 0.0, "base": {"xyz": [0.0, side - np.copysign(N / 5000.0, side), 1.0]}}
        K = {"base": [1e6, 5000.0, 1e6, 1e4, 1e4, 1e4]}
        bodies[name] = {"body": finger, "K_q": K, "targets": [pressed]}
    grip = {
        "alpha": ["left", "right"],
        "beta": "bar",
        "mu_v": mu_v,
        "mu_omega": mu_omega,
        "rows": 6,
    }
    scene = {"h": 0.05, "steps": 1, "bodies": bodies, "contacts": {"grip": grip}, "shapes": {}}
    return load_scenario(scene, cone=cone, fast=True)


SUMS = {"ellipsoid": 2.0, "pyramid": 1.0, "product": np.inf}
"""Of the shares of friction u and of torsion v a cone bears what has a p-norm below 1."""


@pytest.mark.shared
@pytest.mark.parametrize("cone", SUMS)
@pytest.mark.parametrize("angle", [0.1, 0.4, 0.7, 1.0, 1.3])
@pytest.mark.parametrize(("of_limit", "stands"), [(0.96, True), (1.04, False), (1.4, False)])
def test_a_grip_bears_friction_and_torsion_as_its_cone_has_them(cone, angle, of_limit, stands):
    direction = np.array([np.cos(angle), np.sin(angle)])
    shares = of_limit * direction / np.linalg.norm(direction, SUMS[cone])
    scenario = bar_in_a_grip(cone, *shares)
    rows = standings(scenario, None)
    assert rows.cone == cone
    assert rows["bar"].stands is stands
    assert (rows["bar"].missing_N + rows["bar"].missing_Nm > 0) is not stands


def test_the_end_in_an_ellipsoid_is_proved_if_asked():
    """Of two shares of 0.8; what is missing is that without a proof."""
    scenario = bar_in_a_grip("ellipsoid", 0.8, 0.8)
    by_proof, without = (standings(scenario, None, certify=way)["bar"] for way in ("full", "off"))
    assert by_proof.stands is False
    assert_relative(by_proof.missing_N, without.missing_N, 1e-4)


def test_the_users_own_costs_are_not_asked():
    import cvxpy as cp

    scenario = load_scenario("block_incline", steps=1, cone="ellipsoid")
    extension = Extension(lambda symbols: [cp.norm1(symbols.delta_q_u)])
    row = scenario.simulator(lambda q: extension).stands()["rough"]
    assert (row.stands, row.reason) == (None, "the user's own costs or constraints are not asked")


@pytest.mark.parametrize(("z", "depth"), [(0.1, None), (0.065, None), (0.055, 45), (0.05, 50)])
def test_a_start_deeper_than_a_tenth_of_a_body_is_said(z, depth):
    """Of a box of 0.4 m; what it lacks is what it lacks on the surface."""
    scenario = made(row_of("a block of 2 kg on a slope"), {"bodies.b.pose.xyz": [0.0, 0.0, z]})
    row = standings(scenario, None)["b"]
    said = f"begins {depth} mm inside of what it touches, and is asked on its surface"
    assert row.reason == ("" if depth is None else said)
    assert row.words == "; ".join(filter(None, ["0.1874 N", row.reason]))
