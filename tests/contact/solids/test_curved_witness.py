"""Closest points of every feature of a polytope or cylinder with a curved solid, by construction.

Two points are closest if and only if the line between them is a normal of both solids. So a solid
is put with its farthest point towards the other a distance away, along a normal of the other.
"""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from quasistatic_ref.contact.shape_in_world import ShapeInWorld, Witness
from quasistatic_ref.contact.solids.solid_pair import solid_pair
from quasistatic_ref.shapes.convex_mesh import convex_hull
from quasistatic_ref.shapes.placed_shape import Box, Capsule, Cone, Cylinder, Ellipsoid, Shape
from tests.contact.solids.test_curved_pairs import enlarged
from tests.tolerances import CURVED_PAIR, EXACT, FOUR_ULP, ROUNDING, WAY_OUT

WEDGE = 0.1 * np.array([[0, 0, 0], [2, 0, 0], [0, 2, 0], [0, 0, 2.0]])


def along(x: float, y: float, z: float) -> np.ndarray:
    return np.array([x, y, z]) / np.linalg.norm([x, y, z])


BOX, MESH = Box(np.array([0.03, 0.05, 0.08])), convex_hull(WEDGE)
CAPSULE, CYLINDER = Capsule(0.03, 0.05), Cylinder(0.05, 0.08)
FEATURES = {
    "corner of a box": (BOX, (0.03, -0.05, 0.08), along(1, -2, 3)),
    "edge of a box": (BOX, (0.03, 0.01, -0.08), along(1, 0, -2)),
    "face of a box": (BOX, (0.01, -0.05, 0.02), along(0, -1, 0)),
    "corner of a mesh": (MESH, (0.2, 0, 0), along(3, 1, -1)),
    "edge of a mesh": (MESH, (0.05, 0, 0), along(0, -1, -2)),
    "slanting edge of a mesh": (MESH, (0.05, 0.15, 0), along(2, 2, 1)),
    "face of a mesh": (MESH, (0.05, 0.08, 0.07), along(1, 1, 1)),
    "cap of a capsule": (CAPSULE, 0.03 * along(1, 2, -3) - [0, 0, 0.05], along(1, 2, -3)),
    "side of a capsule": (CAPSULE, 0.03 * along(1, 2, 0) + [0, 0, 0.01], along(1, 2, 0)),
    "cap of a cylinder": (CYLINDER, (0.01, 0.02, -0.08), along(0, 0, -1)),
    "side of a cylinder": (CYLINDER, 0.05 * along(1, -3, 0) + [0, 0, 0.02], along(1, -3, 0)),
    "rim of a cylinder": (CYLINDER, 0.05 * along(-1, 3, 0) + [0, 0, 0.08], along(-1, 3, 2)),
    "other rim of a cylinder": (CYLINDER, 0.05 * along(1, 2, 0) - [0, 0, 0.08], along(1, 2, -2)),
}
"""A solid, a point of it, and an outward normal there, in its own frame."""
OTHERS = Ellipsoid(np.array([0.03, 0.05, 0.08])), Cone(0.05, 0.08)


def put(
    feature: str, other: Shape, distance: float, scale: float = 1.0
) -> tuple[ShapeInWorld, ...]:
    """A solid and another next to one of its features."""
    solid, point, own = FEATURES[feature]
    R, S = Rotation.from_euler("xyz", [[0.3, -0.7, 1.1], [1.0, 0.4, 0.2]]).as_matrix()
    t, n = scale * np.array([0.1, 0.2, 0.3]), R @ own
    alpha = scale * R @ point + t
    beta = alpha + distance * n
    there = ShapeInWorld(enlarged(other, scale), S, np.zeros(3))
    there = there._replace(t=beta - S @ there.shape.support_point(S.T @ -n))
    return ShapeInWorld(enlarged(solid, scale), R, t), there, Witness(distance, alpha, beta, n)


@pytest.mark.parametrize("other", OTHERS, ids=["ellipsoid", "cone"])
@pytest.mark.parametrize("feature", FEATURES)
def test_closest_points_are_found_at_every_feature(feature, other) -> None:
    for distance in (0.02, 1e-6):
        here, there, expected = put(feature, other, distance)
        for found in (solid_pair("p", here, there), solid_pair("p", there, here).swapped()):
            np.testing.assert_allclose(found.phi, distance, rtol=EXACT, atol=ROUNDING)
            for one, two in zip(found[1:], expected[1:], strict=True):
                np.testing.assert_allclose(one, two, rtol=EXACT, atol=WAY_OUT)


@pytest.mark.parametrize("scale", [1e-3, 1.0, 1e3])
def test_closest_points_are_found_at_every_scale(scale) -> None:
    for feature in ("edge of a box", "side of a cylinder"):
        here, there, expected = put(feature, OTHERS[0], 0.02 * scale, scale)
        found = solid_pair("p", here, there)
        np.testing.assert_allclose(found.phi, expected.phi, rtol=ROUNDING)


def test_a_normal_at_an_edge_has_length_one_however_near_the_contact() -> None:
    for feature in ("edge of a box", "edge of a mesh", "slanting edge of a mesh"):
        found = solid_pair("p", *put(feature, OTHERS[1], 1e-11)[:2])
        np.testing.assert_allclose(found.phi, 1e-11, rtol=EXACT, atol=CURVED_PAIR)
        np.testing.assert_allclose(found.n @ found.n, 1, rtol=FOUR_ULP)
