"""What stands and what is missing, by hand: just inside of a threshold and just outside of it."""

import math
import re

import numpy as np
import pytest

from quasistatic_ref import Box, Capsule, Extension, InputError, Sphere, load_scenario
from quasistatic_ref.lab.commands.stands import asked_steps, over_steps
from tests.files.urdf.urdf_texts import collision, link, robot
from tests.optional.words import driven, free, placed, slides, solid
from tests.scenes import FLOOR

G = 9.81
NEAR = 0.01
"""From a threshold, over it."""


def block(m, size, xyz, **load):
    return free(solid(m, Box(size=size)), xyz, **load)


def tilted(body, rpy):
    body["pose"]["rpy"] = list(rpy)
    return body


def on(alpha, beta, mu, k=4, mu_omega=0.0):
    torsion = {"mu_omega": mu_omega, "rows": 6} if mu_omega else {"rows": 4}
    return {"alpha": alpha, "beta": beta, "mu_v": mu, "k": k} | torsion


def hinge(shape, mass, at=(0, 0, 0), friction=0.0, xyz=(0, 0, 0)):
    """A link on a hinge through the origin, of a body at `xyz`."""
    inertial = f'<inertial><origin xyz="{at[0]} {at[1]} {at[2]}"/><mass value="{mass}"/>'
    inertial += '<inertia ixx="1e-3" iyy="1e-3" izz="1e-3" ixy="0" ixz="0" iyz="0"/></inertial>'
    origin = f'<origin xyz="{at[0]} {at[1]} {at[2]}"/>'
    joint = '<joint name="j" type="revolute"><parent link="post"/><child link="arm"/>'
    joint += '<axis xyz="0 1 0"/><limit lower="-9" upper="9" effort="9" velocity="9"/></joint>'
    urdf = robot(
        link("post", inertial=""), link("arm", collision(shape, origin), inertial=inertial), joint
    )
    body = {"urdf": urdf, "pose": {"xyz": list(xyz)}}
    return body | ({"joint_friction": {"j": friction}} if friction else {})


def finger(side, x, force, K=1e4, z=0.0):
    """A ball that presses along x, towards the origin, on what is x away."""
    at = [side * (x + 0.01), 0, z]
    to = [side * (x + 0.01 - force / K), 0, z]
    targets = [{"t": 0, "base": {"xyz": to}}]
    body = free(solid(0.1, Sphere(0.01)), at)
    del body["wrenches"]
    return body | {
        "actuated": ["base"],
        "K_q": {"base": [K, 1e6, 1e6, 1e5, 1e5, 1e5]},
        "targets": targets,
    }


def stands(bodies, contacts, shapes=None, backwards=False, certify="off", **more):
    """What is said of a scene where it starts."""
    if backwards:
        bodies = dict(reversed(bodies.items()))
        contacts = {
            name: table | {"alpha": table["beta"], "beta": table["alpha"]}
            for name, table in reversed(contacts.items())
        }
    scene = {"h": 0.01, "steps": 1, "bodies": bodies, "contacts": contacts}
    scenario = load_scenario(scene | {"shapes": shapes or {"floor": FLOOR}} | more)
    q = scenario.system.q_start
    force = scenario.force(0.0, q) if scenario.force else None
    return scenario.simulator().stands(q, scenario.targets(0.0), force, certify=certify)


def ladder(over):
    r, a = 0.02, math.pi / 3
    need = math.cos(a) / (2 * (math.sin(a) + r))
    middle = (-r - math.cos(a) / 2, 0, r + math.sin(a) / 2)
    rung = tilted(free(solid(2.0, Capsule(r, length=1.0)), middle), (0, math.pi / 2 - a, 0))
    wall = {"halfspace": {"normal": [-1, 0, 0], "offset": 0}}
    contacts = {"f": on("floor", "b", need * over, 2), "w": on("wall", "b", 0.0, 2)}
    return {"b": rung}, contacts, {"floor": FLOOR, "wall": wall}


def slope(over):
    a = 0.3
    plane = {"halfspace": {"normal": [math.sin(a), 0, math.cos(a)], "offset": 0}}
    up = np.array([math.sin(a), 0, math.cos(a)])
    body = tilted(block(1.0, (0.1, 0.1, 0.05), 0.025 * up), (0, a, 0))
    return {"b": body}, {"c": on("p", "b", math.tan(a) * over)}, {"p": plane}


