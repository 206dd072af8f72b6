"""Second opinions: scenes of the guide, healthy ones, and states that statics decides by hand."""

import json

import mujoco
import numpy as np
import pytest
from jsonschema import Draft4Validator

import quasistatic_ref as qr
from quasistatic_ref.lab.commands.schema import opinion_schema
from quasistatic_ref.optional.mujoco.mujoco_opinion import FELL_BACK
from quasistatic_ref.optional.mujoco.settled import settled
from tests.helpers import one_sentence
from tests.optional.mujoco.models import GRAVITY, mjcf, model_of, posed
from tests.pages import ROOT, downloads, flat, printed_blocks

PAGE = (ROOT / "docs/guides/does_my_contact_hold.md").read_text("utf-8")
NOSLIP = 'impratio="10" noslip_iterations="10"'
WEAK = {"left": 0.001, "right": 0.001}

FLOOR = '<geom name="floor" type="plane" size="5 5 1"/>'
BOX = '<geom name="box" type="box" size=".1 .1 .1" mass="1"/>'
UP = '<joint name="up" type="slide" axis="0 0 1"'
FREE = '<body name="b" pos="0 0 .1"><freejoint/>'


def opinion(text, seconds=2.0, keyframe=None, control=None):
    """The opinion on a scene that has settled, which knows where it started."""
    model = model_of(text)
    start = settled(model, 0.0, keyframe, control)
    return qr.mujoco_opinion(model, settled(model, seconds, keyframe, control), start=start)


def torsional_fingers(text):
    """A scene whose fingertips have torsional friction."""
    return text.replace('condim="3"', 'condim="4"')


SCENES = downloads("opinion")
GUIDE = {
    "capsule": (SCENES["capsule.xml"], 2, "grip"),
    "mug": (SCENES["mug.xml"], 0, "grip"),
    "mug, condim 4": (torsional_fingers(SCENES["mug.xml"]), 2, "grip"),
    "mug, condim 4, weak": (torsional_fingers(SCENES["mug.xml"]), 0, "grip", WEAK),
    "block": (SCENES["block.xml"], 2),
}


@pytest.fixture(scope="module")
def opinions():
    return {name: opinion(*arguments) for name, arguments in GUIDE.items()}


def test_the_guide_shows_what_is_found(opinions):
    shown = (opinions[name] for name in ("capsule", "mug"))
    sentences = [f"- {one}" for opinion in shown for one in opinion.findings]
    assert [flat(block) for block in printed_blocks(PAGE)] == sentences


def test_needed_and_possible_loads_are_those_of_statics(opinions):
    """Weights and slopes by hand; the pads of the capsule press with what MuJoCo says, too."""
    slope = np.radians(15)
    block = opinions["block"].bodies[0]
    assert block.needed == pytest.approx(GRAVITY * np.sin(slope), rel=1e-6)
    assert block.bears == pytest.approx(0.5 * GRAVITY * np.cos(slope), rel=1e-6)
    cap = opinions["capsule"].bodies[-1]
    normal = sum(c.theirs.normal for c in opinions["capsule"].contacts)
    assert cap.needed == pytest.approx(0.045 * GRAVITY, rel=1e-6)
    assert cap.bears == pytest.approx(0.7 * normal, rel=1e-3)
    mug = opinions["mug"].bodies[-1]
    assert mug.torque == pytest.approx(0.3 * GRAVITY * 0.03, rel=1e-6)
    assert [c.exact.normal for c in opinions["mug"].contacts if c.exact] == pytest.approx(
        [19.9] * 2
    )
    weak = opinions["mug, condim 4, weak"].bodies[-1]
    assert weak.needed == pytest.approx(0.3 * GRAVITY, rel=1e-6)
    assert weak.bears == pytest.approx(2 * 0.8 * 1000 * 0.0009, rel=0.01)


def test_options_that_are_named_end_the_creep(opinions):
    assert [one.name for one in opinions["capsule"].findings] == ["creeps"]
    slower = SCENES["capsule.xml"].replace('impratio="1"', NOSLIP)
    assert opinion(slower, 2, "grip").findings == ()
    slower = torsional_fingers(SCENES["mug.xml"]).replace('impratio="100"', NOSLIP)
    assert opinion(slower, 2, "grip").findings == ()


