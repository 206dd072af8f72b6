"""What holds a body that touches nothing, how far it falls, and shapes that are a body's feet."""

from math import cos, pi, sin

import mujoco
import numpy as np
import pytest

import quasistatic_ref as qr
from quasistatic_ref.optional.doctor.telling import numbers_of
from tests.optional.doctor.words import TIP, driven, free, of_shapes, scene, slides

LAMP = """<mujoco><worldbody><geom name="floor" type="plane" size="1 1 .1"/>
<site name="hook" pos="0 0 {hook}"/>
<body name="lamp" pos="0 0 0.3"><freejoint/>
<geom name="lamp" type="sphere" size="0.05" mass="0.2"/>
<site name="eye" pos="0 0 0.05"/></body>
<body name="bulb" pos="0.5 0 0.2"><freejoint/>
<geom name="bulb" type="sphere" size="0.02" mass="0.1"/>
</body></worldbody>{ties}</mujoco>"""
WELD = '<weld body1="lamp"/>'
CONNECT = '<connect body1="lamp" anchor="0 0 0.1"/>'
CHAIN = '<weld body1="lamp" body2="bulb"/>'
ROPE = """<tendon><spatial name="rope" limited="true" range="0 0.25"><site site="hook"/>
<site site="eye"/></spatial></tendon>"""


def of_mjcf(text, steps=1):
    """A scenario of a MuJoCo scene."""
    return qr.mujoco_scenario(mujoco.MjModel.from_xml_string(text), h=0.01, steps=steps)


def in_the_air(ties, hook=0.6):
    """Names of the bodies that are said to start in the air, with their distances [mm]."""
    run = of_mjcf(LAMP.format(hook=hook, ties=ties)).run(progress=False)
    said = [one for one in run.findings if one.name == "starts-in-the-air"]
    return {one.remedy.split()[1]: one.numbers["gap_mm"] for one in said}


@pytest.mark.parametrize(
    ("ties", "falling"),
    [
        ("", {"lamp": 250, "bulb": 180}),
        (f"<equality>{WELD}</equality>", {"bulb": 180}),
        (f"<equality>{CONNECT}</equality>", {"bulb": 180}),
        (f"<equality>{WELD}{CHAIN}</equality>", {}),
        (f"<equality>{CHAIN}</equality>", {"lamp": 250, "bulb": 180}),
        (ROPE, {"bulb": 180}),
    ],
    ids=["nothing", "weld", "connect", "chain", "weld of both", "taut rope"],
)
def test_bodies_that_are_held_do_not_start_in_the_air(ties, falling):
    assert in_the_air(ties) == pytest.approx(falling, abs=1e-3)


def test_a_slack_rope_holds_nothing():
    assert "lamp" in in_the_air(ROPE, hook=0.5)


GUIDED = {
    "leave out contact[world-b(floor, b)] (contact/exclude), and give b/x and b/y frictionloss":
        '<joint name="x" type="slide" axis="1 0 0"/><joint name="y" type="slide" axis="0 1 0"/>',
    "give contact[world-b(ceiling, b)] or contact[world-b(floor, b)] condim = 1, or more clearance":
        "<freejoint/>",
}  # fmt: skip


@pytest.mark.parametrize(("remedy", "joints"), [*GUIDED.items()], ids=["on joints", "free"])
def test_a_guide_of_a_mujoco_scene_is_mended_in_the_words_of_that(remedy, joints):
    """A box on a floor, and the free one under a ceiling that it touches."""
    z = 0.15 if "free" in joints else 2
    scenario = of_mjcf(
        f"""<mujoco><worldbody><geom name="floor" type="plane" size="1 1 .1"/>
        <geom name="ceiling" type="box" size="1 1 .05" pos="0 0 {z}"/>
        <body name="b" pos="0 0 0.05">{joints}<geom name="b" type="box" size=".05 .05 .05"/></body>
        </worldbody></mujoco>"""
    )
    assert remedy in [one.remedy for one in scenario.findings()]


def test_rails_inside_of_what_they_should_guide_are_penetration():
    """The cart and pole of others: their box, 0.4 x 0.3 x 0.2 m, is around the rails."""
    rail = '<geom name="{0}" type="capsule" pos="0 {1} 1" zaxis="1 0 0" size="0.02 2"/>'
    cart = '<body pos="0 0 1"><joint type="slide" axis="1 0 0"/>'
    cart += '<geom type="box" size="0.2 0.15 0.1" mass="1"/></body>'
    rails = rail.format("one", 0.07) + rail.format("two", -0.07)
    with pytest.raises(qr.RunFailed) as failed:
        of_mjcf(f"<mujoco><worldbody>{rails}{cart}</worldbody></mujoco>").run(progress=False)
    deep = [one for one in failed.value.trajectory.findings if "deep at the start" in one.cause]
    assert len(deep) == 2


