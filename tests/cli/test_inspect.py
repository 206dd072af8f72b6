"""``inspect``: what of a URDF or a scenario is used, and what is ignored."""

import json

import numpy as np
import pytest

from quasistatic_ref import load_scenario
from quasistatic_ref.cli.options import WIDTH
from quasistatic_ref.optional.doctor.time_step import time_step_record, time_step_words
from tests.closeness import assert_relative, assert_within
from tests.extras import SCENARIOS
from tests.model.urdf.urdf_texts import CHAIN, inertial, joint, link, mimic, robot, urdf_of_text
from tests.optional.doctor.words import block, slides
from tests.pages import flat
from tests.scenes import RAIL, SWING, written_scenario


@pytest.fixture
def inspected(cli):
    """What ``inspect --json`` prints of a file."""
    return lambda *arguments: json.loads(cli("inspect", *arguments, "--json").out)


def test_inspect_shows_a_urdf(tmp_path, cli, inspected):
    path = urdf_of_text(tmp_path, RAIL, "rail.urdf")
    record = inspected(path)
    assert [c["name"] for c in record["coordinates"]] == ["rail/slide", "rail/turn"]
    assert [c["unit"] for c in record["coordinates"]] == ["m", "rad"]
    assert (record["n_a"], record["n_u"]) == (2, 0)
    masses = {link["name"]: link["mass"] for link in record["links"]}
    assert masses == {"rail/rail": 2, "rail/plate": 2, "rail/wheel": 2}
    assert record["links"][1]["shapes"] == [
        {"name": "rail/plate#0", "kind": "Box", "size": "box 0.02 x 0.2 x 0.2 m"}
    ]
    assert "rail: joint limits: position, effort and velocity (2)" in record["ignored"]
    assert record["read_as"] == "a fixed base, all joints actuated"
    text = cli("inspect", path).out
    assert "read with a fixed base, all joints actuated" in text
    assert "rail/slide" in text
    assert "the model ignores:" in text


def test_inspect_does_not_call_ignored_what_the_scenario_uses(tmp_path, inspected):
    rubbed = '<dynamics damping="1" friction="2"/>'
    arm = robot(
        link("a", inertial=""), link("b"), link("c"), link("d"),
        joint("slide", "a", "b", "prismatic", more=rubbed),
        joint("under", "a", "c", "prismatic", more=rubbed + mimic("slide", 2.0)),
        joint("weld", "a", "d", "fixed", more=rubbed),
    )  # fmt: skip
    urdf_of_text(tmp_path, arm, "arm.urdf")
    lines = {}
    for friction in ('"urdf"', "{ slide = 1 }"):
        text = 'format = "quasistatic-ref/scenario"\nversion = 1\nh = 0.01\nsteps = 1\n'
        text += f'[bodies.arm]\nurdf = "arm.urdf"\njoint_friction = {friction}\n'
        path = urdf_of_text(tmp_path, text, "scene.toml")
        lines[friction] = inspected(path)["ignored"]
    assert "arm: joint friction (1)" in lines['"urdf"']  # of the weld
    assert "arm: joint friction (3)" in lines["{ slide = 1 }"]
    assert all("arm: joint damping (3)" in each for each in lines.values())


@pytest.mark.parametrize("kind", ["continuous", "ball"])
def test_bounds_of_a_joint_without_ends_are_ignored_and_named(tmp_path, kind, inspected):
    text = robot(link("a", inertial=""), link("b"), joint("j", "a", "b", kind))
    ignored = inspected(urdf_of_text(tmp_path, text))["ignored"]
    assert "r: bounds of joints that turn without end (1)" in ignored


def test_inspect_says_what_a_mimic_follows(tmp_path, cli, inspected):
    path = urdf_of_text(tmp_path, CHAIN, "arm.urdf")
    assert "\narm/swing_mimic = -0.7 * arm/swing + 0.2\n" in cli("inspect", path).out
    follows = {"name": "arm/swing_mimic", "of": "arm/swing", "multiplier": -0.7, "offset": 0.2}
    assert inspected(path)["mimics"] == [follows]