def overhang(over):
    table = {"box": {"size": [1, 1, 0.1]}, "pose": {"xyz": [-0.5, 0, -0.05]}}
    board = block(1.0, (0.4, 0.1, 0.02), (0.2 * (1 - over), 0, 0.01))
    return {"b": board}, {"c": on("t", "b", 0.5)}, {"t": table}


def shelf(over):
    plate = hinge('<box size="0.2 0.2 0.02"/>', 0.1, (0.1, 0, 0), G * (0.01 + 0.1) * over)
    return {"s": plate, "b": block(1.0, (0.05, 0.05, 0.05), (0.1, 0, 0.035))}, {
        "c": on("s/arm", "b", 0.9)
    }


def groove(over):
    """A bar in a right-angled groove, which doubles mu by 1 / sin 45 degrees, pulled along it."""
    sides = {
        name: {"halfspace": {"normal": [0, s * math.sqrt(0.5), math.sqrt(0.5)], "offset": 0}}
        for name, s in (("l", 1), ("r", -1))
    }
    pull = 0.3 * G * math.sqrt(2) / over
    bar = block(1.0, (0.2, 0.04, 0.04), (0, 0, 0.02 * math.sqrt(2)), force=(pull, 0, 0))
    return {"b": tilted(bar, (math.pi / 4, 0, 0))}, {"c": on(["l", "r"], "b", 0.3)}, sides


def four_bar(over):
    """A light plate on two legs with friction in their hinges, which its 2 N tip over."""
    legs = {
        name: hinge(
            '<capsule radius="0.01" length="0.18"/>', 0.5, (0, 0, 0.1), 0.2 * over, (x, 0, 0)
        )
        for name, x in (("l", -0.1), ("r", 0.1))
    }
    plate = block(0.002, (0.4, 0.1, 0.02), (0, 0, 0.21), force=(2, 0, -20))
    return legs | {"p": plate}, {"c": on(["l/arm", "r/arm"], "p", 0.5, 1)}


def rider(over):
    pull = 0.2 * 3 * G / over
    low = block(2.0, (0.2, 0.2, 0.05), (0, 0, 0.025), force=(pull, 0, 0))
    bodies = {"low": low, "up": block(1.0, (0.1, 0.1, 0.02), (0, 0, 0.06))}
    return bodies, {"c": on("floor", "low", 0.2), "on": on("low", "up", 0.3)}


@pytest.mark.parametrize("backwards", [False, True])
@pytest.mark.parametrize("scene", [ladder, slope, overhang, shelf, groove, four_bar, rider])
def test_thresholds_are_met_to_a_hundredth_whatever_the_order(scene, backwards):
    inside = stands(*scene(1 + NEAR), backwards=backwards)
    outside = stands(*scene(1 - NEAR), backwards=backwards)
    assert {row.stands for row in inside} == {True}
    assert {row.stands for row in outside} == {False}


def two(lower, upper, force=5.0):
    """One block on another, of which fingers hold the lower one by 2 mu N = 5 N."""
    bodies = {
        "A": block(lower, (0.04,) * 3, (0, 0, 0)),
        "B": block(upper, (0.04,) * 3, (0, 0, 0.04)),
    }
    bodies |= {name: finger(side, 0.02, force) for name, side in (("l", -1), ("r", 1))}
    return bodies, {"g": on(["l", "r"], "A", 0.5, 1, 0.01), "on": on("A", "B", 0.5)}, {}


def seesaw(friction, at=0.1):
    plank = hinge('<box size="0.4 0.1 0.02"/>', 0.1, friction=friction)
    return {"plank": plank, "b": block(1.0, (0.04,) * 3, (at, 0, 0.03))}, {
        "c": on("plank/arm", "b", 0.9)
    }


def ball_on_a_box():
    """The box slides away below the ball, whose clamp bears its friction."""
    ball = free(solid(0.353, Sphere(0.05)), (0, 0, 0.15))
    box = block(2.0, (0.2, 0.2, 0.1), (0, 0, 0.05), force=(20, 0, 0))
    return {"box": box, "ball": ball}, {
        "f": on("floor", "box", 0.2),
        "on": on("box", "ball", 0.3, 1),
    }


def pressed(load, normal):
    """A body that fingers hold hard, and which is pulled out of them all the same."""
    bodies = {"b": block(0.02, (0.04,) * 3, (0, 0, 0), force=(0, 0, -load))}
    bodies |= {name: finger(side, 0.02, normal) for name, side in (("l", -1), ("r", 1))}
    return bodies, {"g": on(["l", "r"], "b", 0.5, 1, 0.01)}, {}


