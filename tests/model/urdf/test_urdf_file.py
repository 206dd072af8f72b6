"""Limits of what a URDF may say: its size, its numbers, inertias of bodies, what was loaded."""

import numpy as np
import pinocchio as pin
import pytest

from quasistatic_ref.errors import ModelError
from quasistatic_ref.model.urdf import urdf_file as urdf_file_module
from quasistatic_ref.model.urdf.urdf import loaded_urdf
from quasistatic_ref.model.urdf.urdf_file import inertia_defect, urdf_file
from quasistatic_ref.model.urdf.urdf_shapes import same_pose
from quasistatic_ref.model.urdf.urdf_xml import DEEPEST, xml_root
from quasistatic_ref.shapes.placed_shape import Sphere
from quasistatic_ref.tolerances import INERTIA_TRIANGLE, LOADED
from tests.model.urdf.urdf_texts import collision, inertial, joint, link, robot


def test_elements_are_nested_up_to_the_deepest() -> None:
    root = xml_root("<a>" * DEEPEST + "</a>" * DEEPEST)
    assert len(list(root.iter())) == DEEPEST
    with pytest.raises(ModelError, match="line 1: is nested deeper than 100 elements"):
        xml_root("<a>" * (DEEPEST + 1) + "</a>" * (DEEPEST + 1))


def test_a_file_holds_as_many_links_as_are_allowed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(urdf_file_module, "MOST_LINKS", 2)
    arms = joint("j", "a", "b"), joint("k", "b", "c")
    assert len(urdf_file(robot(link("a"), link("b"), arms[0])).links) == 2
    with pytest.raises(ModelError, match=r"robot: holds more than 2 links \(got 3\)"):
        urdf_file(robot(link("a"), link("b"), link("c"), *arms))


def test_numbers_are_taken_up_to_the_largest() -> None:
    ball = robot(link("a", collision('<sphere radius="1e15"/>')))
    assert loaded_urdf(ball).shapes[0].shape == Sphere(1e15)
    with pytest.raises(ModelError, match=r"sphere.radius: must be at most 1e\+15"):
        loaded_urdf(ball.replace("1e15", "1.1e15"))


def test_an_inertia_of_no_body_is_given_in_the_order_of_its_attributes() -> None:
    ixx, iyy, izz, ixy, ixz, iyz = written = [1.0, 2.0, -3.0, 0.1, 0.2, 0.3]
    defect = inertia_defect(np.array([[ixx, ixy, ixz], [ixy, iyy, iyz], [ixz, iyz, izz]]))
    assert defect is not None
    assert defect[1:] == ("must be positive definite (ixx iyy izz ixy ixz iyz)", written)


def test_a_largest_moment_may_exceed_the_sum_of_the_others_by_rounding() -> None:
    assert inertia_defect(np.diag([1.0, 1.0, 2 * (1 + INERTIA_TRIANGLE)])) is None
    defect = inertia_defect(np.diag([1.0, 1.0, 2 * (1 + 1.1 * INERTIA_TRIANGLE)]))
    assert defect is not None
    assert defect[1].startswith("is that of no body")


def point_mass(centre: str) -> str:
    return inertial("1", ("0",) * 3, f'<origin xyz="{centre}"/>')


def three_points(second: str) -> str:
    """Point masses at 0 and at (2, 0, 0), and a second one in a frame at (1, 1, 0)."""
    return robot(
        link("a", inertial=point_mass("0 0 0")),
        link("b", inertial=point_mass(second)),
        link("c", inertial=point_mass("0 0 0")),
        joint("v", "a", "b", "fixed", more='<origin xyz="1 1 0"/>'),
        joint("w", "a", "c", "fixed", more='<origin xyz="2 0 0"/>'),
    )


def test_point_masses_are_a_body_unless_they_are_in_a_line() -> None:
    # I = sum of m (d'd - d d') about the common centre: in a line, none about that line.
    assert loaded_urdf(three_points("0 0 0"), base="floating").links == ("a", "b", "c")
    with pytest.raises(ModelError, match=r"link\[a\].inertial.inertia: must be positive definite"):
        loaded_urdf(three_points("0 -1 0"), base="floating")


@pytest.mark.parametrize("far", [0.0, 1000.0])
def test_a_pose_is_as_written_but_for_the_rounding_of_its_size(far: float) -> None:
    # Off by (1 + |t|) LOADED; exactly so where t is 0.
    R, t = np.eye(3), np.array([0.0, 0.0, far])
    off = np.array([LOADED * (1 + far), 0.0, 0.0])
    assert same_pose(pin.SE3(R, t + off), R, t)
    assert not same_pose(pin.SE3(R, t + 1.1 * off), R, t)