SLIDE = """<body name="arm" pos="0 0 0.5"><joint name="arm" type="slide" axis="0 0 1"/>
<geom name="arm" type="box" size="0.02 0.02 0.02" mass="0.1"/></body>"""
BOX = """<body name="box" pos="0 0 {z}"><freejoint/>
<geom name="box" type="box" size="0.1 0.1 0.1" mass="1"/></body>"""
SERVO = '<actuator><position name="arm" joint="arm" kp="100"/></actuator>'
FALLS = {"starts-in-the-air", "free-fall", "unsupported-body"}


@pytest.mark.parametrize(
    ("other", "name", "servo", "falling"),
    [
        (SLIDE, "arm", SERVO, {}),  # it sags by 29 mm with the lamp
        (SLIDE, "arm", "", {"lamp"}),  # which slides down with it
        (BOX.format(z=0.1), "box", "", {}),
        (BOX.format(z=0.5), "box", "", {"lamp", "box"}),
    ],
    ids=["actuated link", "loose slide", "standing box", "falling box"],
)
@pytest.mark.parametrize("touches", [True, False], ids=["", "no pairs"])
def test_what_a_lamp_is_welded_to_bears_it_or_falls_with_it(other, name, servo, falling, touches):
    bits = "" if touches else 'contype="0" conaffinity="0"'
    scenario = of_mjcf(
        f"""<mujoco><worldbody><geom name="floor" type="plane" size="1 1 .1"/>{other}
        <body name="lamp" pos="0.3 0 0.3"><freejoint/>
        <geom name="lamp" type="sphere" size="0.05" mass="0.2" {bits}/></body></worldbody>
        <equality><weld body1="lamp" body2="{name}"/></equality>{servo}</mujoco>""",
        steps=3,
    )
    found = scenario.run(progress=False).findings
    said = " ".join(one.sentence for one in found if one.name in FALLS)
    assert {body for body in ("lamp", "box") if body in said} == {*falling}


@pytest.mark.parametrize(
    ("at", "distance"), [(0.3, None), (0.05, pytest.approx(0.0, abs=1e-9))], ids=["far", "touching"]
)
def test_a_filler_is_no_distance(at, distance):
    lamp = LAMP.format(hook=0.6, ties="").replace("0 0 0.3", f"0 0 {at}")
    made = of_mjcf(lamp)
    pairs = numbers_of(made.run(progress=False), made)["pairs"]
    (numbers,) = [each for name, each in pairs.items() if "floor, lamp" in name]
    assert numbers.get("least_distance_m") == distance


def standing(shapes, mass, inertia, centre=(0, 0, 0), z=0.05):
    """A body of some shapes over a floor, as a table, and its contacts."""
    touching = [f"b/s{i}" for i in range(len(shapes))]
    body = free(of_shapes(shapes, mass, inertia, centre), (0, 0, z))
    return {"b": body}, {"floor": ("floor", touching, 0.5, 4)}


def found(*body):
    return scene(*standing(*body), 1).run(progress=False).findings


def sphere(radius):
    return f'<sphere radius="{radius}"/>'


def plate(x, y, z):
    return f'<box size="{x} {y} {z}"/>'


HOLLOW = {
    "a cabinet on three feet": (
        [(sphere(0.01), 0.2 * cos(a), 0.2 * sin(a), -0.24, 0) for a in (0, 2 * pi / 3, 4 * pi / 3)],
        20.0,
        0.5,
        (0, 0, 0),
        0.25,
    ),
    "a mug of boxes": (
        [
            (plate(0.008, 0.034, 0.1), 0.04 * cos(a), 0.04 * sin(a), 0, a)
            for a in np.arange(8) * pi / 4
        ],
        0.3,
        4e-4,
    ),
    "a table on legs": (
        [(plate(0.05, 0.05, 0.7), x, y, -0.35, 0) for x in (-0.5, 0.5) for y in (-0.3, 0.3)],
        15.0,
        2.0,
        (0, 0, -0.02),
        0.7,
    ),
    "a handle": (
        [
            (plate(0.02, 0.1, 0.02), 0, 0, 0, 0),
            (plate(0.08, 0.02, 0.02), 0.05, 0.04, 0, 0),
            (plate(0.08, 0.02, 0.02), 0.05, -0.04, 0, 0),
        ],
        0.2,
        3e-4,
        (0.045, 0, 0),
        0.01,
    ),
}


