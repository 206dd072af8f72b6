"""Signed distances of points to primitives: coal, closed forms, gradients, ties."""

import coal
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
from quasistatic_ref.contact.distance import closest
from tests.closeness import assert_relative, assert_within
from tests.tolerances import (
    CLOSED_FORM,
    ROUNDING,
    SIGNED_DISTANCE,
)

SHAPES = {
    "sphere": Sphere(0.3),
    "capsule": Capsule(0.2, 0.3),
    "box": Box((0.2, 0.3, 0.4)),
    "cylinder": Cylinder(0.25, 0.3),
    "half-space": HalfSpace((1.0, -2.0, 2.0), 0.3),
}
COORDINATE = st.one_of(
    st.floats(-1, 1, allow_subnormal=False).filter(lambda x: x == 0 or abs(x) > 1e-100),
    st.sampled_from([0.0, 0.2, 0.25, 0.3, 0.4, -0.2, -0.3, 0.5]),
)
POINT = st.tuples(COORDINATE, COORDINATE, COORDINATE)
SHAPE = st.sampled_from(sorted(SHAPES))


def asked_of_coal(shape, point):
    """Distance of a point, as a coal ball of radius zero."""
    request = coal.DistanceRequest()
    result = coal.DistanceResult()
    request.enable_signed_distance = True
    there = coal.Transform3s(np.eye(3), point)
    return coal.distance(shape.coal, coal.Transform3s(), coal.Sphere(0.0), there, request, result)


def cylinder_distance(shape, point):
    """Signed distance to a cylinder in the plane (r, z), written out case by case."""
    x, y, z = point
    beyond_side = (x**2 + y**2) ** 0.5 - shape.radius
    beyond_cap = abs(z) - shape.half_length
    if beyond_side > 0 and beyond_cap > 0:
        return (beyond_side**2 + beyond_cap**2) ** 0.5
    return max(beyond_side, beyond_cap)


@pytest.mark.parametrize("name", ["sphere", "capsule", "box", "cylinder"])
def test_a_distance_is_that_of_coal_or_of_the_plane_of_radius_and_height(name, rng):
    shape = SHAPES[name]
    points = rng.uniform(-0.8, 0.8, size=(400, 3))
    phi, _ = shape.signed_distance(points)
    other = cylinder_distance if name == "cylinder" else asked_of_coal  # coal's is wrong inside one
    expected = [other(shape, point) for point in points]
    assert min(expected) < 0 < max(expected)
    assert_within(phi, expected, SIGNED_DISTANCE)


@given(name=SHAPE, point=POINT)
def test_every_normal_has_length_one_and_leads_to_the_surface(name, point):
    """So that, by its distance, it is the normal at the nearest point."""
    shape = SHAPES[name]
    points = np.array([point])
    phi, normal = shape.signed_distance(points)
    assert_relative(np.linalg.norm(normal[0]), 1.0, ROUNDING)
    foot, _ = shape.signed_distance(points - phi[:, None] * normal)
    assert_within(foot, [0.0], SIGNED_DISTANCE)


# Sizes that are exact in binary, so that ties are exact.
BRICK = Box((0.25, 0.5, 0.75))
DISC = Cylinder(0.25, 0.125)
BALL, CAPSULE, BOX, CAN, WALL = SHAPES.values()
DEGENERATE = {
    "centre of a sphere": (BALL, (0, 0, 0), -0.3, (1, 0, 0)),
    "centre of a sphere, by -0.0": (BALL, (-0.0, -0.0, -0.0), -0.3, (1, 0, 0)),
    "middle of a capsule": (CAPSULE, (0, 0, 0), -0.2, (1, 0, 0)),
    "centre of a box": (BOX, (0, 0, 0), -0.2, (1, 0, 0)),
    "on a face of a box": (BOX, (0.1, -0.3, 0.2), 0.0, (0, -1, 0)),
    "on an edge of a box": (BOX, (0.2, -0.3, 0.1), 0.0, (1, 0, 0)),
    "off an edge of a box": (BOX, (0.5, 0.7, 0.0), 0.5, (0.6, 0.8, 0)),
    "off a corner of a box": (BOX, (-0.3, 0.5, 0.6), 0.3, (-1 / 3, 2 / 3, 2 / 3)),
    "as near to x as to y": (BRICK, (0.125, 0.375, 0.0), -0.125, (1, 0, 0)),
    "as near to x as to -y and -z": (BRICK, (0.0, -0.25, -0.5), -0.25, (1, 0, 0)),
    "centre of a cylinder": (CAN, (0, 0, 0), -0.25, (1, 0, 0)),
    "high on a cylinder's axis": (CAN, (0, 0, 0.2), -0.1, (0, 0, 1)),
    "on a cylinder's rim": (CAN, (0, 0.25, 0.3), 0.0, (0, 1, 0)),
    "off a cylinder's rim": (CAN, (0, 0.55, 0.7), 0.5, (0, 0.6, 0.8)),
    "half-way between a disc's caps": (DISC, (0, 0, 0), -0.125, (0, 0, 1)),
    "half-way between them, off the axis": (DISC, (0.0625, 0.0, -0.0), -0.125, (0, 0, 1)),
    "inside a half-space": (WALL, (0, 0, 0), -0.1, (1 / 3, -2 / 3, 2 / 3)),
}