STICKS = (8 - 0.2 * 3 * G) / (3 * G)
"""Friction from which on the rider of a sled that 8 N pull sticks to it."""


def pulled(over):
    """A clamp on the sled bears all that is missing, one on the rider what friction leads to it."""
    bodies, contacts = rider(0.2 * 3 * G / 8)
    return bodies, {**contacts, "on": on("low", "up", STICKS * over)}


PALM = slides("z", '<box size="0.4 0.4 0.02"/>')
LACKS = [
    (seesaw(0.0), {"plank/j": (0.981, "Nm"), "b": (9.81, "N")}),
    (seesaw(0.5), {"plank/j": (0.481, "Nm")}),
    (seesaw(0.9), {"plank/j": (0.081, "Nm")}),
    (seesaw(0.1, at=-0.05), {"plank/j": (0.3905, "Nm")}),
    (two(0.1, 1.0), {"A": (5.791, "N"), "B": (5.791, "N")}),
    (two(0.5, 0.6), {"A": (5.791, "N"), "B": (5.791, "N")}),
    (two(0.6, 0.5), {"A": (5.791, "N"), "B": (4.905, "N")}),
    (rider(0.75), {"low": (1.962, "N"), "up": (1.962, "N")}),
    (ball_on_a_box(), {"ball": (0.3 * 0.353 * G, "N")}),  # 1.04 N
    (pulled(1 + NEAR), {"low": (2.11, "N"), "up": (STICKS * (1 + NEAR) * G, "N")}),
    (pulled(1 - NEAR), {"low": (2.11, "N"), "up": (STICKS * (1 - NEAR) * G, "N")}),
    (pressed(302.0, 300.0), {"b": (2 + 0.02 * G, "N")}),
    (pressed(50.2, 50.0), {"b": (0.2 + 0.02 * G, "N")}),
    (pressed(0.9, 1.0), {"b": (0.02 * G - 0.1, "N")}),
]


@pytest.mark.parametrize(("scene", "hand"), LACKS)
def test_what_a_clamp_on_one_body_alone_would_bear(scene, hand):
    standings = stands(*scene)
    for body, (value, unit) in hand.items():
        row = standings[body]
        assert row.stands is False
        assert getattr(row, f"missing_{unit}") == pytest.approx(value, rel=0.01)


def test_bodies_of_one_verdict_name_each_other():
    rows = stands(*four_bar(0.9))
    assert set(rows["p"].held_with) == {"l/j", "r/j"}
    assert rows["p"].missing_N == pytest.approx(2 - 2 * 0.2 * 0.9 / 0.2, rel=0.01)
    assert rows["p"].direction == pytest.approx((-1, 0, 0), abs=1e-3)
    standing = stands(*rider(1.1))
    assert [row.held_with for row in standing] == [(), ()]


@pytest.mark.parametrize(
    ("mass", "K", "size"), [(1.0, 50.0, 4.0), (40.0, 2000.0, 4.0), (1.0, 2000.0, 0.1)]
)
def test_what_a_spring_bears_in_the_end_stands(mass, K, size):
    """It sags by m g / K, less than a tenth of its size, at a rate of its own."""
    palm = driven(PALM, (0, 0, 0), {"z": K}, [{"t": 0, "z": 0.0}])
    body = block(mass, (size, size, 0.05), (0, 0, 0.035))
    contact = on("palm/tip", "b", 0.5)
    assert stands({"palm": palm, "b": body}, {"c": contact}, {})["b"].stands is True


def test_what_gives_way_first_is_not_decided():
    """A palm of 50 N/m sags by 196 mm under a box of 0.1 m, and at once lacks nearly all."""
    palm = driven(PALM, (0, 0, 0), {"z": 50.0}, [{"t": 0, "z": 0.0}])
    body = block(1.0, (0.1, 0.1, 0.05), (0, 0, 0.035))
    row = stands({"palm": palm, "b": body}, {"c": on("palm/tip", "b", 0.5)}, {})["b"]
    assert row.stands is None
    assert row.reason.startswith("gives way by 1")
    assert row.reason.endswith("N at once")


