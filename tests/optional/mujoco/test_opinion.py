"""Second opinions: scenes of the guide, healthy ones, and states that statics decides by hand."""

import json
from pathlib import Path

import numpy as np
import pytest
from jsonschema import Draft4Validator

import quasistatic_ref as qr
from quasistatic_ref.optional.mujoco.settled import settled
from tests.helpers import one_sentence
from tests.optional.mujoco.models import GRAVITY, mjcf, model_of, posed
from tests.optional.rows import assert_found, params, rows_of
from tests.pages import ROOT, downloads, flat, printed_blocks

PAGE = (ROOT / "docs/guides/does_my_contact_hold.md").read_text("utf-8")
SCENES = downloads("opinion")
OPINIONS = rows_of("mujoco/opinions.toml")


def opinion(text, seconds=2.0, keyframe=None, control=None):
    """The opinion on a scene that has settled, which knows where it started."""
    model = model_of(text)
    start = settled(model, 0.0, keyframe, control)
    return qr.mujoco_opinion(model, settled(model, seconds, keyframe, control), start=start)


@pytest.mark.parametrize("row", params(OPINIONS))
def test_an_opinion_has_the_findings_and_forces_of_statics(row):
    text = row.get("mjcf") or SCENES[row["page"]]
    for old, new in row.get("replace", {}).items():
        assert old in text
        text = text.replace(old, new)
    answer = opinion(text, row.get("seconds", 2.0), row.get("keyframe"), row.get("control"))
    assert_found(answer.findings, row["hand"])
    notes = " ".join(answer.left_out)
    noted = row.get("noted", "")
    assert noted in notes
    assert ("not unique" in notes) is ("not unique" in noted)
    assert row.get("touches", bool(answer.contacts)) is bool(answer.contacts)
    if "rests" in row:
        assert all(body.balanced and body.rests for body in answer.bodies)
    if "normal" in row:
        value, off = row["normal"]
        exact = sum(contact.exact.normal for contact in answer.contacts)
        assert exact == pytest.approx(value, rel=off)


def test_the_number_of_a_creep_is_the_slip_of_its_joint_in_mujoco():
    (row,) = (one for one in OPINIONS if one["what"].startswith("a block on a soft floor"))
    when = row["seconds"], row["keyframe"]
    (creep,) = opinion(row["mjcf"], *when).findings
    slip = settled(model_of(row["mjcf"]), *when).qvel[0]
    assert creep.numbers == {"slip_mm_s": pytest.approx(1e3 * slip)}


def torsional_fingers(text):
    """A scene whose fingertips have torsional friction."""
    return text.replace('condim="3"', 'condim="4"')


