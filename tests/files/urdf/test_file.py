"""Limits of what a URDF may say: its size, its numbers, its coordinates."""

import pytest

from quasistatic_ref import ModelError
from quasistatic_ref.files.urdf import file
from quasistatic_ref.files.urdf.file import urdf_tree
from tests.files.urdf.urdf_texts import joint, link, robot


def test_a_file_holds_as_many_links_as_are_allowed(monkeypatch):
    monkeypatch.setattr(file, "MOST_LINKS", 2)
    arms = joint("j", "a", "b"), joint("k", "b", "c")
    assert len(urdf_tree(robot(link("a"), link("b"), arms[0])).links) == 2
    with pytest.raises(
        ModelError, match=r"robot: holds more than 2 links; leave some out \(got 3\)"
    ):
        urdf_tree(robot(link("a"), link("b"), link("c"), *arms))


def test_a_file_has_as_many_coordinates_as_are_allowed(monkeypatch):
    """Pinocchio takes memory with the cube of their number: 300 hinges took 1.2 GiB."""
    monkeypatch.setattr(file, "MOST_COORDINATES", 3)
    balls = joint("j", "a", "b", "ball"), joint("k", "b", "c", "ball")
    fixed = joint("f", "b", "c", "fixed")
    urdf_tree(robot(link("a"), link("b"), link("c"), balls[0], fixed))
    with pytest.raises(ModelError, match=r"more than 3 coordinates; fix some of them \(got 6\)"):
        urdf_tree(robot(link("a"), link("b"), link("c"), *balls))
