"""Each element and attribute of URDF is used, listed as ignored, or refused.

The list is that of the specification; the words that the parser of pinocchio knows, read from its
library, are all in it.
"""

import re
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pinocchio as pin
import pytest

from quasistatic_ref import ModelError
from tests.files.urdf.urdf_texts import OBJ, loaded_urdf, urdf_of_text

ROBOT = """<robot name="r" version="1.1">
<material name="red"><color rgba="1 0 0 1"/><texture filename="red.png"/></material>
<transmission name="t"/><gazebo/>
<link name="a">
 <inertial><origin xyz="0.1 0 0" rpy="0.1 0 0"/><mass value="2"/>
  <inertia ixx="0.02" iyy="0.03" izz="0.04" ixy="0.001" ixz="0.002" iyz="0.003"/></inertial>
 <visual name="seen"><origin xyz="0 0 1" rpy="1 0 0"/>
  <geometry ><sphere radius="3"/></geometry><material name="red"/></visual>
 <collision name="box"><origin xyz="0 0.1 0" rpy="0 0.1 0"/>
  <geometry><box size="1 2 3"/></geometry></collision>
 <collision><geometry><sphere radius="0.4"/></geometry></collision>
 <collision><geometry><cylinder radius="0.5" length="0.6"/></geometry></collision>
 <collision><geometry><capsule radius="0.7" length="0.8"/></geometry></collision>
 <collision><geometry><mesh filename="a.obj" scale="1 1 1"/></geometry></collision>
 <collision_checking><capsule name="box"/></collision_checking>
</link>
<link name="b"/><link name="c"/><link name="d"/><link name="e"/>
<joint name="j" type="revolute"><origin xyz="0 0 0.1" rpy="0 0 0.1"/><parent link="a"/>
 <child link="b"/><axis xyz="1 0 0"/><calibration rising="0.5" falling="0.6"/>
 <dynamics damping="0.1" friction="0.2"/>
 <limit lower="-1" upper="2" effort="3" velocity="4" acceleration="5" deceleration="6" jerk="7"/>
 <safety_controller soft_lower_limit="-1" soft_upper_limit="1" k_position="2" k_velocity="3"/>
</joint>
<joint name="k" type="prismatic"><parent link="a"/><child link="c"/><axis xyz="0 0 1"/>
 <limit effort="3" velocity="4"/></joint>
<joint name="m" type="revolute"><parent link="a"/><child link="d"/><axis xyz="0 0 1"/>
 <limit effort="3" velocity="4"/><mimic joint="j" multiplier="2" offset="0.1"/></joint>
<joint name="w" type="fixed"><parent link="b"/><child link="e"/><axis xyz="0 0 1"/>
 <mimic joint="j"/></joint>
</robot>"""
LISTED = re.compile(
    r"robot\.(material|transmission|gazebo|odd)|.*\.(visual|collision_checking|calibration|dynamics"
    r"|limit|safety_controller|odd)|joint\[w\]\.(axis|mimic)"
)
"""What is listed as ignored, below its path; all else is used, or refused where it is changed."""
UNREAD = ("robot.name", "joint[w].name")
"""The first `inspect` always lists; the second, of a fixed joint, tells it from others."""


def path_of(element, above):
    """The name that sentences give to an element."""
    name = element.get("name")
    own = f"{element.tag}[{name}]" if element.tag in ("link", "joint") else element.tag
    return own if above in ("", "robot") and own != element.tag else f"{above}.{own}".lstrip(".")


def attributes(element, above=""):
    """(path, element, attribute) of each attribute of a file, and of one that no element has."""
    path = path_of(element, above)
    for name in (*element.attrib, "odd"):
        yield f"{path}.{name}", element, name
    for inner in element:
        yield from attributes(inner, path)


def changed_text(number):
    """The file with another value of its attribute of that number."""
    root = ElementTree.fromstring(ROBOT)
    _, element, name = list(attributes(root))[number]
    values = element.get(name, "odd").split()
    middle = len(values) // 2  # of an axis: its direction changes
    try:
        values[middle] = str(float(values[middle]) * 0.7 + 0.02)
    except ValueError:
        values[middle] = OTHER.get(values[middle], f"{values[middle]}x")
    element.set(name, " ".join(values))
    return ElementTree.tostring(root, "unicode")


OTHER = {"a.obj": "b.obj", "prismatic": "revolute", "revolute": "prismatic", "j": "k"}
"""Words of the file and others that it could have in their places."""
PLACES = [path for path, *_ in attributes(ElementTree.fromstring(ROBOT))]


def facts(folder, text):
    """What of a file is in the model, and what is listed; or the sentence that refuses it."""
    try:
        urdf = loaded_urdf(urdf_of_text(folder, text), actuated="all")
    except ModelError as error:
        return str(error)
    model = urdf.model
    data = model.createData()
    q = pin.integrate(model, pin.neutral(model), 0.3 * np.arange(1, model.nv + 1))
    pin.framesForwardKinematics(model, data, q)
    places = [(f.name, np.array(data.oMf[i])) for i, f in enumerate(model.frames)]
    shapes = [(s.name, s.link, s.R, s.t, s.shape.words(), s.shape) for s in urdf.shapes]
    reach = [s.shape.support_value(np.eye(3)) for s in urdf.shapes]
    known = [tuple(urdf.tree.links), list(model.names), places, shapes, reach]
    return [repr(each) for each in known] + [
        repr([inertia.matrix() for inertia in model.inertias])
    ], urdf.tree.ignored


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A folder with both meshes."""
    folder = tmp_path_factory.mktemp("robot")
    for file, size in {"a.obj": 1.0, "b.obj": 2.0}.items():
        urdf_of_text(folder, OBJ.format(size), file)
    return folder


def test_each_word_of_a_file_is_used_or_listed_or_refused(folder):
    known, _ = facts(folder, ROBOT)
    for number, place in enumerate(PLACES):
        changed = facts(folder, changed_text(number))
        if isinstance(changed, str):
            assert not LISTED.match(place), changed
            continue
        is_known, listed = changed[0] == known, changed[1]
        assert is_known == bool(LISTED.match(place) or place in UNREAD), place
        if LISTED.match(place):
            words = re.sub(r"\[[^\]]*\]|geometry\.(?=\w+\.)", "", place) + "."
            lines = [re.sub(r"\[[^\]]*\]", "", line) + "." for line in listed]
            assert any(map(words.startswith, lines)), place


def test_the_name_of_a_robot_is_listed_as_ignored(folder, cli):
    assert "- names of robots" in cli("inspect", urdf_of_text(folder, ROBOT)).out


LIBC = {"asin", "deregister_tm_clones", "frame_dummy", "memcmp", "memcpy", "sincos", "strlen",
        "strtol"}  # fmt: skip


ELSEWHERE = {"continuous", "floating", "planar", "quat_xyzw"}
"""Words of files in test_urdf_leniency.py and test_urdf_refusals.py."""


def test_no_word_of_the_parser_is_missing():
    folders = Path(pin.__file__).parents[3]
    library = min(folders.glob("liburdfdom_model.*"))
    words = re.findall(rb"(?<=\0)([a-z][a-z_]{2,})(?=\0)", library.read_bytes())
    known = {word.decode() for word in words} - LIBC
    assert {"mimic", "safety_controller"} <= known
    said = set(re.findall(r"[a-z_]+", ROBOT)) | ELSEWHERE
    assert known <= said