@pytest.mark.parametrize("body", HOLLOW.values(), ids=HOLLOW)
def test_what_is_between_the_shapes_of_a_body_is_its_own(body):
    assert [one.sentence for one in found(*body)] == []


def test_masses_and_centres_that_no_body_of_such_shapes_has_are_still_said():
    four = [(plate(0.02, 0.02, 0.1), x, y, 0, 0) for x in (-0.05, 0.05) for y in (-0.05, 0.05)]
    for mass, centre, name in (
        (60.0, (0, 0, 0), "density"),
        (1e-4, (0, 0, 0), "density"),
        (0.5, (0.3, 0, 0), "centre-of-mass"),
    ):
        assert name in [one.name for one in found(four, mass, 2e-3 * mass, centre)]


SIZES = {
    "sphere": "0.03",
    "box": "0.01 0.02 0.03",
    "cylinder": "0.03 0.01",
    "capsule": "0.03 0.01",
    "ellipsoid": "0.01 0.02 0.03",
}


def test_a_density_is_that_of_the_volume_by_which_mujoco_makes_the_mass():
    bodies = "".join(
        f'<body name="{kind}" pos="{i} 0 1"><freejoint/>'
        f'<geom type="{kind}" size="{size}" density="3"/></body>'
        for i, (kind, size) in enumerate(SIZES.items())
    )
    scenario = of_mjcf(f"<mujoco><worldbody>{bodies}</worldbody></mujoco>")
    said = [one for one in scenario.findings() if one.name == "density"]
    assert [one.numbers["density_kg_per_m3"] for one in said] == pytest.approx([3.0] * len(SIZES))


BALLS = (qr.Sphere(0.03), qr.Sphere(0.03))


@pytest.mark.parametrize(("can", "finger", "at", "fall"), [
    (qr.Cylinder(0.03, 0.04), qr.Box((0.01, 0.02, 0.02)), (0, 0, 0.14), 100),
    (*BALLS, (0, 0, 0.14), 110),  # past the other, 80 mm apart
    # 30 mm across, 60 mm at touch: sqrt(60^2 - 30^2) = 52 mm above the other
    (*BALLS, (0.05, 0, 0.3), 160 - 52),
])  # fmt: skip
def test_a_body_is_lowered_to_what_is_below_it_and_past_what_is_beside_it(can, finger, at, fall):
    """A finger and a floor; its fall is told of no other distance."""
    bodies = {
        "can": qr.Body.of_shape("can", can, 0.3, xyz=at),
        "finger": qr.Body.of_shape("finger", finger, 1.0, xyz=(0.08, 0, 0.14), base="fixed"),
    }
    contacts = {"floor": ("floor", "can", 0.5, 4), "grip": ("finger", "can", 0.5, 4)}
    remedies = {one.name: one.remedy for one in scene(bodies, contacts, 10).run().findings}
    assert remedies["starts-in-the-air"] == f"lower can by {fall} mm, or check its origin"
    assert remedies["free-fall"] == "start it on what should bear it"


def mug_and_finger(at, way=0.0):
    """A mug of eight boxes, and a finger that touches none of them and moves along x [m]."""
    bodies, contacts = standing(*HOLLOW["a mug of boxes"])
    targets = [{"t": 0, "x": 0.0}, {"t": 0.3, "x": way}]
    bodies["finger"] = driven(slides("x", TIP), at, {"x": 100.0}, targets)
    contacts["push"] = ("finger/tip", *contacts["floor"][1:3], 1)
    return scene(bodies, contacts, 30)


def test_a_finger_that_moves_inside_of_a_mug_is_not_told_to_turn_its_axis():
    """From the wall behind it to the middle, which leads it away from what it could touch first."""
    findings = mug_and_finger((-0.015, 0, 0.05), 0.02).run(progress=False).findings
    assert [one.name for one in findings][:2] == ["starts-inside", "idle-contacts"]
    assert findings[1].remedy == "check where b stands and how far finger/tip moves"


@pytest.mark.parametrize(("at", "inside"), [((0, 0, 0.05), True), ((0.2, 0, 0.05), False)])
def test_a_finger_that_starts_inside_of_a_mug_is_told_to_start_outside(at, inside):
    said = [x for x in mug_and_finger(at).findings() if x.name == "starts-inside"]
    assert [one.remedy for one in said] == ["start finger/tip#0 outside of b/b"] * inside
