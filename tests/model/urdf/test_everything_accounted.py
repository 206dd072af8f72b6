"""Each element and attribute of URDF is used, listed as ignored, or refused.

The list is that of the specification; the words that the parser of pinocchio knows, read from its
library, are all in it.
"""

import re
from pathlib import Path

import numpy as np
import pinocchio as pin
import pytest

from quasistatic_ref import ModelError
from quasistatic_ref.cli.ignored import ALWAYS
from quasistatic_ref.model.urdf.urdf import loaded_urdf
from tests.model.urdf.urdf_texts import LISTED, OBJ, REFUSED, USED, urdf_of_text

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
CHANGES = {
    # element.attribute: what stands in the file, what takes its place, with which effect
    "robot.version": ('version="1.1"', 'version="9"', REFUSED),
    "robot.material": ('<material name="red"><', '<material name="blue"><', LISTED),
    "robot.material.color": ('rgba="1 0 0 1"', 'rgba="0 0 0 1"', LISTED),
    "robot.material.texture": ("red.png", "blue.png", LISTED),
    "robot.transmission": ('transmission name="t"', 'transmission name="u"', LISTED),
    "robot.gazebo": ("<gazebo/>", "<gazebo><a/></gazebo>", LISTED),
    "link.name": ('link name="e"/>', 'link name="f"/>', REFUSED),
    "inertial.origin.xyz": ('xyz="0.1 0 0"', 'xyz="0.2 0 0"', USED),
    "inertial.origin.rpy": ('rpy="0.1 0 0"', 'rpy="0.2 0 0"', USED),
    "origin.quat_xyzw": ('rpy="0.1 0 0"', 'quat_xyzw="0 0 0 1"', USED),
    "inertial.mass.value": ('value="2"', 'value="3"', USED),
    **{
        f"inertial.inertia.{name}": (f'{name}="{value}"', f'{name}="{value}1"', USED)
        for name, value in {
            "ixx": "0.02", "iyy": "0.03", "izz": "0.04", "ixy": "0.001", "ixz": "0.002",
            "iyz": "0.003",
        }.items()
    },
    "link.visual.name": ('name="seen"', 'name="other"', LISTED),
    "link.visual.origin": ('xyz="0 0 1" rpy="1 0 0"', 'xyz="0 0 2"', LISTED),
    "link.visual.geometry": ('radius="3"', 'radius="4"', LISTED),
    "link.visual.material": ('<material name="red"/>', '<material name="pink"/>', LISTED),
    "collision.name": ('collision name="box"', 'collision name="crate"', USED),
    "collision.origin.xyz": ('xyz="0 0.1 0"', 'xyz="0 0.2 0"', USED),
    "collision.origin.rpy": ('rpy="0 0.1 0"', 'rpy="0 0.2 0"', USED),
    "collision.box.size": ("1 2 3", "1 2 4", USED),
    "collision.sphere.radius": ('radius="0.4"', 'radius="0.5"', USED),
    "collision.cylinder.radius": ('radius="0.5"', 'radius="0.6"', USED),
    "collision.cylinder.length": ('length="0.6"', 'length="0.7"', USED),
    "collision.capsule.radius": ('radius="0.7"', 'radius="0.6"', USED),
    "collision.capsule.length": ('length="0.8"', 'length="0.7"', USED),
    "collision.mesh.filename": ("a.obj", "b.obj", USED),
    "collision.mesh.scale": ('scale="1 1 1"', 'scale="1 2 1"', USED),
    "link.collision_checking": ('capsule name="box"', 'capsule name="crate"', LISTED),
    "joint.name": ('name="k"', 'name="n"', USED),
    "joint.type": ('name="k" type="prismatic"', 'name="k" type="revolute"', USED),
    "joint.floating": ('name="k" type="prismatic"', 'name="k" type="floating"', REFUSED),
    "joint.planar": ('name="k" type="prismatic"', 'name="k" type="planar"', REFUSED),
    "joint.continuous": ('name="k" type="prismatic"', 'name="k" type="continuous"', USED),
    "joint.origin.xyz": ('xyz="0 0 0.1"', 'xyz="0 0 0.2"', USED),
    "joint.origin.rpy": ('rpy="0 0 0.1"', 'rpy="0 0 0.2"', USED),
    "joint.parent.link": ('parent link="b"', 'parent link="c"', USED),
    "joint.child.link": ('child link="b"', 'child link="c"', REFUSED),
    "joint.axis.xyz": ('axis xyz="1 0 0"', 'axis xyz="0 1 0"', USED),
    "joint.calibration.rising": ('rising="0.5"', 'rising="0.6"', LISTED),
    "joint.calibration.falling": ('falling="0.6"', 'falling="0.5"', LISTED),
    "joint.dynamics.damping": ('damping="0.1"', 'damping="0.2"', LISTED),
    "joint.dynamics.friction": ('friction="0.2"', 'friction="0.3"', LISTED),
    **{
        f"joint.limit.{name}": (f'{name}="{value}"', f'{name}="{value}1"', LISTED)
        for name, value in {
            "lower": -1, "upper": 2, "effort": 3, "velocity": 4, "acceleration": 5,
            "deceleration": 6, "jerk": 7,
        }.items()
    },
    "joint.safety_controller.soft_lower_limit": ('_lower_limit="-1"', '_lower_limit="0"', LISTED),
    "joint.safety_controller.soft_upper_limit": ('_upper_limit="1"', '_upper_limit="2"', LISTED),
    "joint.safety_controller.k_position": ('k_position="2"', 'k_position="3"', LISTED),
    "joint.safety_controller.k_velocity": ('k_velocity="3"', 'k_velocity="4"', LISTED),
    "joint.mimic.joint": ('mimic joint="j" mul', 'mimic joint="k" mul', USED),
    "joint.mimic.multiplier": ('multiplier="2"', 'multiplier="3"', USED),
    "joint.mimic.offset": ('offset="0.1"', 'offset="0.2"', USED),
    "joint.axis of a fixed joint": (
        '<axis xyz="0 0 1"/>\n <mimic', '<axis xyz="0 1 0"/>\n <mimic', LISTED,
    ),
    "joint.mimic of a fixed joint": ('<mimic joint="j"/>', '<mimic joint="k"/>', LISTED),
    **{
        f"{where}.odd": (f"<{tag}", f"<{tag}".replace(word, f'{word} odd="1"', 1), effect)
        for where, word, tag, effect in (
            ("robot", "robot", 'robot name="r"', LISTED), ("link", "link", 'link name="e"', LISTED),
            ("joint", "joint", 'joint name="k"', LISTED),
            ("link.collision", "collision", 'collision name="box"', LISTED),
            ("link.collision.geometry", "geometry", "geometry>", LISTED),
            ("link.inertial", "inertial", "inertial", LISTED),
            ("link.collision.box", "box", "box", LISTED),
            ("link.inertial.origin", "origin", 'origin xyz="0.1 0 0"', LISTED),
            ("link.inertial.mass", "mass", "mass", LISTED),
            ("link.inertial.inertia", "inertia", "inertia ", LISTED),
            ("joint.parent", "parent", 'parent link="b"', LISTED),
            ("joint.mimic", "mimic", 'mimic joint="j" ', LISTED),
        )
    },
}  # fmt: skip
NAME = 'robot name="r"', 'robot name="s"'
"""`inspect` says always that it is not read."""


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
    known = [urdf.links, list(model.names), places, shapes, reach]
    return [repr(each) for each in known] + [
        repr([inertia.matrix() for inertia in model.inertias])
    ], urdf.file.ignored


