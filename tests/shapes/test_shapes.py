"""Collision shapes: what they refuse."""

import numpy as np
import pytest

from quasistatic_ref import (
    Body,
    Box,
    Capsule,
    Cylinder,
    Ellipsoid,
    HalfSpace,
    ModelError,
    PlacedShape,
    PointCloud,
    Sphere,
    convex_hull,
)
from tests.cases import cases
from tests.closeness import assert_within

SHEARED = np.array([[1.0, 2e-9, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
"""R with R'R - I = [0 by 0; by by^2 0; 0 0 0], by twice what may be."""
REFUSED = {
    "zero radius": (lambda: Sphere(0.0), r"radius: must be a positive length \(got 0.0\)"),
    "radius too large to double": (lambda: Sphere(1.7e308), "radius: must be a positive length"),
    "a radius below a proton's": (lambda: Sphere(0.9e-15), "radius: must be at least 1e-15 m"),
    "a length of which half is too short": (
        lambda: Cylinder(1.0, length=1.5e-15),
        "half_length: must be at least 1e-15 m",
    ),
    "flat box": (lambda: Box((1, 0, 1)), "half_extents: must be three positive lengths"),
    "one edge": (lambda: Box(0.1), r"half_extents: must be three .*, half of its size \(got 0.1"),
    "one edge of a size": (lambda: Box(size=1), r"size: must be three positive lengths \(got 1.0"),
    "short cylinder": (lambda: Cylinder(1.0, 0.0), "half_length: must be a positive length"),
    "no normal": (lambda: HalfSpace(np.zeros(3), 0.0), "normal: must not be zero"),
    "nan offset": (lambda: HalfSpace(np.eye(3)[0], np.nan), "offset: must be a finite number"),
    "no points": (lambda: PointCloud(np.zeros((0, 3))), "points: must contain at least one point"),
    "a body": (
        lambda: PlacedShape.in_world("a#0", Body.of_shape("ball", Sphere(1.0), mass=1.0)),
        r"a#0.shape: must be a Shape \(got 'Body'\)",
    ),
    "reflection": (
        lambda: PlacedShape.in_world("a#0", Sphere(1.0), R=np.diag([1.0, 1.0, -1.0])),
        "a#0.R: must be a rotation",
    ),
    "shear": (
        lambda: PlacedShape.in_world("a#0", Sphere(1.0), R=SHEARED),
        "a#0.R: must be a rotation",
    ),
}


@cases("make, words", REFUSED)
def test_an_impossible_shape_is_refused(make, words):
    with pytest.raises(ModelError, match=words):
        make()


def test_lengths_are_halves_or_wholes_of_at_least_a_proton_s():
    assert Cylinder(0.1, length=0.4) == Cylinder(0.1, 0.2)
    assert Capsule(0.1, length=0.4) == Capsule(0.1, 0.2)
    for shape in (Box, Ellipsoid):
        assert shape(size=(0.2, 0.4, 0.6)) == shape((0.1, 0.2, 0.3))
    assert Sphere(1e-15).radius == 1e-15


@pytest.mark.parametrize("scale", [1e-200, 1.0, 3.0, 1e200])
def test_a_half_space_is_the_same_solid_at_any_length_of_its_normal(scale):
    shape = HalfSpace(scale * np.array([3.0, 0.0, 4.0]), scale * 10.0)
    assert_within(shape.normal, [0.6, 0.0, 0.8])
    assert_within(shape.offset, 2.0)


def test_a_repeated_point_of_a_cloud_counts_once():
    corners = np.array([[x, y, z] for z in (0, 1) for y in (0, 1) for x in (1, -0.0)])
    thrice = np.concatenate([corners, corners[::-1] + 0.0, corners])
    assert PointCloud(thrice).points.tolist() == corners.tolist()
    assert PointCloud(corners).points.tolist() == corners.tolist()


def test_words_say_the_box_about_points_and_no_zero_is_negative():
    points = np.array([[0.5, 0, 0], [2, 0, 0], [0, 3, 0], [0, 0, 4]])
    assert convex_hull(points).words().endswith("within 2 x 3 x 4 m")
    assert PointCloud(points).words().endswith("within 2 x 3 x 4 m")
    floor = HalfSpace((-0.0, 0.0, 1.0), 0.0)
    assert "(0, 0, 1)" in floor.words()
