"""Signed distances of points to primitives: coal, closed forms, gradients, ties."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from quasistatic_ref import (
    Box,
    Capsule,
    Cone,
    Cylinder,
    Ellipsoid,
    HalfSpace,
    Sphere,
)
from quasistatic_ref.contact.ranks import closest
from tests.cases import cases
from tests.closeness import assert_relative, assert_within
from tests.tolerances import (
    CLOSED_FORM,
    SIGNED_DISTANCE,
)

# Sizes that are exact in binary, so that ties are exact.
BRICK = Box((0.25, 0.5, 0.75))
DISC = Cylinder(0.25, 0.125)
BALL = Sphere(0.3)
BOX = Box((0.2, 0.3, 0.4))
CAN = Cylinder(0.25, 0.3)
WALL = HalfSpace((1.0, -2.0, 2.0), 0.3)
DEGENERATE = {
    "centre of a sphere": (BALL, (0, 0, 0), -0.3, (1, 0, 0)),
    "centre of a sphere, by -0.0": (BALL, (-0.0, -0.0, -0.0), -0.3, (1, 0, 0)),
    "middle of a capsule": (Capsule(0.2, 0.3), (0, 0, 0), -0.2, (1, 0, 0)),
    "centre of a box": (BOX, (0, 0, 0), -0.2, (1, 0, 0)),
    "on an edge of a box": (BOX, (0.2, -0.3, 0.1), 0.0, (1, 0, 0)),
    "as near to x as to y": (BRICK, (0.125, 0.375, 0.0), -0.125, (1, 0, 0)),
    "as near to x as to -y and -z": (BRICK, (0.0, -0.25, -0.5), -0.25, (1, 0, 0)),
    "centre of a cylinder": (CAN, (0, 0, 0), -0.25, (1, 0, 0)),
    "on a cylinder's rim": (CAN, (0, 0.25, 0.3), 0.0, (0, 1, 0)),
    "half-way between a disc's caps": (DISC, (0, 0, 0), -0.125, (0, 0, 1)),
    "half-way between them, off the axis": (DISC, (0.0625, 0.0, -0.0), -0.125, (0, 0, 1)),
    "inside a half-space": (WALL, (0, 0, 0), -0.1, (1 / 3, -2 / 3, 2 / 3)),
}


@cases("shape, point, phi, n", DEGENERATE)
def test_where_the_normal_is_not_unique_the_first_one_wins(shape, point, phi, n):
    found_phi, found_n = shape.signed_distance(np.array([point], dtype=np.float64))
    assert_within(found_phi, [phi], SIGNED_DISTANCE)
    assert_within(found_n, [n], SIGNED_DISTANCE)


@given(
    phi=st.lists(st.sampled_from([-1.0, -0.5, 0.0, 0.5, 1.0]), min_size=1, max_size=30),
    k=st.integers(1, 40),
)
def test_the_closest_are_those_of_a_full_stable_sort(phi, k):
    expected = sorted(range(len(phi)), key=lambda i: (phi[i], i))[:k]
    assert closest(np.array(phi), k).tolist() == expected


def test_the_normal_at_a_tip_is_one_of_the_tip_whatever_is_rounded(rng):
    """Along all generators from the tip, (radius, -2 half_length), n may not point into the cone.

    So n_r radius <= 2 half_length n_z; of the side's normal the two are equal.
    """
    for radius, half_length in rng.uniform(0.01, 1.0, size=(500, 2)):
        phi, n = Cone(radius, half_length).signed_distance(np.array([[0.0, 0.0, half_length]]))
        assert_within(phi, [0.0], CLOSED_FORM)
        assert_relative(np.sum(n * n), 1.0)
        n_r = np.hypot(n[0, 0], n[0, 1])
        assert n_r * radius <= 2 * half_length * n[0, 2] + CLOSED_FORM


@pytest.mark.parametrize("z", [0.0, -0.0])
@pytest.mark.parametrize("x", [0.0, 0.1, -0.1])
def test_half_way_through_an_ellipsoid_the_upper_side_is_the_nearest(x, z):
    # Near the middle of the plane z = 0 the nearest points are two, one above and one below. Of
    # (x, 0, 0) they are at x' = a^2 x / (a^2 - c^2): there the gradient (x' / a^2, 0, z' / c^2) is
    # parallel to the way (x' - x, 0, z').
    a = 0.3
    b = 0.2
    c = 0.1
    foot_x = a**2 * x / (a**2 - c**2)
    way = np.array([foot_x - x, 0.0, c * np.sqrt(1 - (foot_x / a) ** 2)])
    phi, n = Ellipsoid((a, b, c)).signed_distance(np.array([[x, 0.0, z]]))
    assert_within(phi, [-np.sqrt(way @ way)], CLOSED_FORM)
    assert_within(n, [way / np.sqrt(way @ way)], CLOSED_FORM)
