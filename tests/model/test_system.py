"""System: the paper's order, twists in the body frame, poses and Jacobians of links."""

import numpy as np

from quasistatic_ref import Body, System
from tests.files.urdf.urdf_texts import inertial, joint, link, robot


def test_coordinates_are_actuated_first_then_in_order_of_the_bodies(scene):
    names = [coordinate.name for coordinate in scene.coordinates]
    twist = ("x", "y", "z", "rx", "ry", "rz")
    assert names == [
        *(f"arm/base.{axis}" for axis in twist), "arm/spin", "desk/slide",
        *(f"box/base.{axis}" for axis in twist), "arm/swing", "arm/slide", "desk/swing",
        "desk/spin",
    ]  # fmt: skip
    assert (scene.n_a, scene.n_u, scene.n_v) == (8, 10, 18)
    assert [coordinate.actuated for coordinate in scene.coordinates] == [True] * 8 + [False] * 10
    units = {coordinate.name: coordinate.unit for coordinate in scene.coordinates}
    assert units["arm/base.z"] == units["arm/slide"] == "m"
    assert units["arm/base.rx"] == units["arm/spin"] == units["arm/swing"] == "rad"


def test_actuated_coordinates_change_whatever_comes_after_them():
    crane = robot(
        *(link(name, inertial=inertial("2", ("0.01",) * 3)) for name in ("rail", "cart", "bob")),
        joint("slide", "rail", "cart", "prismatic", "1 0 0"),
        joint("swing", "cart", "bob", "revolute", "0 1 0"),
    )
    system = System([Body("crane", crane, actuated=["slide"])])
    change = system.actuated_difference(np.array([0.25, 1.0]), np.array([0.75]))
    assert change.tolist() == [0.75 - 0.25]
