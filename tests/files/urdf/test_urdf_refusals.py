"""URDF files that cannot be used: each defect is one sentence with file, element, value."""

import pytest

from quasistatic_ref import ModelError
from tests.cases import cases, refusal
from tests.files.urdf.urdf_texts import (
    CHAIN,
    collision,
    joint,
    link,
    loaded_urdf,
    mimic,
    robot,
    urdf_of_text,
)

TWO = robot(link("a", collision('<sphere radius="0.5"/>')), link("b"), joint("j", "a", "b"))
THREE = robot(
    link("a"), link("b"), link("c"), joint("j", "a", "b"), joint("k", "b", "c", more=mimic("j"))
)
WHEELS = robot(
    link("a"), link("b"), link("c"), joint("j", "a", "b", "continuous"),
    joint("k", "a", "c", "continuous", more='<mimic joint="j" multiplier="RATIO"/>'),
)  # fmt: skip
"""A wheel that follows another at a ratio that is written in the place of RATIO."""
EXPANSION = '<!DOCTYPE robot [<!ENTITY a "aaaaaaaa"><!ENTITY b "&a;&a;&a;">]>'
REFUSED = {
    # name: text, what is replaced, by what, words of the sentence
    "malformed": (TWO, "</robot>", "", "line 1: is not well-formed XML: no element found"),
    "another root": (TWO, "robot", "model", r"root element: must be <robot> \(got 'model'\)"),
    "doctype": (TWO, "<robot", EXPANSION + "<robot", "line 1: has a DOCTYPE"),
    "xacro": (TWO, "</robot>", "<xacro:arm/></robot>", r"robot.xacro:arm: is a macro: expand"),
    "version": (TWO, '"1.1"', '"3.0"', r"robot.version: must be one of 1.0, 1.1, 1.2.*'3.0'"),
    "mesh": (
        TWO,
        '<sphere radius="0.5"/>',
        '<mesh filename="a.stl"/>',
        r"link\[a\].collision\[0\].mesh.filename: no such file .*'a.stl'",
    ),
    "unknown shape": (TWO, "sphere", "spehre", "spehre: is not a shape; did you mean 'sphere'"),
    "no shape": (TWO, '<sphere radius="0.5"/>', "", "geometry: must contain exactly one shape"),
    "misspelt collision": (TWO, "collision", "colision", "a].colision: is unknown; did you mean"),
    "negative radius": (TWO, '"0.5"', '"-1"', "sphere.radius: must be a positive length.*'-1'"),
    "tailed radius": (TWO, '"0.5"', '"0.5m"', "sphere.radius: must be a finite decimal.*'0.5m'"),
    "long radius": (TWO, '"0.5"', f'"1{400 * "0"}"', "sphere.radius:.*overflows"),
    "two sizes": (TWO, '<sphere radius="0.5"/>', '<box size="1 2"/>', "box.size: must be 3 num"),
    "negative mass": (TWO, '<mass value="2"/>', '<mass value="-2"/>', r"negative \(got -2\.0"),
    "mass of no use": (TWO, 'value="2"', 'value="1e200"', "inertial.mass.value: .*at most 1e"),
    "indefinite": (TWO, 'ixx="0.02"', 'ixx="-0.02"', "inertia: must be positive definite"),
    "two moments in one": (
        TWO, 'ixy="0.001"', 'ixy="0.001" iyx="0.002"', "inertia.iyx: must equal ixy, the same mom",
    ),
    "zero axis": (TWO, '"0 0 1"', '"0 0 0"', r"joint\[j\].axis.xyz: must not be zero"),
    "degrees": (TWO, "<limit", '<origin rpy_deg="0 0 90"/><limit', "origin.rpy_deg: is unknown"),
    "floating": (TWO, "revolute", "floating", 'not supported.*base = "floating"'),
    "planar": (TWO, "revolute", "planar", 'not supported.*base = "planar"'),
    "macro in a path": (
        TWO,
        '<sphere radius="0.5"/>',
        '<mesh filename="$(arg folder)/tip.stl"/>',
        r"mesh.filename: holds a macro: expand the file with xacro first .*'\$\(arg folder\)/tip",
    ),
    "macro in a number": (TWO, '"0.5"', '"${radius}"', "sphere.radius: holds a macro: expand"),
    "wheel at a half": (WHEELS, "RATIO", "-0.5", r"\[k\].mimic.multiplier: must be a whole.*-0.5"),
    "wheel at a third": (WHEELS, "RATIO", "0.3333", 'write type="revolute" with limits for both'),
    "no type": (TWO, 'type="revolute"', "", r"joint\[j\].type: is missing"),
    "no limit": (TWO, "<limit", "<bound", r"joint\[j\].limit: is missing: URDF requires effort"),
    "bad upper": (TWO, 'upper="1"', 'upper="one"', r"\[j\].limit.upper: must be a finite.*'one'"),
    "two links": (TWO, 'link name="b"', 'link name="a"', r"link\[a\]: is the name of two links"),
    "unknown parent": (TWO, 'parent link="a"', 'parent link="aa"', r"parent: is not a link; did"),
    "two parents": (
        THREE,
        "</robot>",
        joint("l", "a", "c") + "</robot>",
        r"joint\[l\].child: is already the child of joint 'k'; name another \(got 'c'\)",
    ),
    "two roots": (THREE, "</robot>", link("d") + "</robot>", "root link: exactly one link must"),
    "a loop aside": (
        TWO,
        "</robot>",
        link("c") + link("d") + joint("l", "c", "d") + joint("m", "d", "c") + "</robot>",
        r"tree: must connect these joints to the root link 'a' \(got \['l', 'm'\]\)",
    ),
    "a ball that mimics": (
        WHEELS.replace('"k" type="continuous"', '"k" type="ball"'), "RATIO", "1",
        r"\[k\].mimic: a ball joint, which has no single position, can neither mimic.*'j'",
    ),
    "a ball that is mimicked": (
        WHEELS.replace('"j" type="continuous"', '"j" type="ball"'), "RATIO", "1",
        r"\[k\].mimic: a ball joint, which has no single position, can neither mimic.*'j'",
    ),
    "a very long name": (
        TWO, 'name="a"', f'name="{"a" * 10_000}"', r"link.name: is longer than 4000 characters",
    ),
    "mimics what it moves": (
        robot(link("a"), link("b"), link("c"), joint("k", "a", "b"), joint("j", "b", "c")),
        "</joint>",
        mimic("j") + "</joint>",
        r"joint\[k\].mimic: is a joint that this one moves; let that one mimic this one .*'j'",
    ),
    "mimics both ways round": (
        robot(
            *map(link, "abcde"), joint("i", "a", "b"), joint("j", "b", "c", more=mimic("k")),
            joint("k", "a", "d"), joint("l", "d", "e"),
        ),
        "</joint></robot>",
        mimic("i") + "</joint></robot>",
        r"joints: .* mimic joints that the others move, both ways round \(got \['i', 'k'\]\)",
    ),
}  # fmt: skip


@cases("text, old, new, words", REFUSED)
def test_a_defect_is_one_sentence_that_names_the_file(tmp_path, text, old, new, words):
    assert old in text
    count = -1 if old in ("robot", "collision") else 1
    path = urdf_of_text(tmp_path, text.replace(old, new, count))
    with refusal(ModelError, f"{path}: ", words):
        loaded_urdf(path, base="floating")  # so that the root's inertia matters


OLDER = CHAIN.replace(' version="1.1"', "")


@pytest.mark.parametrize("text", [TWO, THREE, CHAIN, OLDER])
def test_the_texts_are_good_before_they_are_spoilt(tmp_path, text):
    assert loaded_urdf(urdf_of_text(tmp_path, text)).tree.links


def test_a_joint_named_base_cannot_float(tmp_path):
    path = urdf_of_text(tmp_path, TWO.replace('name="j"', 'name="base"'))
    assert tuple(loaded_urdf(path).tree.links) == ("a", "b")
    with pytest.raises(ModelError, match=r"joint\[base\]: this name is taken by the floating base"):
        loaded_urdf(path, base="floating")