def test_a_plank_that_rocks_to_rest_lacks_a_moment_at_first():
    """0.2 kg at x = 50 mm on 4 kg on a drum, R = 0.3 m: rest at m x / ((M + m) R') = 8.25 mrad.

    A step turns it by h^2 m g x / I; what is left of m g x is missing, I / (I + M r^2) of it about
    the plank's middle, which is r = 10 mm above the drum.
    """
    bodies = {
        "p": block(4.0, (0.8, 0.1, 0.02), (0, 0, 0.31)),
        "b": block(0.2, (0.04,) * 3, (0.05, 0, 0.34)),
    }
    drum = {"cylinder": {"radius": 0.3, "length": 0.3}, "pose": {"rpy": [math.pi / 2, 0, 0]}}
    contacts = {"d": on("d", "p", 0.6, 2), "c": on("p", "b", 0.6)}
    scene = {"h": 0.02, "steps": 1, "bodies": bodies, "contacts": contacts, "shapes": {"d": drum}}
    scenario = load_scenario(scene)
    row = scenario.run(progress=False, findings=False).stands(0, scenario)["p"]
    moment, inertia = 0.2 * G * 0.05, 4.0 * (0.8**2 + 0.02**2) / 12
    turn = 0.02**2 * moment / (inertia + 4.0 * 0.01**2 + 0.2 * (0.05**2 + 0.04**2))
    left = moment * (1 - turn / 8.25e-3) * inertia / (inertia + 4.0 * 0.01**2)
    assert row.stands is False
    assert row.missing_Nm == pytest.approx(left, rel=1e-3)
    assert row.missing_Nm == pytest.approx(0.0957, abs=1e-4)


@pytest.mark.parametrize(("mass", "normal"), [(0.005, 1.0), (0.005, 50.0), (0.02, 300.0)])
def test_what_falls_lacks_its_weight_however_hard_it_was_held(mass, normal):
    """0.0491 and 0.1962 N: 1e-3 of the load of this step, and not of the run's largest force."""
    bodies = {"b": block(mass, (0.02,) * 3, (0, 0, 0.3))}
    for name, side in (("l", -1), ("r", 1)):
        bodies[name] = finger(side, 0.01, normal, K=500 * normal, z=0.3)
        ways = ((0.0, 0.018), (0.02, 0.018), (0.05, 0.04))
        bodies[name]["targets"] = [{"t": t, "base": {"xyz": [side * x, 0, 0.3]}} for t, x in ways]
    contacts = {"g": on(["l", "r"], "b", 0.5, 1, 0.003), "f": on("floor", "b", 0.5)}
    scene = {"h": 0.01, "steps": 10, "bodies": bodies, "contacts": contacts}
    scenario = load_scenario(scene | {"shapes": {"floor": FLOOR}})
    run = scenario.run(progress=False, findings=False)
    assert run.stands(1, scenario)["b"].stands is True
    assert run.stands(9, scenario)["b"].missing_N == pytest.approx(mass * G, rel=1e-3)


@pytest.mark.parametrize("pressed", [20.0, 2000.0])
def test_what_was_pressed_hard_once_lacks_what_friction_does_not_bear(pressed):
    """6.4 N on 1 kg, mu = 0.5: 1.495 N."""
    loads = ((0.0, 0.0, pressed), (0.02, 0.0, pressed), (0.03, 6.4, 0.0))
    body = block(1.0, (0.1, 0.1, 0.04), (0, 0, 0.02))
    body["wrenches"] = [{"t": t, "force": [x, 0, -z]} for t, x, z in loads]
    scene = {"h": 0.01, "steps": 6, "bodies": {"b": body}, "contacts": {"f": on("floor", "b", 0.5)}}
    scenario = load_scenario(scene | {"shapes": {"floor": FLOOR}})
    run = scenario.run(progress=False, findings=False)
    assert run.stands(1, scenario)["b"].stands is True
    assert run.stands(5, scenario)["b"].missing_N == pytest.approx(6.4 - 0.5 * G, rel=1e-3)


