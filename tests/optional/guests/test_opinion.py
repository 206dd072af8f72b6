"""Second opinions: the scenes of the guide, healthy scenes, and what is a finding by a formula."""

import json

import mujoco
import numpy as np
import pytest
from jsonschema import Draft4Validator

import quasistatic_ref as qr
from quasistatic_ref.lab.commands.schema import opinion_schema
from quasistatic_ref.optional.guests.settled import settled
from tests.helpers import one_sentence
from tests.pages import ROOT, downloads, flat, printed_blocks

PAGE = (ROOT / "docs/guides/does_my_contact_hold.md").read_text("utf-8")
NOSLIP = 'impratio="10" noslip_iterations="10"'
WEAK = {"left": 0.001, "right": 0.001}
GRAVITY = 9.81


def opinion_on_settled(text, seconds, keyframe=None, control=None):
    """The opinion on a scene that has settled."""
    model = mujoco.MjModel.from_xml_string(text)
    return qr.second_opinion(model, settled(model, seconds, keyframe, control))


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
    return {name: opinion_on_settled(*arguments) for name, arguments in GUIDE.items()}


def test_the_guide_shows_what_is_found(opinions):
    shown = (opinions[name] for name in ("capsule", "mug"))
    sentences = [f"- {one.sentence}" for opinion in shown for one in opinion.findings]
    assert [flat(block) for block in printed_blocks(PAGE)] == sentences


def test_what_is_asked_for_and_could_be_borne_is_that_of_statics(opinions):
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
    assert opinion_on_settled(slower, 2, "grip").findings == ()
    slower = torsional_fingers(SCENES["mug.xml"]).replace('impratio="100"', NOSLIP)
    assert opinion_on_settled(slower, 2, "grip").findings == ()


@pytest.mark.parametrize("normal", [0.5, 1.0, 1.2])
def test_a_grip_holds_the_share_of_the_weight_that_its_friction_bears(normal):
    """2 mu N of m g, N = kp (control - position)."""
    control = dict.fromkeys(WEAK, normal / 1000 + 0.0001)
    opinion = opinion_on_settled(torsional_fingers(SCENES["mug.xml"]), 0, "grip", control)
    (finding,) = opinion.findings
    assert finding.name == "slides"
    share = 2 * 0.8 * normal / (0.3 * GRAVITY)
    assert finding.numbers == {"share": pytest.approx(share, rel=0.02)}


def free(name, geom, at):
    """A body that is free, of one geom."""
    return f'<body name="{name}" pos="{at}"><freejoint/><geom name="{name}" {geom}/></body>'


BOX = 'type="box" size=".05 .06 .04"'
HEALTHY = {
    "capsule": free("rod", 'type="capsule" size=".02 .1" euler="0 90 0"', "0 0 .02"),
    "three boxes": "".join(free(f"b{i}", BOX, f"0 0 {0.04 + 0.08 * i}") for i in range(3)),
    "plank": free("a", BOX, "-.2 0 .04") + free("b", BOX, ".2 0 .04")
    + free("c", 'type="box" size=".3 .05 .01"', "0 0 .09"),
    "heavy on light": free("a", f'{BOX} mass=".1"', "0 0 .04")
    + free("b", f'{BOX} mass="2"', "0 0 .12"),
    "a door on its limit": free("box", BOX, "0 0 .04")
    + '<body pos="1 0 1"><joint axis="0 1 0" range="-20 20" damping=".5"/>'
    '<geom type="box" size=".2 .2 .01" pos=".2 0 0" mass="1"/></body>',
    "a box that is pushed": free("box", BOX, "0 0 .04")
    + '<body pos="-.1 0 .03"><joint name="x" type="slide" axis="1 0 0" damping="50"/>'
    '<geom size=".03" mass=".2"/></body>',
}  # fmt: skip
"""Chosen before there were findings."""
PUSH = '<actuator><position name="x" joint="x" kp="100"/></actuator>'


@pytest.mark.parametrize("name", HEALTHY)
def test_a_healthy_scene_has_no_finding(name):
    world = f'<geom name="floor" type="plane" size="5 5 1"/>{HEALTHY[name]}'
    pushed = "pushed" in name
    options = f'<option cone="elliptic" impratio="100"/>{PUSH if pushed else ""}'
    text = f"<mujoco>{options}<worldbody>{world}</worldbody></mujoco>"
    opinion = opinion_on_settled(text, 2, None, {"x": 0.025} if pushed else None)
    assert opinion.contacts
    assert opinion.findings == ()


