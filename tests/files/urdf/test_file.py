"""Limits of what a URDF may say: its size, its numbers, its coordinates."""

import pytest

from quasistatic_ref import ModelError
from tests.files.urdf.urdf_texts import joint, link, robot, urdf_tree


def star(count, kind):
    """A robot of so many links on joints of a kind about its first one."""
    joints = (joint(f"j{i}", "l0", f"l{i}", kind) for i in range(1, count))
    return robot(*(link(f"l{i}") for i in range(count)), *joints)


def test_a_file_holds_as_many_links_as_are_allowed():
    assert len(urdf_tree(star(1000, "fixed")).links) == 1000
    says = r"robot: holds more than 1000 links; leave some out \(got 1001\)"
    with pytest.raises(ModelError, match=says):
        urdf_tree(star(1001, "fixed"))


def test_a_file_has_as_many_coordinates_as_are_allowed():
    """Pinocchio takes memory with the cube of their number: 300 hinges took 1.2 GiB."""
    urdf_tree(star(84, "ball"))
    with pytest.raises(ModelError, match=r"more than 250 coordinates; fix some of .* \(got 252\)"):
        urdf_tree(star(85, "ball"))
