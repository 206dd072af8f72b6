"""What pinocchio or other readers read of a URDF is read, and what was ignored is noted."""

import numpy as np
import pytest

from quasistatic_ref import ModelError
from tests.cases import cases
from tests.closeness import assert_within
from tests.files.urdf.urdf_texts import INERTIAL, collision, link, loaded_urdf, robot, urdf_of_text

LIMIT = '<limit lower="-1" upper="1" effort="1" velocity="1"/>'
J = f'<joint name="j" type="revolute"><parent link="a"/><child link="b"/>{LIMIT}</joint>'
K = J.replace('"b"', '"c"').replace('"a"', '"b"').replace('"j"', '"k"')
MIMIC = K.replace("</joint>", '<mimic joint="j" multiplier="-1"/></joint>')
LINKS = '<link name="a"/><link name="b"/><link name="c"/>'
CAMERA = '<gazebo><sensor:camera name="c"/></gazebo>'


def loaded(urdf):
    return loaded_urdf(urdf, actuated="all")


BARE = '<inertial><mass value="1.0"/></inertial>'


def test_a_mass_without_inertia_loads_where_nothing_needs_it_and_is_noted():
    """In a fixed base, or what an actuator moves; it counts as a weight."""
    links = LINKS.replace('<link name="a"/>', link("a", inertial=BARE))
    links = links.replace('<link name="b"/>', link("b", inertial=BARE))
    urdf = loaded(f'<robot name="r">{links}{J}{K}</robot>')
    said = [f"link[{name}].inertial.inertia: is missing; accepted, because no un-actuated joint "
            "moves this link" for name in "ab"]  # fmt: skip
    assert [note for note in urdf.notes if "inertial" in note] == said
    assert urdf.model.inertias[1].mass == 1.0
    with pytest.raises(ModelError, match=r"link\[b\].inertial.inertia: is missing, but joint"):
        loaded_urdf(f'<robot name="r">{links}{J}{K}</robot>')
    welded = links + link("d")
    weld = '<joint name="w" type="fixed"><parent link="b"/><child link="d"/></joint>'
    with pytest.raises(ModelError, match=r"link\[b\].inertial.inertia: is missing"):
        loaded_urdf(f'<robot name="r">{welded}{J}{K}{weld}</robot>')


@pytest.mark.parametrize("last", [K, MIMIC], ids=["alone", "mimic"])
@pytest.mark.parametrize(
    ("attributes", "more"),
    [
        ("", CAMERA),
        ("", '<link name="d"><g:x/></link>' + J.replace('"b"', '"d"').replace('"j"', '"l"')),
        ('xmlns="urn:mine" ', ""),
        ('xmlns:g="urn:g" g:hint="1" ', ""),
    ],
    ids=["prefix", "prefix in a link", "namespace", "declared prefix"],
)  # fmt: skip
def test_prefixes_and_namespaces_are_passed_over(attributes, more, last):
    urdf = loaded(f'<robot {attributes}name="r">{LINKS}{J}{last}{more}</robot>')
    assert set(urdf.tree.links) >= {"a", "b", "c"}
    notes = ["its elements are read without their namespace, urn:mine"]
    assert list(urdf.notes) == (notes if "xmlns=" in attributes else [])
    assert ("robot.gazebo" in urdf.tree.ignored) == (more == CAMERA)


@pytest.mark.parametrize("before", ["\n", "  \n\n", "<!-- licence -->\n"])
def test_a_declaration_may_stand_after_a_blank_line_or_a_comment(before):
    text = (
        before + '<?xml version="1.0" encoding="utf-8"?>\n<robot name="r"><link name="a"/></robot>'
    )
    assert tuple(loaded(text).tree.links) == ("a",)


def test_moments_that_are_written_twice_are_one():
    twice = INERTIAL.replace('iyz="-0.003"', 'iyz="-0.003" iyx="0.001" izx="0.002" izy="-3e-3"')
    once, again = (
        loaded(robot(link("a", inertial=text))).tree.links["a"].inertia
        for text in (INERTIAL, twice)
    )
    assert once.tobytes() == again.tobytes()


EMPTY = {
    "sphere": '<sphere radius="0"/>',
    "box": '<box size="1 0 1"/>',
    "cylinder": '<cylinder radius="0.1" length="0"/>',
    "mesh": '<mesh filename="none.obj" scale="0 1 1"/>',
}


