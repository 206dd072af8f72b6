"""Curved pairs: every feature by construction, every scale, faces that meet on rims.

Two points are closest if and only if the line between them is a normal of both solids. So a solid
is put with its farthest point towards the other a distance away, along a normal of the other.
"""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from quasistatic_ref import Box, Capsule, Cone, ContactError, Cylinder, Ellipsoid, convex_hull
from quasistatic_ref.contact.shape_in_world import ShapeInWorld, Witness
from quasistatic_ref.contact.solids.solid_pair import solid_pair
from quasistatic_ref.lab.vectors.own.shapes import own_shape
from tests.closeness import assert_within
from tests.oracles import closest
from tests.tolerances import CURVED_PAIR, ROUNDING, WAY_OUT

SOLIDS = closest.solids()
PAIRS = [
    names
    for names in closest.pairs()
    if closest.CURVED & set(names) and not {"sphere", "half-space"} & set(names)
]
SMALLER = 1e-5
HERE = np.eye(3), np.zeros(3)


def enlarged(solid, scale):
    return {
        key: value if key == "kind" else (scale * np.array(value)).tolist()
        for key, value in solid.items()
    }


WEDGE = 0.1 * np.array([[0, 0, 0], [2, 0, 0], [0, 2, 0], [0, 0, 2.0]])


def along(x, y, z):
    return np.array([x, y, z]) / np.linalg.norm([x, y, z])


BOX = Box((0.03, 0.05, 0.08))
MESH = convex_hull(WEDGE)
CAPSULE = Capsule(0.03, 0.05)
CYLINDER = Cylinder(0.05, 0.08)
FEATURES = {
    "corner of a box": (BOX, (0.03, -0.05, 0.08), along(1, -2, 3)),
    "edge of a box": (BOX, (0.03, 0.01, -0.08), along(1, 0, -2)),
    "slanting edge of a mesh": (MESH, (0.05, 0.15, 0), along(2, 2, 1)),
    "face of a mesh": (MESH, (0.05, 0.08, 0.07), along(1, 1, 1)),
    "cap of a capsule": (CAPSULE, 0.03 * along(1, 2, -3) - [0, 0, 0.05], along(1, 2, -3)),
    "side of a capsule": (CAPSULE, 0.03 * along(1, 2, 0) + [0, 0, 0.01], along(1, 2, 0)),
    "cap of a cylinder": (CYLINDER, (0.01, 0.02, -0.08), along(0, 0, -1)),
    "side of a cylinder": (CYLINDER, 0.05 * along(1, -3, 0) + [0, 0, 0.02], along(1, -3, 0)),
    "rim of a cylinder": (CYLINDER, 0.05 * along(-1, 3, 0) + [0, 0, 0.08], along(-1, 3, 2)),
}
"""A solid, a point of it, and an outward normal there, in its own frame."""
OTHERS = Ellipsoid((0.03, 0.05, 0.08)), Cone(0.05, 0.08)


def solid_next_to(feature, other, distance):
    """A solid and another next to one of its features."""
    solid, point, own = FEATURES[feature]
    R, S = Rotation.from_euler("xyz", [[0.3, -0.7, 1.1], [1.0, 0.4, 0.2]]).as_matrix()
    t = np.array([0.1, 0.2, 0.3])
    n = R @ own
    alpha = R @ point + t
    beta = alpha + distance * n
    there = ShapeInWorld(other, S, beta - S @ other.support_point(S.T @ -n))
    return ShapeInWorld(solid, R, t), there, Witness(distance, alpha, beta, n)


@pytest.mark.parametrize("other", OTHERS, ids=["ellipsoid", "cone"])
@pytest.mark.parametrize("feature", FEATURES)
def test_closest_points_are_found_at_every_feature(feature, other):
    for distance in (0.02, 1e-6):
        here, there, expected = solid_next_to(feature, other, distance)
        for found in (solid_pair("p", here, there), solid_pair("p", there, here).swapped()):
            assert_within(found.phi, distance, ROUNDING)
            for one, two in zip(found[1:], expected[1:], strict=True):
                assert_within(one, two, WAY_OUT)


@pytest.mark.parametrize("names", PAIRS, ids="-".join)
def test_a_pair_that_is_made_smaller_has_the_same_normal_and_a_smaller_distance(names):
    a, b = (SOLIDS[name] for name in names)
    answered = 0
    for R, t in closest.poses(4, 23):
        try:
            one = solid_pair("p", ShapeInWorld(a, *HERE), ShapeInWorld(b, R, t))
        except ContactError:
            continue
        answered += 1
        A, B = (enlarged(closest.TABLES[name], SMALLER) for name in names)
        there = ShapeInWorld(own_shape(B), R, SMALLER * t)
        other = solid_pair("p", ShapeInWorld(own_shape(A), *HERE), there)
        assert_within(other.phi / SMALLER, one.phi, CURVED_PAIR)
        # Of several normals that are as good, which one is taken may be rounding.
        gap = closest.gap(A, B, R, SMALLER * t, other.n[None])[0]
        assert_within(gap / SMALLER, one.phi, CURVED_PAIR)
    assert answered >= 3


def test_a_hair_of_penetration_is_not_nothing():
    # Two ellipsoids tip to tip, 1.6e-10 m deep: along their common axis, whatever their widths.
    a = Ellipsoid((0.1, 0.05, 0.04))
    b = Ellipsoid((0.2, 0.03, 0.06))
    phi = -1.6e-10
    found = solid_pair(
        "p", ShapeInWorld(a, *HERE), ShapeInWorld(b, np.eye(3), np.array([0.3 + phi, 0, 0]))
    )
    # Two coordinates of 0.3 m are rounded: that of b, and that of its tip.
    assert_within(found.phi, 0.3 + phi - 0.3, 2 * np.spacing(0.3))
    assert_within(found.n, [1, 0, 0], CURVED_PAIR)
