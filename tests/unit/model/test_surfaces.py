"""Points that are drawn of a shape: they lie on it, and their hull is as large as it."""

import numpy as np
import pytest
from scipy.spatial import ConvexHull

from quasistatic_ref.contact.cloud import signed_distance
from quasistatic_ref.model.convex_mesh import convex_hull
from quasistatic_ref.model.shapes import (
    Box,
    Capsule,
    Cone,
    Cylinder,
    Ellipsoid,
    HalfSpace,
    PointCloud,
    Sphere,
)
from quasistatic_ref.model.solids.shape import ball, circle
from tests.tolerances import CLOSED_FORM, EXACT, ROUNDING

AROUND, UP = 8, 6
"""The first circle point comes again at the end: seven corners, which no quarter turn maps to
themselves."""

CORNERS = AROUND - 1
POLYGON = CORNERS / 2 * np.sin(2 * np.pi / CORNERS)
"""Area of the regular polygon in the unit circle: a triangle of sides 1, 1 for each corner."""

_Z = np.linspace(-1, 1, UP)
_R = np.sqrt(1 - _Z**2)
LAYERS = POLYGON * np.sum(np.diff(_Z) * (_R[1:] ** 2 + _R[1:] * _R[:-1] + _R[:-1] ** 2) / 3)
"""Volume of the hull of such polygons at heights z_j with radii r_j: one frustum on the other."""

SHAPES = {
    "box": (Box([0.1, 0.2, 0.3]), 8 * 0.1 * 0.2 * 0.3),
    "sphere": (Sphere(0.2), 0.2**3 * LAYERS),
    "ellipsoid": (Ellipsoid([0.1, 0.2, 0.3]), 0.1 * 0.2 * 0.3 * LAYERS),
    "cylinder": (Cylinder(0.2, 0.3), POLYGON * 0.2**2 * 2 * 0.3),
    "cone": (Cone(0.2, 0.3), POLYGON * 0.2**2 * 2 * 0.3 / 3),
    # Between its two balls, moved apart by 2 half_length, is a prism over the widest polygon.
    "capsule": (Capsule(0.2, 0.3), 0.2**3 * LAYERS + POLYGON * (0.2 * _R.max()) ** 2 * 2 * 0.3),
}
"""A shape, and the volume of the hull of its points [m^3]."""


@pytest.mark.parametrize(("shape", "volume"), SHAPES.values(), ids=SHAPES)
def test_points_to_draw_lie_on_the_shape_and_span_it(shape, volume) -> None:
    points = shape.surface(AROUND, UP)
    phi, _ = signed_distance(shape, points)
    inside = isinstance(shape, Capsule)  # where the balls overlap
    np.testing.assert_allclose(np.maximum(phi, 0) if inside else phi, 0, rtol=0, atol=CLOSED_FORM)
    np.testing.assert_allclose(ConvexHull(points).volume, volume, rtol=ROUNDING)


def test_the_tip_of_a_cone_points_along_z() -> None:
    points = Cone(0.2, 0.3).surface(AROUND, UP)
    np.testing.assert_allclose(points[:, 2].max(), 0.3, rtol=EXACT)
    assert np.count_nonzero(points[:, 2] > 0) == 1


def test_circles_start_on_the_x_axis_and_turn_about_z() -> None:
    """Point k of a circle is w^k in the plane of x and y, w = exp(2 pi i / corners)."""
    powers = np.exp(2j * np.pi * np.arange(AROUND) / CORNERS)
    for points, heights in ((circle(AROUND), [0.0]), (ball(AROUND, UP), _Z)):
        rows = points.reshape(len(heights), AROUND, 3)
        for row, z in zip(rows, heights, strict=True):
            flat = row[:, 0] + 1j * row[:, 1]
            np.testing.assert_allclose(flat, np.sqrt(1 - z**2) * powers, rtol=0, atol=ROUNDING)
            np.testing.assert_allclose(row[:, 2], z, rtol=EXACT)


def test_a_mesh_of_another_size_has_the_hull_of_its_corners_of_that_size() -> None:
    """Lengths times 2 and their cube: powers of two, so that all is exact."""
    corners = Box([0.1, 0.2, 0.3]).surface(AROUND, UP)
    small, large = convex_hull(corners), convex_hull(2 * corners)
    resized = small.resized(2.0)
    np.testing.assert_array_equal(resized.vertices, large.vertices)
    np.testing.assert_array_equal(np.sort(resized.offsets), np.sort(large.offsets))
    np.testing.assert_allclose(resized.volume, 8 * small.volume, rtol=EXACT)


def test_words_have_the_edges_of_the_box_about_the_points() -> None:
    corners = Box([0.1, 0.2, 0.3]).surface(AROUND, UP)
    assert convex_hull(corners).words().endswith("8 corners within 0.2 x 0.4 x 0.6 m")
    assert PointCloud(corners).words() == "cloud of 8 points within 0.2 x 0.4 x 0.6 m"


def test_words_of_a_half_space_have_no_negative_zero() -> None:
    assert HalfSpace([-0.0, 0.0, 1.0], 0.5).words() == "half-space below (0, 0, 1) . x = 0.5 m"