@pytest.mark.parametrize(("shape", "point", "phi", "n"), DEGENERATE.values(), ids=DEGENERATE)
def test_where_the_normal_is_not_unique_the_first_one_wins(shape, point, phi, n):
    found_phi, found_n = shape.signed_distance(np.array([point], dtype=np.float64))
    assert_within(found_phi, [phi], SIGNED_DISTANCE)
    assert_within(found_n, [n], SIGNED_DISTANCE)


@pytest.mark.parametrize("name", SHAPES)
def test_a_point_s_distance_does_not_depend_on_its_batch(name, rng):
    shape = SHAPES[name]
    points = rng.uniform(-0.8, 0.8, size=(37, 3))
    phi, normal = shape.signed_distance(points)
    for i, point in enumerate(points):
        alone_phi, alone_normal = shape.signed_distance(point[None])
        np.testing.assert_array_equal(alone_phi[0], phi[i])
        np.testing.assert_array_equal(alone_normal[0], normal[i])


@given(
    phi=st.lists(st.sampled_from([-1.0, -0.5, 0.0, 0.5, 1.0]), min_size=1, max_size=30),
    k=st.integers(1, 40),
)
def test_the_closest_are_those_of_a_full_stable_sort(phi, k):
    expected = sorted(range(len(phi)), key=lambda i: (phi[i], i))[:k]
    assert closest(np.array(phi), k).tolist() == expected


# In the half-plane (r, z) the side of this cone leads from the rim (0.3, -0.2) to the tip (0, 0.2):
# a triangle of sides 3, 4 and 5, so that the side's normal is (4, 3) / 5.
CONE = Cone(0.3, 0.2)
BY_CONE = {
    "off the side": ((0.15, 0.0), 0.1, (0.8, 0.6)),
    "within the side": ((0.15, 0.0), -0.02, (0.8, 0.6)),
    "off the tip": ((0.0, 0.2), 0.1, (0.6, 0.8)),
    "above the tip": ((0.0, 0.2), 0.1, (0.0, 1.0)),
    "off the rim": ((0.3, -0.2), 0.1, (0.6, -0.8)),
    "below the middle of the base": ((0.1, -0.2), 0.7, (0.0, -1.0)),
    "below the base, next to the rim": ((0.2, -0.2), 0.2, (0.0, -1.0)),
    "within the base": ((0.1, -0.2), -0.01, (0.0, -1.0)),
}
"""The nearest point of the cone (r, z), the signed distance along the normal, and the normal."""


@pytest.mark.parametrize(("foot", "distance", "normal"), BY_CONE.values(), ids=BY_CONE)
def test_a_point_put_off_a_feature_of_a_cone_has_that_distance(foot, distance, normal):
    r, z = np.add(foot, np.multiply(distance, normal))
    for x, y in ((1.0, 0.0), (-0.6, 0.8)):  # half-planes about the axis
        phi, n = CONE.signed_distance(np.array([[r * x, r * y, z]]))
        assert_within(phi, [distance], CLOSED_FORM)
        turned = [normal[0] * x, normal[0] * y, normal[1]]
        if r > 0:
            assert_within(n, [turned], CLOSED_FORM)
        else:
            assert_within(n[0, 2], normal[1], CLOSED_FORM)


def test_the_normal_at_a_tip_is_one_of_the_tip_whatever_is_rounded(rng):
    """Along all generators from the tip, (radius, -2 half_length), n may not point into the cone.

    So n_r radius <= 2 half_length n_z; of the side's normal the two are equal.
    """
    for radius, half_length in rng.uniform(0.01, 1.0, size=(500, 2)):
        phi, n = Cone(radius, half_length).signed_distance(np.array([[0.0, 0.0, half_length]]))
        assert_within(phi, [0.0], CLOSED_FORM)
        assert_relative(np.sum(n * n), 1.0, ROUNDING)
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


HALF_AXES = np.array([0.3, 0.2, 0.1])


def of_ellipsoid(points):
    """A function that is zero on the ellipsoid of these HALF_AXES and negative within."""
    return np.sum((points / HALF_AXES) ** 2, axis=1) - 1


def points_of_ellipsoid(s, angle):
    """Points of the ellipsoid: z / c = 2 s - 1, at an angle about z."""
    z = 2 * s - 1
    r = np.sqrt(1 - z**2)
    return HALF_AXES * np.column_stack([r * np.cos(angle), r * np.sin(angle), z])


def test_the_foot_on_an_ellipsoid_is_on_its_surface_and_no_point_of_it_is_nearer(rng):
    points = rng.uniform(-0.5, 0.5, size=(200, 3))
    points[:40] *= 0.2  # within
    phi, normal = Ellipsoid(HALF_AXES).signed_distance(points)
    assert phi.min() < 0 < phi.max()
    assert np.array_equal(np.sign(phi), np.sign(of_ellipsoid(points)))
    assert_relative(np.sum(normal * normal, axis=1), 1.0, ROUNDING)
    feet = points - phi[:, None] * normal
    assert_within(of_ellipsoid(feet), 0.0, CLOSED_FORM)
    many = points_of_ellipsoid(rng.uniform(0, 1, size=3000), rng.uniform(0, 2 * np.pi, size=3000))
    nearest = np.sqrt(np.sum((points[:, None] - many) ** 2, axis=2).min(axis=1))
    assert (np.abs(phi) <= nearest + CLOSED_FORM).all()