@pytest.mark.parametrize("normal", [0.5, 1.0, 1.2])
def test_a_grip_holds_the_share_of_the_weight_that_its_friction_bears(normal):
    """2 mu N of m g, N = kp (control - position)."""
    control = dict.fromkeys(WEAK, normal / 1000 + 0.0001)
    (finding,) = opinion(torsional_fingers(SCENES["mug.xml"]), 0, "grip", control).findings
    assert finding.name == "slides"
    share = 2 * 0.8 * normal / (0.3 * GRAVITY)
    assert finding.numbers == {"share": pytest.approx(share, rel=0.02)}


def free(name, geom, at):
    """A body that is free, of one geom."""
    return f'<body name="{name}" pos="{at}"><freejoint/><geom name="{name}" {geom}/></body>'


BRICK = 'type="box" size=".05 .06 .04"'
HEALTHY = {
    "capsule": free("rod", 'type="capsule" size=".02 .1" euler="0 90 0"', "0 0 .02"),
    "plank": free("a", BRICK, "-.2 0 .04") + free("b", BRICK, ".2 0 .04")
    + free("c", 'type="box" size=".3 .05 .01"', "0 0 .09"),
    "a door on its limit": free("box", BRICK, "0 0 .04")
    + '<body pos="1 0 1"><joint axis="0 1 0" range="-20 20" damping=".5"/>'
    '<geom type="box" size=".2 .2 .01" pos=".2 0 0" mass="1"/></body>',
    "a box that is pushed": free("box", BRICK, "0 0 .04")
    + '<body pos="-.1 0 .03"><joint name="x" type="slide" axis="1 0 0" damping="50"/>'
    '<geom size=".03" mass=".2"/></body>',
}  # fmt: skip
"""Chosen before there were findings."""
PUSH = '<actuator><position name="x" joint="x" kp="100"/></actuator>'


@pytest.mark.parametrize("name", HEALTHY)
def test_a_healthy_scene_has_no_finding(name):
    pushed = "pushed" in name
    options = '<option cone="elliptic" impratio="100"/>'
    text = mjcf(FLOOR + HEALTHY[name], PUSH if pushed else "", options)
    answer = opinion(text, control={"x": 0.025} if pushed else None)
    assert answer.contacts
    assert answer.findings == ()


def test_bodies_in_each_other_are_found_with_their_depth_and_forces():
    """A box of 1 kg/dm^3 that begins 5 mm deep, its weight by hand."""
    (finding,) = opinion(mjcf(FLOOR + free("box", BRICK, "0 0 .035")), 0).findings
    assert (finding.name, finding.numbers) == ("penetrates", {"depth_mm": pytest.approx(5.0)})
    weight = 1000 * 0.1 * 0.12 * 0.08 * GRAVITY
    assert "box and world penetrate by 5 mm, and are pushed apart with" in finding.cause
    assert f"their loads ask for {weight:.3g} N" in finding.cause
    assert "contact/exclude" in finding.remedy


def test_a_ball_that_rests_by_rolling_friction_alone_is_found():
    """A ball on a slope of 3 degrees; the exact step has no row for rolling."""
    g = f"{GRAVITY * np.sin(0.05)} 0 {-GRAVITY * np.cos(0.05)}"
    rolls = 'condim="6" friction="1 .1 .1"'
    world = f'<geom name="floor" type="plane" size="5 5 1" {rolls}/>' + free(
        "ball", f'size=".1" {rolls}', "0 0 .1"
    )
    options = f'<option gravity="{g}" cone="elliptic" {NOSLIP}/>'
    (finding,) = opinion(mjcf(world, options=options)).findings
    assert (finding.name, "ball rests in MuJoCo" in finding.cause) == ("moves", True)
    assert "rolling friction" in finding.remedy


@pytest.mark.usefixtures("compiled_here")
def test_the_command_prints_json_of_the_schema_and_ends_with_1(tmp_path, cli):
    (tmp_path / "block.xml").write_text(SCENES["block.xml"])
    command = "opinion", tmp_path / "block.xml", "--settle 0.5"
    record = json.loads(cli(*command, "--json", status=1).out)
    Draft4Validator.check_schema(opinion_schema())
    Draft4Validator(opinion_schema()).validate(record)
    assert [one["name"] for one in record["findings"]] == ["creeps"]
    assert "no finding" in cli(*command, "--tolerance 0.01").out