def test_inspect_shows_a_scenario(scene, cli, inspected):
    record = inspected(scene, "--set", "contacts.floor.mu_omega=0.5")
    stiffness = {c["name"]: c["K_q"] for c in record["coordinates"] if c["actuated"]}
    assert stiffness == {"rail/slide": 500, "rail/turn": 2.5}
    assert "read_as" not in record  # a scenario says how its bodies are held
    assert [pair["mu_omega"] for pair in record["pairs"]] == [0.5, 0.0]
    assert record["size"] == [8, 10]
    text = cli("inspect", scene).out
    assert "each step: 8 variables, 10 rows; h = 0.01 s" in text
    assert "500 N/m" in text
    assert "2.5 N m/rad" in text


def test_inspect_names_each_field_of_a_scenario_as_set_takes_it(scene, cli, inspected):
    fields = inspected(scene)["fields"]
    assert fields["h"] == 0.01
    numbers = {
        name: x for name, x in fields.items() if type(x) in (int, float) and name != "version"
    }
    assert any(name.startswith("contacts.floor.") for name in numbers)
    for name, value in numbers.items():
        cli("inspect", scene, "--json", "--set", f"{name}={value}")
    assert "  h = 0.01\n" in cli("inspect", scene).out


@pytest.mark.parametrize("name", SCENARIOS)
def test_what_is_inspected_fits_a_terminal(name, cli):
    assert max(map(len, cli("inspect", name).out.splitlines())) <= WIDTH


def test_inspect_names_links_that_nothing_can_touch(tmp_path, cli):
    visual = "<visual><geometry><sphere radius='1'/></geometry></visual>"
    text = robot(link("a", visual), link("b"), joint("j", "a", "b"))
    assert (
        "- one: links with visual but no collision geometry: a\n"
        in cli("inspect", urdf_of_text(tmp_path, text, "one.urdf")).out
    )


TURNED = inertial(
    moments=("0.1", "0.2", "0.25"),
    origin='<origin xyz="0.5 0.25 0.125" rpy="0 0 1.5707963267948966"/>',
)


def test_inspect_shows_inertias_along_the_axes_of_their_link(tmp_path, cli, inspected):
    """A quarter turn about z: ixx along the frame of the inertia is iyy along the link's."""
    path = urdf_of_text(tmp_path, robot(link("a", inertial=TURNED)), "one.urdf")
    (found,) = inspected(path)["links"]
    assert found["centre"] == [0.5, 0.25, 0.125]
    assert_within(np.diag(found["inertia"]), [0.2, 0.1, 0.25])
    out = cli("inspect", path).out
    assert "inertias: about the centre of mass, along the link's axes" in out
    assert "0.5 0.25 0.125" in out


def test_findings_are_listed_before_a_run(cli, inspected):
    scene = "block_push", "--set", "contacts.floor.k=1"
    printed = flat(cli("inspect", *scene).out)
    assert "findings, before a run: - raise k of contacts.floor to 4: block lies flat" in printed
    (found,) = inspected(*scene)["findings"]
    assert (found["name"], found["grave"]) == ("too few points", True)


@pytest.fixture
def record_and_words(cli, inspected):
    """What is printed of the time step, as JSON, and the whole page in one line."""
    return lambda *arguments: (
        inspected(*arguments)["time_step"],
        flat(cli("inspect", *arguments).out),
    )


def test_inspect_says_from_which_time_step_on_drag_is_small(scene, record_and_words):
    """(R13): m v / h < mu_v m g / 10 where h > 10 v / (mu_v g)."""
    record, text = record_and_words(scene)
    v, mu_v, g = 0.02 / 0.1, 0.3, 9.81  # the plate's way and time, and the smaller mu_v
    assert_relative(record["target_speed"], v)
    assert_relative(record["small_drag_from"], 10 * v / (mu_v * g))
    assert record["target_turn"] == 0.0  # the wheel turns, and touches nothing
    assert record["between_waypoints"] == 0.1
    assert "move by up to 0.2 m/s; drag is below a tenth of friction" in text
    assert "on a body's weight from h = 0.68 s on; waypoints are at least 0.1 s apart" in text
    weightless, text = record_and_words(scene, "--set", "gravity=[0,0,0]")
    assert weightless == record | {"small_drag_from": None}
    assert "drag" not in text