def test_bodies_in_each_other_are_found_with_their_depth_and_forces():
    """A box of 1 kg/dm^3 that begins 5 mm deep, its weight by hand."""
    world = f'<geom name="floor" type="plane" size="5 5 1"/>{free("box", BOX, "0 0 .035")}'
    opinion = opinion_on_settled(f"<mujoco><worldbody>{world}</worldbody></mujoco>", 0)
    (finding,) = opinion.findings
    assert (finding.name, finding.numbers) == ("penetrates", {"depth_mm": pytest.approx(5.0)})
    weight = 1000 * 0.1 * 0.12 * 0.08 * GRAVITY
    assert "box and world penetrate by 5 mm, and are pushed apart with" in finding.cause
    assert f"their loads ask for {weight:.3g} N" in finding.cause
    assert "contact/exclude" in finding.remedy


def test_what_rests_by_rolling_friction_alone_is_found():
    """A ball on a slope of 3 degrees; the exact step has no row for rolling."""
    g = f"{GRAVITY * np.sin(0.05)} 0 {-GRAVITY * np.cos(0.05)}"
    rolls = 'condim="6" friction="1 .1 .1"'
    world = f'<geom name="floor" type="plane" size="5 5 1" {rolls}/>' + free(
        "ball", f'size=".1" {rolls}', "0 0 .1"
    )
    options = f'<option gravity="{g}" cone="elliptic" {NOSLIP}/>'
    opinion = opinion_on_settled(f"<mujoco>{options}<worldbody>{world}</worldbody></mujoco>", 2)
    (finding,) = opinion.findings
    assert (finding.name, "ball rests in MuJoCo" in finding.cause) == ("moves", True)
    assert "rolling friction" in finding.remedy


def test_the_command_prints_json_of_the_schema_draws_and_ends_with_1(tmp_path, cli):
    scene = tmp_path / "block.xml"
    scene.write_text(SCENES["block.xml"])
    command = ["opinion", str(scene), "--settle", "0.5", "--json", "--out", str(tmp_path / "out")]
    record = json.loads(cli(*command, status=1).out)
    Draft4Validator.check_schema(opinion_schema())
    Draft4Validator(opinion_schema()).validate(record)
    assert [one["name"] for one in record["findings"]] == ["creeps"]
    made = {path.name: path.stat().st_size for path in (tmp_path / "out").iterdir()}
    assert {*made} == {"opinion.png", "opinion.pdf", "opinion.json"}
    assert min(made.values()) > 1000
    assert "no finding" in cli(*command[:4], "--tolerance", "0.01").out


REFUSED = {
    "joint[x].springyield": [],
    "keyframe": ["--keyframe", "gripp"],
    "actuator": ["--control", "left=1"],
    "--control": ["--control", "left"],
    "--control v": ["--control", "v=nan"],
    "tolerance": ["--tolerance", "0"],
    "settle": ["--settle", "-1"],
}


@pytest.mark.parametrize("named", REFUSED)
def test_what_cannot_be_asked_ends_with_2_and_is_named(named, tmp_path, cli):
    field = 'stiffness="1" springyield="1"' if "yield" in named else ""
    scene = tmp_path / "scene.xml"
    body = f'<body><joint name="x" {field}/><geom size=".1"/></body>'
    scene.write_text(f"<mujoco><worldbody>{body}</worldbody></mujoco>")
    assert f"{named}:" in one_sentence(cli("opinion", scene, *REFUSED[named], status=2).err)


def test_a_simulation_that_is_unstable_is_refused():
    text = SCENES["capsule.xml"].replace('impratio="1"', 'timestep="0.2"')
    with pytest.raises(qr.ModelError, match=r"option\.timestep: is too large"):
        opinion_on_settled(text, 20, "grip")


def test_a_body_that_slips_because_it_turns_is_asked_for_a_force():
    """A capsule on its end, held by a soft weld: its one contact has no torque to bear."""
    text = """<mujoco><worldbody>
    <geom type="plane" size="1 1 .1"/>
    <body name="box" pos="0 0 0.051"><freejoint/>
      <geom type="box" size=".05 .05 .05" mass="0.5"/></body>
    <body name="cap" pos="0.3 0 0.12"><freejoint/>
      <geom type="capsule" size=".03 .1" mass="0.2" friction="0.1"/></body></worldbody>
    <equality><weld body1="box" body2="cap"/></equality></mujoco>"""
    (finding,) = [one for one in opinion_on_settled(text, 2).findings if one.name == "creeps"]
    assert "N mm" not in finding.sentence