@pytest.mark.usefixtures("compiled_here")
def test_the_command_looks_at_the_end_of_settling(tmp_path, cli):
    """A box slides with g (sin - mu cos): in the last 0.1 s of 1 s its speed is that at 0.95 s."""
    box = free("box", 'type="box" size=".1 .1 .1" mass="1" friction="0.3"', "0 0 .1")
    floor = '<geom type="plane" size="5 5 .1" friction="0.3"/>'
    scene = tmp_path / "slope.xml"
    option = '<option gravity="4.104 0 -9.119"/>'
    scene.write_text(f"<mujoco>{option}<worldbody>{floor}{box}</worldbody></mujoco>")
    (body,) = json.loads(cli("opinion", scene, "--settle 1 --json", status=1).out)["bodies"]
    assert body["theirs"]["speed"] == pytest.approx(0.95 * (4.104 - 0.3 * 9.119), rel=0.05)


REFUSED = {
    "joint[x].springyield": "",
    "--keyframe gripp": "--keyframe gripp",
    "--control left=1": "--control left=1",
    "--control": "--control left",
    "--control v": "--control v=nan",
    "--tolerance 0": "--tolerance 0",
    "--settle -1": "--settle -1",
}


@pytest.mark.usefixtures("compiled_here")
@pytest.mark.parametrize("named", REFUSED)
def test_a_wrong_option_of_opinion_ends_with_2_and_is_named(named, tmp_path, cli):
    field = 'stiffness="1" springyield="1"' if "yield" in named else ""
    scene = tmp_path / "scene.xml"
    scene.write_text(mjcf(f'<body><joint name="x" {field}/><geom size=".1"/></body>'))
    assert f"{named}:" in one_sentence(cli("opinion", scene, REFUSED[named], status=2).err)


def test_a_simulation_that_is_unstable_is_refused():
    text = SCENES["capsule.xml"].replace('impratio="1"', 'timestep="0.2"')
    with pytest.raises(qr.ModelError, match=r"option\.timestep: is too large"):
        opinion(text, 20, "grip")


def test_a_body_that_slips_because_it_turns_is_asked_for_a_force():
    """A capsule on its end, held by a soft weld: its one contact has no torque to bear."""
    text = """<mujoco><worldbody>
    <geom type="plane" size="1 1 .1"/>
    <body name="box" pos="0 0 0.051"><freejoint/>
      <geom type="box" size=".05 .05 .05" mass="0.5"/></body>
    <body name="cap" pos="0.3 0 0.12"><freejoint/>
      <geom type="capsule" size=".03 .1" mass="0.2" friction="0.1"/></body></worldbody>
    <equality><weld body1="box" body2="cap"/></equality></mujoco>"""
    (finding,) = [one for one in opinion(text, 2).findings if one.name == "creeps"]
    assert "N mm" not in finding.sentence


def groove(angle, mu):
    """A ball of 1 kg in a groove of two planes."""
    planes = "".join(
        f'<geom name="side{k}" type="plane" size="5 5 1" euler="0 {k * angle} 0"/>' for k in (-1, 1)
    )
    height = 0.0999 / np.cos(np.radians(angle))
    ball = free("ball", 'size=".1" mass="1"', f"0 0 {height}")
    return mjcf(planes + ball, options=f'<default><geom friction="{mu}"/></default>')


SHARED = {
    "a groove of 60 degrees": groove(60, 0.6),
    "a weld": mjcf(
        f"{FLOOR}{FREE}{BOX}</body>", '<equality><weld body1="b" body2="world"/></equality>'
    ),
    "friction of a joint": mjcf(
        f'{FLOOR}<body name="b" pos="0 0 .1">{UP} frictionloss="9"/>{BOX}</body>'
    ),
    "the limit of a joint": mjcf(
        f'{FLOOR}<body name="b" pos="0 0 .1">{UP} limited="true" range="-.00001 1"/>{BOX}</body>'
    ),
}


@pytest.mark.parametrize("shared", SHARED)
def test_a_load_that_is_shared_accuses_nobody(shared):
    """All bodies rest, and MuJoCo's forces balance the weight inside the cones."""
    answer = opinion(SHARED[shared])
    assert answer.findings == ()
    assert all(body.balanced and body.rests for body in answer.bodies)
    more = sum(c.theirs.normal - (c.exact.normal if c.exact else 0.0) for c in answer.contacts)
    noted = any("not unique" in sentence for sentence in answer.left_out)
    assert noted == (abs(more) > 0.01 * GRAVITY)


