"""Limits of what a URDF may say: its size, its numbers, inertias of bodies, what was loaded."""

import numpy as np
import pytest

from quasistatic_ref.errors import ModelError
from quasistatic_ref.model.urdf import urdf_file as urdf_file_module
from quasistatic_ref.model.urdf.urdf import loaded_urdf
from quasistatic_ref.model.urdf.urdf_file import inertia_defect, urdf_file
from quasistatic_ref.model.urdf.urdf_xml import DEEPEST, xml_root
from tests.model.urdf.urdf_texts import inertial, joint, link, robot


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


def test_an_inertia_of_no_body_is_given_in_the_order_of_its_attributes() -> None:
    ixx, iyy, izz, ixy, ixz, iyz = written = [1.0, 2.0, -3.0, 0.1, 0.2, 0.3]
    defect = inertia_defect(np.array([[ixx, ixy, ixz], [ixy, iyy, iyz], [ixz, iyz, izz]]))
    assert defect is not None
    assert defect[1:] == ("must be positive definite (ixx iyy izz ixy ixz iyz)", written)


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
