"""Trees as pinocchio models: what is loaded is what was written, and inertias are looked at."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from quasistatic_ref import Body, ModelError, System
from tests.files.urdf.urdf_texts import (
    BOX,
    inertial,
    joint,
    link,
    loaded_urdf,
    mimic,
    robot,
    urdf_of_text,
)
from tests.tolerances import ROUNDING


def test_a_path_with_any_letters_is_read(tmp_path):
    text = BOX.replace('name="r"', 'name="Кубик"').replace("<robot", "\ufeff<robot", 1)
    assert tuple(loaded_urdf(urdf_of_text(tmp_path, text, "ящик €.urdf")).tree.links) == ("box",)


def test_a_fixed_base_needs_no_mass():
    text = robot(link("stand", inertial=""))
    assert tuple(loaded_urdf(text).tree.links) == ("stand",)
    with pytest.raises(ModelError, match=r"link\[stand\].inertial: is missing, but the floating"):
        loaded_urdf(text, base="floating")


NO_WEIGHT = (
    "link[a].inertial.mass: must be greater than 0; accepted, because no un-actuated joint moves "
    "this link; its actuated joints carry no weight of it, also without gravity compensation"
)


def test_an_inertia_that_moves_nothing_is_noted():
    text = robot(
        link("a", inertial=inertial(mass="0")), link("b", inertial=""), joint("j", "a", "b")
    )
    notes = loaded_urdf(text, base="floating", actuated="all").notes
    assert notes == (NO_WEIGHT,)
    with pytest.raises(ModelError, match=r"link\[b\].inertial: is missing, but joint 'j' moves"):
        loaded_urdf(text, base="floating", actuated=("base",))
    with pytest.raises(ModelError, match=r"link\[a\].inertial.mass: must be greater than 0"):
        loaded_urdf(text, base="floating", actuated=("j",))


@pytest.mark.parametrize("base", ["floating", "planar", "ball", "fixed"])
def test_joints_are_all_but_the_base_and_all_takes_it_too(base):
    """Of the base and two joints, however the base moves; a name is no part of a word."""
    text = robot(link("a"), link("b"), link("c"), joint("j", "a", "b") + joint("join", "b", "c"))
    moves = base != "fixed"
    expected = {
        "joints": {"r/j", "r/join"},
        "all": {"r/j", "r/join"} | ({"r/base"} if moves else set()),
        ("join",): {"r/join"},
        (): set(),
    }
    for actuated, names in expected.items():
        system = System([Body("r", text, base=base, actuated=actuated)])
        assert {joint.name for joint in system.actuated} == names


def test_a_link_that_only_connects_joints_needs_no_mass():
    """Its joints turn about one axis: where neither is actuated, M_u is singular."""
    chain = joint("j", "a", "b") + joint("i", "b", "c")
    text = robot(link("a"), link("b", inertial=""), link("c"), chain)
    for actuated in (("i", "j"), ("i",), ("j",)):
        system = System([Body("r", text, base="floating", actuated=actuated)])
        assert system.masses.tolist() == [0.0, 2.0, 0.0, 2.0]
    with pytest.raises(ModelError, match="its mass matrix M_u is singular in float64"):
        System([Body("r", text, base="floating")])


def test_a_defect_of_a_part_of_a_body_is_noted():
    needle = inertial(moments=("0.1", "0.1", "1"))  # 1 > 0.1 + 0.1
    welded = robot(link("a"), link("b", inertial=needle), joint("j", "a", "b", "fixed"))
    (note,) = loaded_urdf(welded).notes
    assert note.startswith("link[b].inertial.inertia: is impossible")
    assert note.endswith("; accepted, because no un-actuated joint moves this link")
    massless = robot(
        link("a"), link("b", inertial=inertial(mass="0")), joint("j", "a", "b", "fixed")
    )
    (note,) = loaded_urdf(massless, base="floating").notes
    whole = "the inertia of all links welded to it is that of a body"
    assert note == f"link[b].inertial.mass: must be greater than 0; accepted, because {whole}"


def test_an_axis_that_is_not_written_is_x():
    hinge = joint("j", "a", "b").replace('<axis xyz="0 0 1"/>', "")
    urdf = loaded_urdf(robot(link("a"), link("b"), hinge))
    assert urdf.tree.joints[0].axis.tolist() == [1.0, 0.0, 0.0]


def test_a_mimic_may_be_met_before_its_leader():
    """Among joints of one link, and where both are moved by other joints of that link.

    At z = 0.3 the follower is at 2 (0.3) + 0.1 about the axis z.
    """
    follows = mimic("z", 2.0, 0.1)
    weld = joint("w", "a", "e", "fixed", more=mimic("no joint"))
    near = robot(*map(link, "abce"), joint("z", "a", "b"), joint("k", "a", "c", more=follows), weld)
    far = robot(
        *map(link, "abcde"), joint("y", "a", "b"), joint("z", "b", "c"), joint("i", "a", "d"),
        joint("k", "d", "e", more=follows),
    )  # fmt: skip
    turned = Rotation.from_euler("z", 2 * 0.3 + 0.1).as_matrix()
    for text in (near, far):
        body = Body("r", text, base="planar", actuated="all", positions={"z": 0.3})
        system = System([body, Body("other", text)])
        assert [m.of for m in system.mimics] == ["r/z", "other/z"]
        moving = [joint.name for joint in system.joints]
        assert sorted(moving) == sorted(set(moving))
        of = system.mimics[0].name.replace("k", "c" if text is near else "e")
        R = system.kinematics(system.q_start).R[system.links.index(of)]
        assert np.abs(R - turned).max() < ROUNDING