LIFT = '<geom name="plate" type="box" size=".3 .3 .02" mass="5"/>'
CARRIED = {
    "a damper": ('damping="2e5"', ""),
    "a damped servo": ("", '<actuator><general joint="up" biastype="affine" '
                       'biasprm="0 0 -2e5"/></actuator>'),
}  # fmt: skip


@pytest.mark.parametrize("by", CARRIED)
def test_the_force_of_a_damper_is_a_load(by):
    """A plate that sinks at a steady speed carries a box: 9.81 N in both answers."""
    joint, more = CARRIED[by]
    lift = f'<body name="lift">{UP} {joint}/>{LIFT}</body>'
    box = f'<body name="b" pos="0 0 .12"><freejoint/>{BOX}</body>'
    answer = opinion(mjcf(lift + box, more, '<option integrator="implicitfast"/>'))
    assert answer.findings == ()
    assert sum(c.exact.normal for c in answer.contacts) == pytest.approx(GRAVITY, rel=0.01)
    assert any("dampers" in sentence for sentence in answer.left_out)


SLOPE = '<option gravity="-2.539 0 -9.4757" {}>{}</option>'  # 15 degrees
ON_SLOPE = f"{FLOOR}{FREE}{BOX}</body>".replace("size", 'friction="0.5" size')


def test_a_body_that_sleeps_is_looked_at_as_if_awake():
    """It creeps by 0.97 mm/s, as the same block does that may not sleep."""
    asleep = SLOPE.format("", '<flag sleep="enable"/>')
    speeds = [
        opinion(mjcf(ON_SLOPE, options=options)).findings[0].numbers["slip_mm_s"]
        for options in (asleep, SLOPE.format("", ""))
    ]
    assert speeds == pytest.approx([0.97] * 2, rel=0.02)


@pytest.mark.parametrize("iterations", [0, 10])
def test_in_the_pyramid_the_elliptic_cone_is_named_first(iterations):
    options = SLOPE.format(f'noslip_iterations="{iterations}"', "")
    answer = opinion(mjcf(ON_SLOPE, options=options))
    (creep,) = answer.findings
    assert creep.remedy.startswith('set option cone="elliptic" first')
    elliptic = SLOPE.format('cone="elliptic" noslip_iterations="10" impratio="10"', "")
    assert opinion(mjcf(ON_SLOPE, options=elliptic)).findings == ()


def test_the_number_of_a_creep_is_its_slip():
    """A block on a soft floor sinks at 41 mm/s, and slips at that of its joint along the floor."""
    soft = 'solref="1 1"'
    floor = f'<geom name="floor" type="plane" size="1 1 .1" {soft}/>'
    joints = '<joint name="x" type="slide" axis="1 0 0"/><joint type="slide" axis="0 0 1"/>'
    box = BOX.replace("/>", f" {soft}/>")
    more = '<actuator><motor joint="x" name="push"/></actuator>'
    more += '<keyframe><key name="k" ctrl="3"/></keyframe>'
    options = '<option cone="elliptic" impratio="100000"/>'
    text = mjcf(f'{floor}<body name="b" pos="0 0 .1">{joints}{box}</body>', more, options)
    (creep,) = opinion(text, 0.3, "k").findings
    slip = 1e3 * settled(model_of(text), 0.3, "k").qvel[0]
    assert creep.numbers == {"slip_mm_s": pytest.approx(slip)}
    assert slip == pytest.approx(3.2, rel=0.01)


def stack(light, heavy):
    """A box on another."""
    box = 'type="box" size=".1 .1 .1" mass="{}"'
    two = free("light", box.format(light), "0 0 .1") + free("heavy", box.format(heavy), "0 0 .3")
    return mjcf(FLOOR + two)


def test_bodies_that_a_load_presses_into_each_other_are_found():
    answer = opinion(stack(1, 1000))
    assert [one.name for one in answer.findings] == ["penetrates"] * 2
    depths = [one.numbers["depth_mm"] for one in answer.findings]
    assert depths == pytest.approx([48] * 2, rel=0.05)
    assert opinion(stack(1, 10)).findings == ()


