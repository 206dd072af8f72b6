"""What holds a body that touches nothing, and guides and densities of MuJoCo scenes."""

import mujoco
import pytest

import quasistatic_ref as qr
from quasistatic_ref.optional.doctor.telling import numbers_of

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
}  # fmt: skip


@pytest.mark.parametrize(("remedy", "joints"), [*GUIDED.items()], ids=["on joints"])
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
    (said,) = [one for one in scenario.findings() if one.name == "density"]
    assert said.numbers["density_kg_per_m3"] == pytest.approx(3.0)
    assert said.cause.endswith(f"({len(SIZES) - 1} more are as suspect)")


def link(name, at, axis, ends, more=""):
    """A capsule on a hinge, of 0.1 kg between its ends, with what hangs on it."""
    return (
        f'<body name="{name}" pos="{at}"><joint name="{name}" axis="{axis}"/>'
        f'<geom type="capsule" fromto="{ends}" size=".01" mass=".1"/>{more}</body>'
    )


DOWN = "0 0 0 0 0 -.2"
ACROSS = link("c", "0 0 -.2", "0 1 0", "0 0 0 .2 0 0")
HANGING = {
    "a closed loop": (
        link("a", "-.1 0 1", "0 1 0", DOWN, ACROSS) + link("b", ".1 0 1", "0 1 0", DOWN),
        '<equality><connect body1="c" body2="b" anchor=".2 0 0"/></equality>'
        '<contact><exclude body1="b" body2="c"/></contact>',
    ),
    "two links in one line": (
        link("a", "0 0 1", "0 1 0", DOWN, link("b", "0 0 -.2", "0 1 0", "0 0 -.02 0 0 -.2")), "",
    ),
    "fingers of a palm that goes up": (
        '<body pos="0 0 1"><joint name="z" type="slide" axis="0 0 1"/><geom size=".03" mass=".2"/>'
        + "".join(link(f"f{y}", f"0 {y} 0", "1 0 0", "0 0 -.02 0 0 -.1") for y in (-0.04, 0.04))
        + "</body>",
        '<actuator><position name="z" joint="z" kp="1000"/></actuator>',
    ),
}  # fmt: skip


@pytest.mark.parametrize("what", HANGING)
def test_links_that_hang_at_rest_lack_nothing(what):
    """Their loads along their hinges are rounding."""
    bodies, more = HANGING[what]
    text = f"<mujoco><worldbody>{bodies}</worldbody>{more}</mujoco>"
    model = mujoco.MjModel.from_xml_string(text)
    targets = (lambda t: {"z": 0.1 * t}) if model.nu else None
    run = qr.mujoco_scenario(model, h=0.02, steps=10, targets=targets).run(progress=False)
    assert [one.sentence for one in run.findings] == []
