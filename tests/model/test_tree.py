"""Trees of links and joints, which are data and know nothing of files."""

import pickle
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from quasistatic_ref import Body, Box, System
from quasistatic_ref.model.tree import LinkShape, Tree, TreeJoint, TreeLink
from tests.closeness import assert_within
from tests.files.urdf.urdf_texts import CHAIN, loaded_urdf


def block(name):
    shape = LinkShape(f"{name}#0", Box((0.1, 0.2, 0.3)), np.eye(3), np.zeros(3))
    return TreeLink(name, 1.5, np.zeros(3), np.eye(3), (shape,))


def test_a_body_may_be_made_of_a_tree_by_hand():
    """Two blocks, the second 0.5 m above the first and turned about z by a hinge."""
    at = np.array([0.0, 0.0, 0.5])
    hinge = TreeJoint(
        "hinge", "revolute", "low", "high", np.eye(3), at, np.array([0, 0, 1.0]), None
    )
    tree = Tree(
        Path("by hand"), "two blocks", {"low": block("low"), "high": block("high")}, (hinge,)
    )
    system = System([Body("r", tree, "floating", positions={"hinge": 0.3})])
    kinematics = system.kinematics(system.q_start)
    assert system.links == ("world", "r/low", "r/high")
    assert_within(kinematics.t[2], at)
    assert_within(kinematics.R[2], Rotation.from_euler("z", 0.3).as_matrix())
    assert [shape.name for shape in system.shapes] == ["r/low#0", "r/high#0"]


def test_links_of_a_urdf_stand_parents_first_and_joints_as_q_has_them():
    tree = loaded_urdf(CHAIN).tree
    links = list(tree.links)
    assert tree.root == links[0] == "base_link"
    assert list(tree.moved_by) == links[1:]
    assert all(links.index(joint.parent) < links.index(joint.child) for joint in tree.joints)
    assert [(joint.name, mimic.of) for joint, mimic in tree.mimics] == [("swing_mimic", "swing")]


def test_a_tree_is_plain_data():
    tree = loaded_urdf(CHAIN).tree
    copy = pickle.loads(pickle.dumps(tree))
    assert copy == tree == loaded_urdf(CHAIN).tree
    assert tree != loaded_urdf(CHAIN.replace("0.02", "0.03")).tree