@cases("shape", EMPTY)
def test_a_shape_without_size_is_left_out_and_noted(shape):
    urdf = loaded(robot(link("a", collision(shape) + collision('<sphere radius="0.5"/>'))))
    assert [each.shape.radius for each in urdf.shapes] == [0.5]
    assert urdf.notes == ("link[a].collision[0]: left out, since its shape has no size",)
    with pytest.raises(ModelError, match="must be a positive"):
        loaded(robot(link("a", collision('<sphere radius="-1"/>'))))


def test_a_continuous_joint_may_mimic_one_with_bounds():
    text = f'<robot name="r">{LINKS}{J}{MIMIC}</robot>'.replace(
        'name="k" type="revolute"', 'name="k" type="continuous"'
    )
    urdf = loaded(text)
    assert urdf.notes == ("joint[k]: revolute, as it mimics a joint with bounds",)
    assert urdf.model.nv == 1


@pytest.mark.parametrize("kind", ["revolute", "continuous", "prismatic"])
def test_a_joint_that_mimics_one_that_is_not_there_moves_by_itself(kind):
    text = f'<robot name="r">{LINKS}{J}{MIMIC}</robot>'.replace(
        'mimic joint="j"', 'mimic joint="i"'
    )
    urdf = loaded(text.replace('name="k" type="revolute"', f'name="k" type="{kind}"'))
    assert urdf.notes == (
        "joint[k]: moves by itself, as the joint that it mimics, i, is not there",
    )
    assert urdf.model.nv == 2


def test_of_a_scale_of_four_numbers_the_first_three_count(tmp_path):
    urdf_of_text(tmp_path, "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n", "a.obj")
    mesh = collision('<mesh filename="a.obj" scale="1 2 3 9"/>')
    urdf = loaded(urdf_of_text(tmp_path, robot(link("a", mesh))))
    note = "link[a].collision[0].mesh.scale: of its 4 numbers the first three count"
    assert urdf.notes[0] == note
    assert_within(urdf.shapes[0].shape.vertices.max(axis=0), np.array([1.0, 2.0, 3.0]), 0.0)
    with pytest.raises(ModelError, match="scale: must be 3 numbers"):
        loaded(urdf_of_text(tmp_path, robot(link("a", mesh.replace("1 2 3 9", "1 2")))))


@pytest.mark.parametrize("points", ["v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\n", "v 0 0 0\nv 1 0 0\n"])
def test_a_mesh_without_volume_is_left_out_and_noted(tmp_path, points):
    urdf_of_text(tmp_path, points, "flat.obj")
    mesh = collision('<mesh filename="flat.obj"/>') + collision('<sphere radius="0.5"/>')
    urdf = loaded(urdf_of_text(tmp_path, robot(link("a", mesh))))
    assert [shape.name for shape in urdf.shapes] == ["a#1"]
    assert urdf.notes == ("a#0: left out, since the hull of flat.obj has no volume",)


def test_an_unknown_attribute_is_listed_and_a_misprint_refused():
    text = f'<robot name="r">{LINKS}{J}{K}</robot>'
    odd = text.replace("<limit", '<axis xyz="0 0 1" rpy="0 0 0"/><limit')
    assert "joint[j].axis.rpy" in loaded(odd).tree.ignored
    with pytest.raises(ModelError, match=r"axis.xzy: is unknown; did you mean 'xyz'"):
        loaded(odd.replace('xyz="0 0 1"', 'xzy="0 0 1"'))


def test_urdf_1_2_has_optional_limits_and_quaternions():
    text = f'<robot name="r" version="1.2">{LINKS}{J}{K}</robot>'
    bare = text.replace('effort="1" velocity="1"', "").replace(LIMIT, "", 1)
    assert loaded(bare).model.nv == 2
    with pytest.raises(ModelError, match="is missing"):
        loaded(bare.replace("1.2", "1.1"))
    half = np.sqrt(0.5)
    turned = text.replace("<parent", f'<origin xyz="0 0 1" quat_xyzw="0 0 {half} {half}"/><parent')
    urdf = loaded(turned)
    R = np.array([[0, -1, 0], [1, 0, 0], [0, 0, 1]])
    assert_within(urdf.tree.joints[0].R, R, 1e-15)
    assert_within(urdf.model.jointPlacements[1].rotation, R, 1e-15)
    with pytest.raises(ModelError, match="quat_xyzw: cannot stand next to rpy"):
        loaded(turned.replace("quat_xyzw", 'rpy="0 0 0" quat_xyzw'))
