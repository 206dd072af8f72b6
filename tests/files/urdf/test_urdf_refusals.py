"""URDF files that cannot be used: each defect is one sentence with file, element, value."""

import pytest

from quasistatic_ref import ModelError
from tests.cases import refusal
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
BALL_MIMICS = r"\[k\].mimic: a ball joint, which has no single position, can neither mimic.*'j'"
EXPANSION = '<!DOCTYPE robot [<!ENTITY a "aaaaaaaa"><!ENTITY b "&a;&a;&a;">]>'
REFUSED = {
    # name: what is replaced in a text, by what, words of the sentence, and the text if not TWO
    "malformed": ("</robot>", "", "line 1: is not well-formed XML: no element found"),
    "another root": ("robot", "model", r"root element: must be <robot> \(got 'model'\)"),
    "doctype": ("<robot", EXPANSION + "<robot", "line 1: has a DOCTYPE"),
    "xacro": ("</robot>", "<xacro:arm/></robot>", r"robot.xacro:arm: is a macro: expand"),
    "version": ('"1.1"', '"3.0"', r"robot.version: must be one of 1.0, 1.1, 1.2.*'3.0'"),
    "mesh": (
        '<sphere radius="0.5"/>',
        '<mesh filename="a.stl"/>',
        r"link\[a\].collision\[0\].mesh.filename: no such file .*'a.stl'",
    ),
    "unknown shape": ("sphere", "spehre", "spehre: is not a shape; did you mean 'sphere'"),
    "no shape": ('<sphere radius="0.5"/>', "", "geometry: must contain exactly one shape"),
    "misspelt collision": ("collision", "colision", "a].colision: is unknown; did you mean"),
    "negative radius": ('"0.5"', '"-1"', "sphere.radius: must be a positive length.*'-1'"),
    "tailed radius": ('"0.5"', '"0.5m"', "sphere.radius: must be a finite decimal.*'0.5m'"),
    "long radius": ('"0.5"', f'"1{400 * "0"}"', "sphere.radius:.*overflows"),
    "two sizes": ('<sphere radius="0.5"/>', '<box size="1 2"/>', "box.size: must be 3 num"),
    "negative mass": ('<mass value="2"/>', '<mass value="-2"/>', r"negative \(got -2\.0"),
    "mass of no use": ('value="2"', 'value="1e200"', "inertial.mass.value: .*at most 1e"),
    "indefinite": ('ixx="0.02"', 'ixx="-0.02"', "inertia: must be positive definite"),
    "two moments in one": (
        'ixy="0.001"', 'ixy="0.001" iyx="0.002"', "inertia.iyx: must equal ixy, the same mom",
    ),
    "zero axis": ('"0 0 1"', '"0 0 0"', r"joint\[j\].axis.xyz: must not be zero"),
    "degrees": ("<limit", '<origin rpy_deg="0 0 90"/><limit', "origin.rpy_deg: is unknown"),
    "floating": ("revolute", "floating", 'not supported.*base = "floating"'),
    "planar": ("revolute", "planar", 'not supported.*base = "planar"'),
    "macro in a path": (
        '<sphere radius="0.5"/>',
        '<mesh filename="$(arg folder)/tip.stl"/>',
        r"mesh.filename: holds a macro: expand the file with xacro first .*'\$\(arg folder\)/tip",
    ),
    "macro in a number": ('"0.5"', '"${radius}"', "sphere.radius: holds a macro: expand"),
    "wheel at a half": ("RATIO", "-0.5", r"\[k\].mimic.multiplier: must be a whole.*-0.5", WHEELS),
    "wheel at a third": ("RATIO", "0.3333", 'write type="revolute" with limits for both', WHEELS),
    "no link": (TWO, "<robot name='r'/>", "robot: has no <link>"),
    "no name": (' name="r"', "", r"robot\.name: is missing"),
    "no type": ('type="revolute"', "", r"joint\[j\].type: is missing"),
    "no limit": ("<limit", "<bound", r"joint\[j\].limit: is missing: URDF requires effort"),
    "bad upper": ('upper="1"', 'upper="one"', r"\[j\].limit.upper: must be a finite.*'one'"),
    "two links": ('link name="b"', 'link name="a"', r"link\[a\]: is the name of two links"),
    "unknown parent": ('parent link="a"', 'parent link="aa"', r"parent: is not a link; did"),
    "two parents": (
        "</robot>", joint("l", "a", "c") + "</robot>",
        r"joint\[l\].child: is already the child of joint 'k'; name another \(got 'c'\)", THREE,
    ),
    "two roots": ("</robot>", link("d") + "</robot>", "root link: exactly one link must", THREE),
    "a loop aside": (
        "</robot>",
        link("c") + link("d") + joint("l", "c", "d") + joint("m", "d", "c") + "</robot>",
        r"tree: must connect these joints to the root link 'a' \(got \['l', 'm'\]\)",
    ),
    "a ball that mimics": (
        "RATIO", "1", BALL_MIMICS, WHEELS.replace('"k" type="continuous"', '"k" type="ball"'),
    ),
    "a ball that is mimicked": (
        "RATIO", "1", BALL_MIMICS, WHEELS.replace('"j" type="continuous"', '"j" type="ball"'),
    ),
    "a very long name": (
        'name="a"', f'name="{"a" * 10_000}"', r"link.name: is longer than 4000 characters",
    ),
    "mimics what it moves": (
        "</joint>", mimic("j") + "</joint>",
        r"joint\[k\].mimic: k moves j, so let j mimic k .*'j'",
        robot(*map(link, "abc"), joint("k", "a", "b"), joint("j", "b", "c")),
    ),
    "mimics both ways round": (
        "</joint></robot>", mimic("i") + "</joint></robot>",
        r"joints: .* mimic joints that the others move, both ways round \(got \['i', 'k'\]\)",
        robot(
            *map(link, "abcde"), joint("i", "a", "b"), joint("j", "b", "c", more=mimic("k")),
            joint("k", "a", "d"), joint("l", "d", "e"),
        ),
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", REFUSED)
def test_a_defect_is_one_sentence_that_names_the_file(tmp_path, name):
    old, new, words, text = (*REFUSED[name], TWO)[:4]
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
