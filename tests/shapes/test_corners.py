"""Corners of solids and how far solids extend; in which order corners are candidates."""

import numpy as np
import pytest

from quasistatic_ref import (
    Box,
    Capsule,
    Cone,
    Cylinder,
    Ellipsoid,
    HalfSpace,
    PointCloud,
    convex_hull,
)
from tests.cases import cases
from tests.closeness import assert_relative, assert_within
from tests.tolerances import CLOSED_FORM

BOX = Box((0.1, 0.2, 0.3))
MESH = convex_hull(np.array([[1.0, 1, 1], [2, 1, 1], [1, 1.5, 1], [1, 1, 1.25]]))
TOWARDS = np.array([0.6, 0.8, 0.0])
TILTED = np.array([0.3, 0.4, -np.sqrt(0.75)])
# Four points of a circle of radius 0.5 from TOWARDS on, each a quarter turn (x, y) -> (-y, x) after
# the one before.
RIM = [(0.3, 0.4), (-0.4, 0.3), (-0.3, -0.4), (0.4, -0.3)]
CORNERS = {
    "box": (BOX, [(x, y, z) for z in (-0.3, 0.3) for y in (-0.2, 0.2) for x in (-0.1, 0.1)], 0.0),
    "mesh": (MESH, [tuple(corner) for corner in MESH.vertices], 0.0),
    "capsule": (Capsule(0.5, 0.7), [(0, 0, -0.7), (0, 0, 0.7)], 0.5),
    "cylinder": (Cylinder(0.5, 0.7), [(*p, z) for z in (-0.7, 0.7) for p in RIM], 0.0),
    "cone": (Cone(0.5, 0.7), [(0, 0, 0.7), *((*p, -0.7) for p in RIM)], 0.0),
    "ellipsoid": (Ellipsoid((0.1, 0.2, 0.3)), [], 0.0),
}


@cases("shape, points, radius", CORNERS)
@pytest.mark.parametrize("towards", [TOWARDS, TILTED], ids=["level", "tilted"])
def test_corners_are_vertices_ends_and_quarters_of_rims(shape, points, radius, towards):
    found, ball = shape.corners(towards)
    assert shape.corner_count == len(points)
    assert_within(found, np.reshape(points, (-1, 3)), CLOSED_FORM)
    assert ball == radius


def test_an_upright_rim_begins_on_the_x_axis():
    found, _ = Cone(0.5, 0.7).corners(np.array([0.0, 0.0, -1.0]))
    around = [(0.5, 0, -0.7), (0, 0.5, -0.7), (-0.5, 0, -0.7), (0, -0.5, -0.7)]
    assert_within(found[1:], around, CLOSED_FORM)


EXTENTS = {
    "mesh away from its origin": (MESH, 2 - 1),
    "flat cone": (Cone(0.5, 0.1), 2 * 0.5),
    "capsule": (Capsule(0.5, 0.7), 2 * (0.5 + 0.7)),
    "cloud": (PointCloud([[1.0, 3, 5], [1.2, 3.1, 5.3], [1.1, 3, 5]]), 5.3 - 5),
    "half-space": (HalfSpace((0.0, 0, 1), 0.1), np.inf),
}


@cases("shape, longest", EXTENTS)
def test_the_extent_is_the_longest_edge_of_the_box_about_a_shape(shape, longest):
    assert_relative(shape.extent, longest)