@pytest.mark.parametrize("shape", ["box", "ellipsoid"])
def test_bodies_at_one_place_are_found_at_the_start(shape):
    """Twice the half size of 100 mm, whatever MuJoCo makes of them."""
    geom = f'type="{shape}" size=".1 .1 .1" mass="1"'
    bodies = "".join(free(name, geom, "0 0 .5") for name in ("one", "two"))
    answer = opinion(mjcf(FLOOR + bodies)).findings
    (start,) = [one for one in answer if "at the start" in one.sentence]
    assert (start.name, start.cause[:9]) == ("penetrates", "one/two: ")
    assert start.numbers["depth_mm"] == pytest.approx(200, rel=1e-6)


def test_a_rod_through_a_box_that_mujoco_lists_no_contact_of_is_found():
    """It goes out across itself and an edge: by its radius, and by the box along that normal."""
    half, radius = np.array([0.1, 0.05, 0.2]), 0.01
    rod = f'type="capsule" size="{radius} .3" quat=".84 -.154 -.261 .45"'
    box = f'type="box" size="{" ".join(map(str, half))}"'
    model = model_of(mjcf(free("rod", rod, "0 0 .5") + free("box", box, "0 0 .5")))
    data = settled(model, 0.0)
    answer = qr.mujoco_opinion(model, data)
    assert answer.contacts == ()
    finding = answer.findings[0]
    mujoco.mj_forward(model, data)
    across = np.cross(data.geom_xmat[0].reshape(3, 3)[:, 2], np.eye(3))
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    depth = (np.abs(across) @ half).min() + radius
    assert finding.cause.startswith(
        "rod/box: rod and box overlap by 64.1 mm now, without a contact"
    )
    assert finding.numbers["depth_mm"] == pytest.approx(1e3 * depth)


def test_bodies_that_may_overlap_are_not_found():
    """By MuJoCo's own filters: excluded, of other groups of contacts, or one the other's parent."""
    body = '<body name="{}" pos="0 0 .1"><freejoint/><geom type="box" size=".1 .1 .1" {}/></body>'
    two = body.format("b", "") + body.format("c", 'contype="2" conaffinity="2"')
    assert {one.name for one in opinion(mjcf(two), 0.0).findings} == {"moving"}  # they fall
    two = body.format("b", "") + body.format("c", "")
    exclude = '<contact><exclude body1="b" body2="c"/></contact>'
    assert {one.name for one in opinion(mjcf(two, exclude), 0.0).findings} == {"moving"}


@pytest.mark.parametrize("cone", ["elliptic", "pyramidal"])
@pytest.mark.parametrize(
    ("seconds", "mu", "slope"), [(0.2, 0.3, 0.45), (0.5, 0.5, 0.6), (1, 0.2, 0.3), (2, 0.6, 0.62)]
)
def test_a_box_that_slides_and_hops_has_the_share_that_its_friction_holds(seconds, mu, slope, cone):
    """It is mu over slope, though it touches in a quarter of MuJoCo's steps, with some corners.

    MuJoCo's mean force along the normal is m g cos: but for the momentum of a hop.
    """
    down = GRAVITY / np.hypot(1.0, slope)
    gravity = f'<option gravity="{slope * down} 0 {-down}" cone="{cone}"/>'
    box = f'type="box" size=".1 .1 .1" mass="1" friction="{mu}"'
    floor = f'<geom type="plane" size="5 5 .1" friction="{mu}"/>'
    scene = f"<mujoco>{gravity}<worldbody>{floor}{free('box', box, '0 0 .1')}</worldbody></mujoco>"
    said = opinion(scene, seconds)
    (slides,) = said.findings
    assert slides.name == "slides"
    assert slides.numbers == {"share": pytest.approx(mu / slope, rel=1e-3)}
    assert sum(c.exact.normal for c in said.contacts) == pytest.approx(down, rel=1e-3)
    assert sum(c.theirs.normal for c in said.contacts) == pytest.approx(down, rel=0.3)