GUIDE = {
    "capsule": (SCENES["capsule.xml"], 2, "grip"),
    "mug": (SCENES["mug.xml"], 0, "grip"),
    "mug, condim 4": (torsional_fingers(SCENES["mug.xml"]), 2, "grip"),
    "mug, condim 4, weak": (
        torsional_fingers(SCENES["mug.xml"]),
        0,
        "grip",
        {"left": 0.001, "right": 0.001},
    ),
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


@pytest.mark.usefixtures("compiled_here")
def test_the_command_prints_json_of_the_schema_and_ends_with_1(tmp_path, cli):
    (tmp_path / "block.xml").write_text(SCENES["block.xml"])
    command = "opinion", tmp_path / "block.xml", "--settle 0.5"
    record = json.loads(cli(*command, "--json", status=1).out)
    schema = json.loads(cli("schema opinion").out)
    Draft4Validator.check_schema(schema)
    Draft4Validator(schema).validate(record)
    assert [one["name"] for one in record["findings"]] == ["creeps"]
    assert "no finding" in cli(*command, "--tolerance 0.01").out


def sliding(mu, slope, cone="pyramidal"):
    """A box of 1 kg on a floor, along which a part of the gravity points."""
    down = GRAVITY / np.hypot(1.0, slope)
    gravity = f'<option gravity="{slope * down} 0 {-down}" cone="{cone}"/>'
    geoms = f'<default><geom friction="{mu}"/></default>'
    box = '<geom name="box" type="box" size=".1 .1 .1" mass="1"/>'
    free = f'<body name="box" pos="0 0 .1"><freejoint/>{box}</body>'
    return mjcf('<geom type="plane" size="5 5 .1"/>' + free, options=gravity + geoms), down


@pytest.mark.usefixtures("compiled_here")
def test_the_command_looks_at_the_end_of_settling(tmp_path, cli):
    """A box slides with g (sin - mu cos): in the last 0.1 s of 1 s its speed is that at 0.95 s."""
    scene = tmp_path / "slope.xml"
    text, down = sliding(0.3, 0.45)
    scene.write_text(text)
    (body,) = json.loads(cli("opinion", scene, "--settle 1 --json", status=1).out)["bodies"]
    assert body["theirs"]["speed"] == pytest.approx(0.95 * down * (0.45 - 0.3), rel=0.05)


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


@pytest.mark.parametrize("cone", ["elliptic", "pyramidal"])
@pytest.mark.parametrize(
    ("seconds", "mu", "slope"), [(0.2, 0.3, 0.45), (0.5, 0.5, 0.6), (1, 0.2, 0.3), (2, 0.6, 0.62)]
)
def test_a_box_that_slides_and_hops_has_the_share_that_its_friction_holds(seconds, mu, slope, cone):
    """It is mu over slope, though it touches in a quarter of MuJoCo's steps, with some corners.

    MuJoCo's mean force along the normal is m g cos: but for the momentum of a hop.
    """
    text, down = sliding(mu, slope, cone)
    said = opinion(text, seconds)
    (slides,) = said.findings
    assert slides.name == "slides"
    assert slides.numbers == {"share": pytest.approx(mu / slope, rel=1e-3)}
    assert sum(c.exact.normal for c in said.contacts) == pytest.approx(down, rel=1e-3)
    assert sum(c.theirs.normal for c in said.contacts) == pytest.approx(down, rel=0.3)


def test_forces_of_solids_that_slide_are_those_of_iterates_that_are_all_proved():
    """Only the end of Coulomb's iteration is proved; 16 convex steps lead to it."""
    model = model_of(Path(__file__).with_name("falling_solids.xml").read_text("utf-8"))
    data = settled(model, 0.24)
    answer = qr.mujoco_opinion(model, data)
    assert "no solution of Coulomb's law" not in " ".join(answer.left_out)
    step, _ = qr.mujoco_step(model, data, 0.01 * model.opt.timestep)
    proved = qr.coulomb_step(step)
    assert proved.converged
    assert proved.s_iterations > 5
    forces = [one.exact.normal for one in answer.contacts]
    assert sorted(forces) == pytest.approx(sorted(proved.wrench[:, 2]), rel=1e-6, abs=1e-6)


def test_a_margin_is_no_overlap():
    """A contact 0.1 mm off the floor, within margins of 2 mm."""
    default = '<default><geom margin=".001"/></default>'
    box = '<body pos="0 0 .0301"><freejoint/><geom type="box" size=".03 .03 .03"/></body>'
    model = model_of(mjcf('<geom type="plane" size="5 5 1"/>' + box, options=default))
    step, coordinates = qr.mujoco_step(model, settled(model, 0.0), 0.002)
    assert step.contacts.n_c == 4
    assert not any("penetrate" in sentence for sentence in coordinates.left_out)


@pytest.mark.parametrize("field", ["qpos", "qvel", "ctrl", "xfrc_applied"])
def test_a_state_that_is_not_finite_is_named(field):
    motor = '<actuator><motor name="v" joint="up"/></actuator>'
    body = '<body><joint name="up" type="slide"/><geom size=".1"/></body>'
    model, data = posed(mjcf(body, motor))
    getattr(data, field).flat[-1] = np.nan
    for ask in (qr.mujoco_opinion, lambda *of: qr.mujoco_step(*of, h=0.01)):
        with pytest.raises(qr.ModelError, match=rf"data\.{field}: must contain finite numbers"):
            ask(model, data)