def pressed(depth, speed, mu_v, on="floor"):
    """A finger that wipes over a floor or a block, its target `depth` [m] inside."""
    ways = [{"t": 0.0, "x": 0.0, "z": 0.0}, {"t": 0.1, "z": -depth, "x": 0.0},
            {"t": 1.1, "x": speed, "z": -depth}]  # fmt: skip
    tables = {"rows": 4, "k": 1}
    return {
        "h": 0.01,
        "steps": 120,
        "bodies": {
            "finger": {"urdf": slides("xz", "<sphere radius='0.01'/>"), "actuated": ["x", "z"],
                       "K_q": {"x": 1e4, "z": 1e4}, "targets": ways,
                       "pose": {"xyz": [0, 0, 0.01] if on == "floor" else [1, 0, 0.03]}},
            "block": {"urdf": block(0.1, (0.02, 0.02, 0.02)), "base": "floating",
                      "pose": {"xyz": [1, 0, 0.01]}},
        },
        "shapes": {"floor": {"halfspace": {"normal": [0, 0, 1], "offset": 0}}},
        "contacts": {"wipe": {**tables, "alpha": on, "beta": "finger/tip", "mu_v": mu_v},
                     "rest": {**tables, "alpha": "floor", "beta": "block", "mu_v": 0.9}},
    }  # fmt: skip


@pytest.mark.parametrize(("depth", "speed", "mu_v"), [(0.25e-3, 0.05, 0.5), (2e-3, 0.01, 0.3)])
def test_inspect_bounds_the_time_step_by_the_layer_of_what_is_pressed(depth, speed, mu_v):
    """N = K_q (e + mu_v h v), (R13): K_q e to a tenth up to h = e / (10 mu_v v), 1 ms and 67 ms.

    A finger alone feels no drag, which would ask for 102 ms.
    """
    record = time_step_record(load_scenario(pressed(depth, speed, mu_v)))
    assert record["small_layer_to"] == pytest.approx(depth / (10 * mu_v * speed), rel=1e-9)
    assert f"up to h = {record['small_layer_to']:.3g} s" in time_step_words(record)
    alone = pressed(depth, speed, mu_v)
    del alone["bodies"]["block"], alone["contacts"]["rest"]
    assert time_step_record(load_scenario(alone)) == record | {"small_drag_from": None}
    for still in (pressed(depth, 0.0, mu_v), pressed(depth, speed, 0.0)):
        assert time_step_record(load_scenario(still))["small_layer_to"] is None


def test_what_targets_carry_bounds_the_time_step_where_it_slides_first():
    """2 mm deep at 20 mm/s: 20 ms. From then on the block may go along."""
    record = time_step_record(load_scenario(pressed(2e-3, 0.02, 0.5, on="block")))
    assert record["small_layer_to"] == pytest.approx(0.02, rel=1e-9)


def test_inspect_says_how_far_a_target_turns_in_a_step(tmp_path, record_and_words):
    """270 degrees in 10 ms and h = 2 ms: 54 degrees a step, a chord of 2 r sin(27 deg)."""
    club = str(written_scenario(tmp_path, SWING))
    record, text = record_and_words(club, "--set", "h=0.002", "--set", "steps=30")
    turn = 1.5 * np.pi / 5
    r = 0.2
    assert_relative(record["target_turn"], turn)
    assert_relative(record["target_speed"], 2 * r * np.sin(turn / 2) / 0.002)
    assert "targets turn by up to 0.9425 rad a step; waypoints are at least 0.01 s apart" in text
