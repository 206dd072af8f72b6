"""URDFs that urdfdom and pinocchio would load wrongly and silently, through the command line."""

import re

import pytest

from tests.model.urdf.urdf_texts import INERTIAL, collision, joint, link, robot, written

GOOD = robot(
    link("a", collision('<capsule radius="0.1" length="0.5"/>')),
    link("b", collision('<sphere radius="0.5"/>')),
    joint("j", "a", "b"),
)
LONG = "1" + "0" * 400
ALIKE = robot(*(link(f"l{i}") for i in range(1200)), *(
    joint(f"j{i}", f"l{i}", f"l{i + 1}") for i in range(1199)
))  # fmt: skip
PASSIVE = """
format = "quasistatic-ref/scenario"
version = 1
h = 0.01
steps = 1
[bodies.r]
urdf = "r.urdf"
base = "floating"
"""
CAUSES = {
    # name: what is replaced, by what, the field named, words of the sentence
    "a capsule without version": (' version="1.1"', "", "link[a].collision", "<capsule> needs"),
    "an unknown version": ('"1.1"', '"2.0"', "robot.version", "must be one of 1.0, 1.1, 1.2 "),
    "an unknown geometry": ("sphere", "shpere", "link[b].collision[0].shpere", "mean 'sphere'"),
    "a radius in words": ('radius="0.5"', 'radius="half"', "sphere.radius", "number (got 'half')"),
    "a radius with a comma": ('radius="0.5"', 'radius="0,5"', "sphere.radius", "(got '0,5')"),
    "a radius of many digits": ('radius="0.5"', f'radius="{LONG}"', "sphere.radius", "overflows"),
    "a negative radius": ('radius="0.5"', 'radius="-0.5"', "sphere.radius", "positive length (got"),
    "no radius": (' radius="0.5"', "", "link[b].collision[0].sphere.radius", "is missing"),
    "no inertial": (f'"b">{INERTIAL}', '"b">', "link[b].inertial", "missing, but joint 'j' moves"),
    "a mass of zero": ('value="2"', 'value="0"', "link[a].inertial.mass", "than 0 (got 0.0)"),
    "a negative mass": ('value="2"', 'value="-2"', "link[a].inertial.mass", "negative (got -2.0)"),
    "a mass beyond use": ('value="2"', 'value="1e200"', "inertial.mass.value", "at most 1e+15"),
    "an origin beyond use": ('xyz="0.1 -0.2 0.05"', 'xyz="1e300 0 0"', "origin.xyz", "at most"),
    "an inertia of no body": ('izz="0.04"', 'izz="0.4"', "link[a].inertial.inertia", "of no body"),
    "an inertia below zero": ('ixx="0.02"', 'ixx="-0.02"', "inertial.inertia", "positive definite"),
    "an axis of zero": ('"0 0 1"', '"0 0 0"', "joint[j].axis.xyz", "must not be zero (got [0.0"),
    "an axis of two": ('"0 0 1"', '"0 1"', "joint[j].axis.xyz", "must be 3 numbers (got '0 1')"),
    "a mesh that is not there": (
        '<sphere radius="0.5"/>', '<mesh filename="none.stl"/>', "link[b].collision[0]", "mesh",
    ),
    "two shapes in one": (
        '<sphere radius="0.5"/>', '<sphere radius="0.5"/><sphere radius="1"/>',
        "link[b].collision[0].geometry", "must contain exactly one shape",
    ),
    "a misspelt collision": ("<collision>", "<colision>", "link[a].colision", "mean 'collision'"),
    "a macro": ("</robot>", "<xacro:if/></robot>", "robot.xacro:if", "expand the file with xacro"),
    "a link twice": ('link name="b"', 'link name="a"', "link[a]", "is the name of two links"),
    "an unknown parent": ('parent link="a"', 'parent link="aa"', "joint[j].parent", "mean 'a'"),
    "no root": ("</robot>", joint("k", "b", "a") + "</robot>", "root link", "exactly one link"),
    "no links": (GOOD, "<robot name='r'/>", "root link", "exactly one link must not be"),
    "very many links": (GOOD, ALIKE, "robot", "holds more than 1000 links (got 1200)"),
    "an unknown joint": ("revolute", "revolut", "joint[j].type", "(got 'revolut')"),
    "no limit": ("<limit", "<limits", "joint[j].limit", "is missing: URDF asks for"),
    "a damping of words": (
        "<limit", "<dynamics damping='low'/><limit", "", "its URDF parser refuses it",
    ),
}  # fmt: skip


@pytest.mark.parametrize("cause", CAUSES)
def test_a_urdf_that_cannot_be_used_is_refused(tmp_path, refused, cause):
    old, new, field, words = CAUSES[cause]
    assert old in GOOD
    text = re.sub("<(/?)collision>", rf"<\1{new[1:]}", GOOD) if "colision" in new else None
    path = written(tmp_path, text or GOOD.replace(old, new, 1))
    # An inertia matters, and must be a body's, where a coordinate is not actuated.
    scene = tmp_path / "scene.toml"
    scene.write_text(PASSIVE)
    sentence = refused("inspect", scene if "inertia" in field else path)
    assert sentence.startswith(f"{path}: ")
    assert field in sentence
    assert words in sentence


@pytest.mark.parametrize("name", ["r.urdf", "my robot.urdf", "world.urdf", "a#b*.urdf", "µ.urdf"])
def test_a_urdf_may_have_any_name(tmp_path, capsys, name):
    from quasistatic_ref.cli.main import main

    assert main(["inspect", str(written(tmp_path, GOOD, name))]) == 0
    assert capsys.readouterr().err == ""
