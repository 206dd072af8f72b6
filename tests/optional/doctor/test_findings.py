"""Each finding of the page has a scene, and each note one that only just lacks it."""

import mujoco
import pytest

from quasistatic_ref import mujoco_scenario
from quasistatic_ref.optional.doctor.names import NAMES
from tests.meta.remedies import assert_alike, assert_among
from tests.optional.doctor.mistake_scenes import GRAVE, mistakes
from tests.optional.doctor.test_cases import ROWS

HERE = {"crossed-margin", "target-without-effect"}
"""Findings of MuJoCo scenes, which are in this file, with what ends them."""


def test_each_finding_of_the_page_has_a_scene():
    of_rows = {name for case in ROWS for name in case["hand"]}
    of_mistakes = {name for one in mistakes() for name in one["finding"]}
    assert_among(
        GRAVE,
        of_rows | of_mistakes | HERE,
        'No scene has the finding "{}": add one to tests/optional/doctor/cases/findings.toml',
    )
    assert_alike(
        GRAVE,
        NAMES,
        "{} is on docs/findings.md and not among NAMES: add it to optional/doctor/names.py",
        "{} is among NAMES of optional/doctor/names.py and not on docs/findings.md: add its row",
    )


def test_each_note_has_a_scene_that_only_just_lacks_it():
    assert_among(
        {name for name, grave in GRAVE.items() if grave is False},
        {case.get("lacks") for case in ROWS},
        'No scene only just lacks "{}": add one with lacks = "{}" to '
        "tests/optional/doctor/cases/findings.toml",
    )


def of_mujoco(world, more="", option="", **fields):
    """What is found of a MuJoCo scene."""
    text = f"<mujoco>{option}<worldbody>{world}</worldbody>{more}</mujoco>"
    made = mujoco_scenario(mujoco.MjModel.from_xml_string(text), h=0.01, **fields)
    return {one.name: one for one in made.run(progress=False).findings}


SLIDE = '<body><joint name="j" type="slide" axis="1 0 0"/><geom size="0.1"/></body>'
WITHOUT_EFFECT = {
    "its group is switched off": (
        '<option actuatorgroupdisable="3"/>', '<position joint="j" kp="9" group="3"/>',
    ),
    "a gain of zero": ("", '<general joint="j" gainprm="0"/>'),
}  # fmt: skip
WITH_EFFECT = '<position joint="j" kp="9"/>'


@pytest.mark.parametrize("why", WITHOUT_EFFECT)
def test_a_target_of_an_actuator_that_does_nothing_has_no_effect(why, tmp_path):
    option, actuator = WITHOUT_EFFECT[why]
    table = tmp_path / "targets.csv"
    table.write_text("t,0\n0,0\n0.02,1\n")
    for one, is_named in ((actuator, True), (WITH_EFFECT, False)):
        said = of_mujoco(SLIDE, f"<actuator>{one}</actuator>", option, targets=table, steps=3)
        assert ("target-without-effect" in said) is is_named


def test_the_unit_of_the_friction_that_mujoco_gives_by_default_is_said_once():
    """Of six pads of 0.6 mm."""
    pads = "".join(f'<geom size="0.0006" pos="{i / 100} 0 0"/>' for i in range(6))
    floor = '<geom type="plane" size="1 1 0.1"/>'
    world = f'{floor}<body pos="0 0 0.0006"><freejoint/>{pads}</body>'
    condim = '<default><geom condim="4"/></default>'
    unit = of_mujoco(world, option=condim, steps=1)["unit-of-mu-omega"]
    assert unit.remedy.startswith("check the unit of the second number of friction of the geoms")
    assert unit.cause.endswith("the smaller body, 0.0012 m (5 more pairs are as suspect)")


def test_each_finding_ends_where_its_remedy_is_applied():
    """By `after` of a case, by a mistake that is undone, or in this file."""
    ended = {
        name
        for case in ROWS
        for name, hand in case["hand"].items()
        if "after" in case and (len(case["hand"]) == 1 or hand.get("remedy") in case["after"])
    }
    undone = {one["finding"][0] for one in mistakes() if "remedy" in one}
    assert_among(
        GRAVE,
        ended | undone | HERE,
        'No remedy of "{}" is applied: write after."REMEDY" = { ... } into one of its cases in '
        "tests/optional/doctor/cases",
    )


@pytest.mark.parametrize(("margin", "depth"), [(0.004, [12.0]), (0.03, [])])
def test_what_comes_from_beyond_the_margin_is_said(margin, depth):
    """A ball 8 mm above the floor, which a force moves by h^2 f / m, 20 mm."""
    joint = '<joint name="z" type="slide" axis="0 0 1"/><geom size=".1" mass="1"/>'
    world = f'<geom type="plane" size="1 1 1"/><body pos="0 0 .108">{joint}</body>'
    pull = '<actuator><motor name="down" joint="z"/></actuator>'
    fields = {"targets": lambda t: {"down": -200.0}, "steps": 1, "margin": margin}
    said = of_mujoco(world, pull, '<option gravity="0 0 0"/>', **fields)
    of_margin = [one for name, one in said.items() if name == "crossed-margin"]
    assert [one.numbers["depth_mm"] for one in of_margin] == pytest.approx(depth)