def test_every_step_is_asked_however_many_bodies_lack_something_at_times_of_their_own():
    """Each of 14 boxes is pushed for two steps: it lacks F - mu m g, 2.55 to 5.15 N."""
    bodies, contacts = {}, {}
    for i in range(14):
        body = block(0.5, (0.06, 0.06, 0.04), (i % 5 * 0.2, i // 5 * 0.2, 0.02))
        at, F = 0.01 * (1 + i), 5 + 0.2 * i
        loads = ((0.0, 0.0), (at, 0.0), (at + 0.001, F), (at + 0.019, F), (at + 0.02, 0.0))
        body["wrenches"] = [{"t": t, "force": [x, 0, 0]} for t, x in loads]
        bodies[f"b{i}"] = body
        contacts[f"c{i}"] = on("floor", f"b{i}", 0.5)
    scene = {"h": 0.01, "steps": 16, "bodies": bodies, "contacts": contacts}
    scenario = load_scenario(scene | {"shapes": {"floor": FLOOR}}, backend="daqp", certify="off")
    run = scenario.run(progress=False, findings=False)
    steps = asked_steps(run, None, 1)
    asked = [run.stands(k, scenario) for k in steps]
    for i in range(14):
        row = over_steps([(k, rows[f"b{i}"]) for k, rows in zip(steps, asked, strict=True)])
        assert row["missing_N"] == pytest.approx(5 + 0.2 * i - 0.25 * G, rel=1e-3)
        assert row["lacks"] in (1, 2)


def test_a_verdict_does_not_depend_on_the_time_that_is_asked():
    scene = two(0.5, 0.6)
    short, long = (stands(*scene, h=h) for h in (0.01, 0.03))  # T = 1 s and 3 s
    for row in short:
        assert row.missing_N == pytest.approx(long[row.body].missing_N, rel=1e-3)


def test_proved_ends_say_the_same_and_bad_words_are_refused():
    scenario = load_scenario("block_incline", steps=2, backend="daqp")
    run = scenario.run(progress=False, findings=False)
    off, full = (run.stands(1, certify=word) for word in ("off", "full"))
    for row in off:
        assert full[row.body].stands is row.stands
        assert full[row.body].missing_N == pytest.approx(row.missing_N, rel=1e-6)
    with pytest.raises(InputError, match="certify: must be full or off"):
        run.stands(1, certify="residual")
    with pytest.raises(InputError, match="step: must be 0 to 1"):
        run.stands(2)
    with pytest.raises(InputError, match="is no body"):
        off["blok"]


@pytest.mark.parametrize("mass", [0.05, 5.0])
def test_a_pile_of_mixed_solids_is_decided_and_its_ends_are_proved(mass):
    """A ball presses two others apart, against boxes: 50 g bear 0.25 N of some 1.7 N, 5 kg all."""
    bodies = {
        name: free(solid(1.0, Sphere(0.05)), (x, 0, z))
        for name, x, z in (("l", -0.05, 0.05), ("r", 0.05, 0.05), ("t", 0, 0.05 + 0.05 * 3**0.5))
    }
    bodies |= {f"b{x}": block(mass, (0.1,) * 3, (0.15 * x, 0, 0.05)) for x in (-1, 1)}
    contacts = {
        "floor": on("floor", [*bodies], 0.5),
        "top": on(["l", "r"], "t", 0.1, 1),
        "side": on(["l", "r"], ["b-1", "b1"], 0.1, 1),
    }
    off, full = (stands(bodies, contacts, certify=word) for word in ("off", "full"))
    assert {row.stands for row in off} == {mass > 1}
    for row in off:
        same = full[row.body]
        assert (same.stands, same.held_with) == (row.stands, row.held_with)
        assert same.missing_N == pytest.approx(row.missing_N, rel=1e-6)


def test_a_light_record_needs_the_scenario_and_a_scene_of_no_free_body_says_so():
    scenario = load_scenario("sphere_spin", {"record": "light"}, steps=60, backend="daqp")
    run = scenario.run(progress=False, findings=False)
    with pytest.raises(InputError, match="holds no loads; give its scenario"):
        run.stands(59)
    assert run.stands(59, scenario)["sphere"].missing_Nm > 0
    actuated = load_scenario("peg_in_hole", steps=1, backend="daqp")
    assert "nothing in this scene is free" in str(actuated.run(progress=False).stands(0))


def test_an_ellipsoid_is_asked_by_facets_and_says_so():
    """6 N at 45 degrees: a round cone bears 0.5 m g of it, the pyramid less."""
    push = 6 / math.sqrt(2)
    body = {"b": block(1.0, (0.1,) * 3, (0, 0, 0.05), force=(push, push, 0))}
    contacts = {"c": on("floor", "b", 0.5)}
    here, there = (stands(body, contacts, cone=cone) for cone in ("ellipsoid", "pyramid"))
    assert here.cone == "ellipsoid (facets-32)"
    assert here["b"].missing_N == pytest.approx(6 - 0.5 * G, rel=0.01)
    assert there["b"].missing_N == pytest.approx(6 - 0.5 * G / math.sqrt(2), rel=0.01)


def test_the_users_own_costs_are_not_asked():
    import cvxpy as cp

    scenario = load_scenario("block_incline", steps=1)
    extension = Extension(lambda symbols: [cp.norm1(symbols.delta_q_u)])
    row = scenario.simulator(lambda q: extension).stands()["rough"]
    assert (row.stands, row.reason) == (None, "the user's own costs or constraints are not asked")


def drawn_slope(draw):
    a, mu, m = draw(0.1, 0.6), draw(0.1, 0.8), draw(0.1, 5.0)
    up = np.array([math.sin(a), 0, math.cos(a)])
    plane = {"halfspace": {"normal": up.tolist(), "offset": 0}}
    body = tilted(block(m, (0.1, 0.1, 0.05), 0.025 * up), (0, a, 0))
    lacks = m * G * (math.sin(a) - mu * math.cos(a))
    return {"b": body}, {"c": on("p", "b", mu)}, {"p": plane}, "b", lacks, "N"


def drawn_rider(draw):
    mu, m_1, m_2, F = draw(0.1, 0.4), draw(0.5, 3.0), draw(0.5, 3.0), draw(2.0, 20.0)
    low = block(m_1, (0.2, 0.2, 0.05), (0, 0, 0.025), force=(F, 0, 0))
    bodies = {"low": low, "up": block(m_2, (0.1, 0.1, 0.02), (0, 0, 0.06))}
    contacts = {"c": on("floor", "low", mu), "on": on("low", "up", 3.0)}
    return bodies, contacts, None, "low", F - mu * (m_1 + m_2) * G, "N"


def drawn_seesaw(draw):
    at, m, friction = draw(0.03, 0.15), draw(0.2, 3.0), draw(0.05, 2.0)
    plank = hinge('<box size="0.4 0.1 0.02"/>', 0.1, friction=friction)
    bodies = {"s": plank, "b": block(m, (0.04,) * 3, (at, 0, 0.03))}
    return bodies, {"c": on("s/arm", "b", 0.9)}, None, "s/j", m * G * at - friction, "Nm"


def drawn_grip(draw):
    a, b, force = draw(0.1, 1.0), draw(0.1, 1.0), draw(3.0, 15.0)
    return *two(a, b, force), "A", (a + b) * G - force, "N"


def drawn_fall(draw):
    m = draw(0.01, 10.0)
    return (
        {"b": block(m, (0.1,) * 3, (0, 0, 1))},
        {"c": on("floor", "b", 0.5)},
        None,
        "b",
        m * G,
        "N",
    )


DRAWN = (drawn_slope, drawn_rider, drawn_seesaw, drawn_grip, drawn_fall)


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("scene", DRAWN)
def test_r49_what_is_missing_of_drawn_scenes(scene, seed):
    rng = np.random.default_rng(seed)
    bodies, contacts, shapes, body, lacks, unit = scene(lambda *ends: float(rng.uniform(*ends)))
    row = stands(bodies, contacts, shapes)[body]
    assert row.stands is (lacks <= 0)
    assert getattr(row, f"missing_{unit}") == pytest.approx(max(lacks, 0.0), rel=0.01)


def test_a_bar_in_fingers_that_twist_gives_way_first():
    """Its middle is d = 8 mm off: at once m d a and m k^2 a, a = g d / (k^2 + d^2).

    k is its radius of gyration. Once the fingers have twisted by m g d / K they bear it.
    """
    m, d = 1.15, 0.008
    k = math.sqrt((0.08**2 + 0.02**2) / 12)
    K = m * G * d * math.hypot(k, d) / 0.012
    bodies = {"bar": block(m, (0.08, 0.02, 0.02), (-d, 0, 0))}
    for name, side in (("l", -1), ("r", 1)):
        targets = [{"t": 0, "base": {"xyz": [0, 0.019 * side, 0]}}]
        one = placed(solid(0.1, Sphere(0.01)), (0, 0.02 * side, 0), base="floating")
        K_q = {"base": [1e9, 1e4, 1e9, 1e5, K / 2, 1e5]}
        bodies[name] = one | {"actuated": ["base"], "K_q": K_q, "targets": targets}
    row = stands(bodies, {"g": on(["l", "r"], "bar", 0.9, 1, 0.02)}, {})["bar"]
    a = G * d / (k**2 + d**2)
    assert row.stands is None
    words = re.fullmatch(r"gives way by 12 mm first; (\S+) N and (\S+) N m at once", row.reason)
    assert [*map(float, words.groups())] == pytest.approx([m * d * a, m * k**2 * a], rel=0.01)
    assert m * d * a == pytest.approx(1.145, rel=1e-3)
