"""Poses of links from the file alone."""

import numpy as np

from quasistatic_ref.model.joints import JOINTS
from quasistatic_ref.model.urdf.urdf_tree import FileJoint, link_poses


class Sliding:
    """A kind of joint that somebody adds, whose coordinates are three lengths."""

    lengths = 3


def test_the_first_coordinate_of_a_kind_that_slides_is_a_length(monkeypatch):
    monkeypatch.setitem(JOINTS, "sliding", Sliding)
    axis = np.array([0.0, 1.0, 0.0])
    for kind, moved in (("sliding", [0.0, 2.5, 1.0]), ("ball", [0.0, 0.0, 1.0])):
        joint = FileJoint("j", kind, "a", "b", np.eye(3), np.array([0.0, 0.0, 1.0]), axis, None)
        R, t = link_poses("a", [joint], {"j": 2.5})["b"]
        np.testing.assert_array_equal(t, moved)
        assert (np.eye(3) == R).all() == (kind == "sliding")
