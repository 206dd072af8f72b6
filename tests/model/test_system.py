"""System: the paper's order, twists in the body frame, poses and Jacobians of links."""

import numpy as np

from quasistatic_ref import Body, System
from tests.closeness import assert_close
from tests.model.urdf.urdf_texts import inertial, joint, link, robot, urdf_of_text
from tests.tolerances import ROUNDING


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


def test_m_u_of_free_bodies_alone_is_one_array_without_negative_zeros(tmp_path, scene, q):
    centred = robot(link("a", inertial=inertial()))  # no product of inertia, no lever
    system = System([Body("a", urdf_of_text(tmp_path, centred, "a.urdf"), "floating")])
    assert system.constant_mass_matrix
    M_u = system.M_u(system.q_start)
    expected = np.diag([2, 2, 2, 0.02, 0.03, 0.04])
    assert_close(M_u, expected, ROUNDING)
    assert not np.signbit(M_u).any()
    assert system.M_u(system.integrate(system.q_start, np.ones(6))) is M_u
    assert not scene.constant_mass_matrix
    assert np.abs(scene.M_u(q) - scene.M_u(scene.q_start)).max() > 0.1
