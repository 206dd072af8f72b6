"""Tangents are a fixed function of the normal; contacts carry their layout and names."""

import numpy as np
import pytest

from quasistatic_ref import ContactPair, HalfSpace, PointCloud, Sphere
from quasistatic_ref.contact.distance import closest_points
from quasistatic_ref.contact.jacobian import ContactGeometry, tangents
from quasistatic_ref.contact.pairs import contact_layout
from tests.closeness import assert_within
from tests.contact.still import placed_shape
from tests.scenes import chain_scene
from tests.tolerances import ROUNDING

X, Y, Z = np.eye(3)
ALONG_AXES = {
    "+x": (X, Y, Z),
    "-x": (-X, Y, -Z),
    "+y": (Y, X, -Z),
    "-y": (-Y, X, Z),
    "+z": (Z, X, Y),
    "-z": (-Z, X, -Y),
}
"""n, d1, d2: d1 is the first world axis square to n, d2 = n x d1."""


@pytest.mark.parametrize(("n", "d1", "d2"), ALONG_AXES.values(), ids=ALONG_AXES)
def test_tangents_of_a_normal_along_an_axis_are_axes(n, d1, d2):
    found = tangents(n[None] + 0.0)  # as in contacts zero is 0.0
    np.testing.assert_array_equal(found, [[d1], [d2]])
    assert not np.signbit(found)[np.array(found) == 0].any()


def test_d1_is_the_projection_of_the_world_axis_farthest_from_n_and_d2_is_n_x_d1(rng):
    for n in rng.normal(size=(50, 3)):
        n /= np.linalg.norm(n)
        axis = np.eye(3)[min(range(3), key=lambda i: abs(n[i]))]
        d1 = axis - (axis @ n) * n
        d1 /= np.linalg.norm(d1)
        expected = [[d1], [np.cross(n, d1)]]
        assert_within(tangents(n[None]), expected, ROUNDING)


def test_contacts_are_those_of_the_pairs_in_order(tmp_path, rng):
    system = chain_scene(tmp_path)
    box = system.link("box/box")
    upper = system.link("arm/upper")
    floor = placed_shape(HalfSpace(Z, 0.0))
    cloud = placed_shape(PointCloud(rng.normal(size=(9, 3))), box)
    ball = placed_shape(Sphere(0.1), upper)
    pairs = [
        ContactPair("a", floor, cloud, 0.5, 0.0, 4, 3),
        ContactPair("b", ball, cloud, 0.6, 0.02, 6, 2),
        ContactPair("c", floor, ball, 0.7, 0.03, 6, 1),
    ]
    kinematics = system.kinematics(system.q_start)
    layout = contact_layout(pairs)
    points = closest_points(pairs, kinematics)
    found = ContactGeometry(layout, system.column_map).contacts(points, kinematics)
    assert layout.names == ("a", "a", "a", "b", "b", "c")
    assert layout.link_alpha.tolist() == [0, 0, 0, upper, upper, 0]
    assert layout.link_beta.tolist() == [box] * 5 + [upper]
    expected = [f"{name}/{i}" for name, i in zip(layout.names, points.point, strict=True)]
    assert list(found.name) == expected
    assert found.rows.tolist() == [4, 4, 4, 6, 6, 6]
    assert found.mu_v.tolist() == [0.5, 0.5, 0.5, 0.6, 0.6, 0.7]
    assert found.mu_omega.tolist() == [0.0, 0.0, 0.0, 0.02, 0.02, 0.03]
    np.testing.assert_array_equal(found.phi, points.phi)
