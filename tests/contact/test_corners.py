"""Corners of solids and how far solids extend; in which order corners are candidates."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from quasistatic_ref.contact.distance import ClosestPoints, _towards, late
from quasistatic_ref.contact.shape_in_world import ShapeInWorld
from quasistatic_ref.shapes.convex_mesh import convex_hull
from quasistatic_ref.shapes.placed_shape import (
    Box,
    Capsule,
    Cone,
    Cylinder,
    Ellipsoid,
    HalfSpace,
    PointCloud,
    Shape,
)
from quasistatic_ref.tolerances import ON_RIM, REPEATED, UPRIGHT
from tests.contact.still import found_for, placed, standing
from tests.tolerances import CLOSED_FORM, EXACT, ROUNDING

BOX = Box(np.array([0.1, 0.2, 0.3]))
MESH = convex_hull(np.array([[1.0, 1, 1], [2, 1, 1], [1, 1.5, 1], [1, 1, 1.25]]))
TOWARDS = np.array([0.6, 0.8, 0.0])
# Four points of a circle of radius 0.5 from TOWARDS on, each a quarter turn (x, y) -> (-y, x) after
# the one before.
RIM = [(0.3, 0.4), (-0.4, 0.3), (-0.3, -0.4), (0.4, -0.3)]
CORNERS = {
    "box": (BOX, [(x, y, z) for z in (-0.3, 0.3) for y in (-0.2, 0.2) for x in (-0.1, 0.1)], 0.0),
    "mesh": (MESH, [tuple(corner) for corner in MESH.vertices], 0.0),
    "capsule": (Capsule(0.5, 0.7), [(0, 0, -0.7), (0, 0, 0.7)], 0.5),
    "cylinder": (Cylinder(0.5, 0.7), [(*p, z) for z in (-0.7, 0.7) for p in RIM], 0.0),
    "cone": (Cone(0.5, 0.7), [(0, 0, 0.7), *((*p, -0.7) for p in RIM)], 0.0),
    "ellipsoid": (Ellipsoid(np.array([0.1, 0.2, 0.3])), [], 0.0),
}


@pytest.mark.parametrize(("shape", "points", "radius"), CORNERS.values(), ids=CORNERS)
def test_corners_are_vertices_ends_and_quarters_of_rims(shape, points, radius) -> None:
    found, ball = shape.corners(TOWARDS)
    assert shape.corner_count == len(points)
    np.testing.assert_allclose(found, np.reshape(points, (-1, 3)), rtol=EXACT, atol=CLOSED_FORM)
    assert ball == radius


def test_an_upright_rim_begins_on_the_x_axis() -> None:
    found, _ = Cone(0.5, 0.7).corners(np.array([0.0, 0.0, -1.0]))
    around = [(0.5, 0, -0.7), (0, 0.5, -0.7), (-0.5, 0, -0.7), (0, -0.5, -0.7)]
    np.testing.assert_allclose(found[1:], around, rtol=EXACT, atol=CLOSED_FORM)


EXTENTS: dict[str, tuple[Shape, float]] = {
    "box": (BOX, 2 * 0.3),
    "mesh away from its origin": (MESH, 2 - 1),
    "ellipsoid": (Ellipsoid(np.array([0.1, 0.4, 0.2])), 2 * 0.4),
    "flat cone": (Cone(0.5, 0.1), 2 * 0.5),
    "slim cone": (Cone(0.5, 0.7), 2 * 0.7),
    "capsule": (Capsule(0.5, 0.7), 2 * (0.5 + 0.7)),
    "cloud": (PointCloud(np.array([[1.0, 3, 5], [1.2, 3.1, 5.3], [1.1, 3, 5]])), 5.3 - 5),
    "half-space": (HalfSpace(np.array([0.0, 0, 1]), 0.1), np.inf),
}


@pytest.mark.parametrize(("shape", "longest"), EXTENTS.values(), ids=EXTENTS)
def test_the_extent_is_the_longest_edge_of_the_box_about_a_shape(shape, longest) -> None:
    np.testing.assert_allclose(shape.extent, longest, rtol=ROUNDING)


@pytest.mark.parametrize("swapped", [False, True])
@pytest.mark.parametrize("lean", [0.3, 1.0])
def test_a_cone_over_a_floor_has_its_tip_and_the_lowest_point_of_its_rim(lean, swapped) -> None:
    # Its axis leans from straight down, the tip first: the tip is h cos(lean) below the middle, and
    # the lowest point of the rim r sin(lean) - h cos(lean). Corner 0 is the tip, and corner 1 the
    # point of the rim that is the farthest towards the floor.
    radius, half_length, height = 0.5, 0.2, 0.4
    R = Rotation.from_rotvec([np.pi - lean, 0, 0]).as_matrix()
    tip = height - half_length * np.cos(lean)
    rim = height - radius * np.sin(lean) + half_length * np.cos(lean)
    floor, cone = placed(HalfSpace(np.eye(3)[2], 0.0)), placed(Cone(radius, half_length), 1)
    sides = (cone, floor) if swapped else (floor, cone)
    found = found_for(*sides, standing((R, np.array([0.1, 0.2, height]))), k=2)
    expected = sorted([(tip, 0), (rim, 1)])
    np.testing.assert_allclose(
        found.phi, [phi for phi, _ in expected], rtol=EXACT, atol=CLOSED_FORM
    )
    assert found.point.tolist() == [corner for _, corner in expected]


def test_of_two_corners_that_are_one_contact_alpha_s_is_kept() -> None:
    # Two equal cubes, one on the other: the four corners of either's face are in the same places.
    # Alpha's corners are 0 to 7 (binary: x lowest), so that its upper ones are 4 to 7.
    lower, upper = placed(Box(np.full(3, 0.25))), placed(Box(np.full(3, 0.25)), 1)
    found = found_for(lower, upper, standing((np.eye(3), np.array([0, 0, 0.5]))), k=4)
    assert sorted(found.point.tolist()) == [4, 5, 6, 7]


def test_the_first_corner_of_a_rim_is_nearest_unless_it_is_level() -> None:
    for tilt, first in ((UPRIGHT, [0.5, 0.0]), (2 * UPRIGHT, [0.0, 0.5])):
        corners, _ = Cylinder(0.5, 0.25).corners(np.array([0.0, tilt, 1.0]))
        np.testing.assert_allclose(corners[0, :2], first, atol=ROUNDING)


def test_candidates_that_differ_by_as_much_as_counts_are_one() -> None:
    # The second is the first again; of two that are as near, the closest pair comes last.
    zero = np.zeros((3, 3))
    for share, expected in ((1.0, [False, True, True]), (2.0, [False, False, False])):
        phi = np.array([share * REPEATED, 0.0, 0.0])
        off = np.array([[0.0, 0, 0], [0, 0, 0], [1, 0, 0]])
        candidates = ClosestPoints(phi, off, zero, zero, np.arange(3), np.zeros(3, dtype=int))
        assert late(candidates, 1 if share == 1.0 else 2).tolist() == expected


def test_a_point_on_a_rim_that_is_not_level_is_the_way_to_the_other() -> None:
    rim, z = ShapeInWorld(Cylinder(0.5, 0.25), np.eye(3), np.zeros(3)), np.array([0.0, 0.0, 1.0])
    y = np.array([0.0, 1.0, 0.0])
    near, off = (0.5 * (1 - share * ON_RIM) * y + 0.25 * z for share in (1.0, 2.0))
    for point, tilt, own in ((near, 0.1, True), (off, 0.1, False), (near, UPRIGHT, False)):
        n = z + tilt * y
        assert np.array_equal(_towards(rim, point, n), point if own else n)