def test_a_ball_that_spins_and_hops_has_the_friction_that_would_hold_it():
    """0.25 N m about the normal of 9.81 N: 25.5 mm, of which it has 20."""
    rough = 'friction="1 0.02 0" condim="4"'
    floor = f'<geom type="plane" size="5 5 .1" {rough}/>'
    ball = (
        f'<body name="ball" pos="0 0 .0998"><freejoint name="f"/><geom size=".1" mass="1" {rough}/>'
    )
    motor = '<actuator><motor name="m" joint="f" gear="0 0 0 0 0 1"/></actuator>'
    scene = mjcf(f"{floor}{ball}</body>", motor, '<option cone="elliptic"/>')
    (turns,) = opinion(scene, control={"m": 0.25}).findings
    assert "25.5 mm or more would hold it" in turns.cause
    assert turns.remedy.startswith("raise the second number of friction")


SOLIDS = {"box": 3, "sphere": 1, "capsule": 2, "cylinder": 2, "ellipsoid": 3}


def drawn(seed, n):
    """Solids of five kinds, some of which slide as they fall on each other."""
    rng = np.random.default_rng(seed)
    bodies = ""
    for i in range(n):
        kind = [*SOLIDS][rng.integers(len(SOLIDS))]
        numbers = rng.uniform(0.03, 0.07, SOLIDS[kind]), rng.normal(size=4)
        size, quat = (" ".join(map(str, of.tolist())) for of in numbers)
        x, y = rng.uniform(-0.12, 0.12, 2)
        rough = f'friction="{rng.uniform(0.2, 0.8)} .01" condim="4"'
        geom = f'type="{kind}" size="{size}" quat="{quat}" {rough}'
        bodies += free(f"b{i}", geom, f"{x} {y} {0.1 + 0.6 * i / n}")
    return mjcf(FLOOR + bodies, options='<option cone="elliptic"/>')


def test_forces_of_solids_that_slide_are_those_of_iterates_that_are_all_proved():
    """Only the end of Coulomb's iteration is proved; 16 convex steps lead to it."""
    model = model_of(drawn(7, 4))
    data = settled(model, 0.24)
    answer = qr.mujoco_opinion(model, data)
    assert FELL_BACK not in answer.left_out
    step, _ = qr.mujoco_step(model, data, 0.01 * model.opt.timestep)
    proved = qr.coulomb_step(step)
    assert proved.converged
    assert proved.s_iterations > 5
    forces = [one.exact.normal for one in answer.contacts]
    assert sorted(forces) == pytest.approx(sorted(proved.wrench[:, 2]), rel=1e-6, abs=1e-6)


def test_a_body_that_falls_beside_the_scene_is_found():
    wall = '<geom type="box" pos="1 0 0" size=".1 1 1"/>'
    box = free("box", 'type="box" size=".02 .02 .02" mass=".1"', "0 0 .5")
    (finding,) = opinion(f"<mujoco><worldbody>{wall}{box}</worldbody></mujoco>", 2.0).findings
    assert finding.name == "moving"
    assert finding.numbers["speed_mm_s"] == pytest.approx(9.81e3 * 2.05, rel=0.01)


def test_a_margin_is_no_overlap():
    """A contact 0.1 mm off the floor, within margins of 2 mm."""
    floor = FLOOR.replace("/>", ' margin="0.001"/>')
    box = free("box", 'type="box" size=".03 .03 .03" margin="0.001"', "0 0 .0301")
    model = model_of(f"<mujoco><worldbody>{floor}{box}</worldbody></mujoco>")
    _, coordinates = qr.mujoco_step(model, settled(model, 0.0), 0.002)
    assert not any("penetrate" in sentence for sentence in coordinates.left_out)


def test_names_with_colons_stay_whole():
    floor = FLOOR.replace('"floor"', '"the: floor"')
    box = BOX.replace('name="box"', 'name="a: box"')
    (creep,) = opinion(mjcf(f"{floor}{FREE}{box}</body>", options=SLOPE.format("", ""))).findings
    assert creep.cause.startswith("the: floor/a: box: b slips")


@pytest.mark.parametrize("field", ["qpos", "qvel", "ctrl", "xfrc_applied"])
def test_a_state_that_is_not_finite_is_named(field):
    motor = '<actuator><motor name="v" joint="up"/></actuator>'
    model, data = posed(mjcf(f"<body>{UP}/>{BOX}</body>", motor))
    getattr(data, field).flat[-1] = np.nan
    for ask in (qr.mujoco_opinion, lambda *of: qr.mujoco_step(*of, h=0.01)):
        with pytest.raises(qr.ModelError, match=rf"data\.{field}: must contain finite numbers"):
            ask(model, data)