@pytest.mark.parametrize("name", CHANGES)
def test_what_a_file_says_is_used_or_listed_or_refused(tmp_path, name):
    for file, size in {"a.obj": 1.0, "b.obj": 2.0}.items():
        urdf_of_text(tmp_path, OBJ.format(size), file)
    old, new, expected = CHANGES[name]
    assert old in ROBOT
    plain = facts(tmp_path, ROBOT)
    assert not isinstance(plain, str)
    found = facts(tmp_path, ROBOT.replace(old, new, 1))
    if isinstance(found, str):
        assert expected == REFUSED, found
        return
    used = found[0] != plain[0]
    assert expected == (USED if used else LISTED)
    if expected == LISTED:
        said = f"{name.partition(' ')[0]}."
        assert any(said.startswith(re.sub(r"\[[^\]]*\]", "", entry) + ".") for entry in found[1])


def test_the_name_of_a_robot_is_said_to_be_ignored(tmp_path):
    for file in ("a.obj", "b.obj"):
        urdf_of_text(tmp_path, OBJ.format(1.0), file)
    assert facts(tmp_path, ROBOT) == facts(tmp_path, ROBOT.replace(*NAME))
    assert any(line.startswith("names of robots") for line in ALWAYS)


LIBC = {"asin", "deregister_tm_clones", "frame_dummy", "memcmp", "memcpy", "sincos", "strlen",
        "strtol"}  # fmt: skip


def test_no_word_of_the_parser_is_missing():
    folders = Path(pin.__file__).parents[3]
    library = min(folders.glob("liburdfdom_model.*"))
    words = re.findall(rb"(?<=\0)([a-z][a-z_]{2,})(?=\0)", library.read_bytes())
    known = {word.decode() for word in words} - LIBC
    assert {"mimic", "safety_controller"} <= known
    said = set(re.findall(r"[a-z_]+", ROBOT + " ".join(CHANGES)))
    assert known <= said
