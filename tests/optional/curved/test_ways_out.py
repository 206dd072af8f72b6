"""Ways out of a solid: the faces of a polytope from a small ellipsoid inside, the nearest first."""

import numpy as np
import pytest
from scipy.spatial import ConvexHull, KDTree
from scipy.spatial.transform import Rotation

from quasistatic_ref import Box, Cone, Cylinder, Ellipsoid, convex_hull
from quasistatic_ref.contact.separations import gaps
from quasistatic_ref.contact.shape_in_world import ShapeInWorld, Witness
from quasistatic_ref.contact.solids.polytope import polytope
from quasistatic_ref.optional.curved.ways_out import (
    APART,
    REACH,
    STARTS,
    _sphere,
    known_gaps,
    rival_directions,
)
from tests.closeness import assert_within
from tests.tolerances import ROUNDING

R, S = Rotation.from_euler("xyz", [[0.3, -0.7, 1.1], [1.0, 0.4, 0.2]]).as_matrix()
AT = np.array([0.1, 0.2, 0.3])
HALF_AXES = np.array([0.02, 0.021, 0.022])
POLYTOPES = {
    "box": (Box((0.1, 0.12, 0.14)), np.array([0.01, 0.015, 0.018])),
    "mesh": (convex_hull([[0, 0, 0], [0.2, 0, 0], [0, 0.2, 0], [0, 0, 0.2]]), np.full(3, 0.045)),
}
"""A polytope, and the middle of the ellipsoid in its frame."""


@pytest.mark.parametrize("turned_round", [False, True])
@pytest.mark.parametrize("name", POLYTOPES)
def test_ways_out_of_a_polytope_are_its_normals_the_shortest_first(name, turned_round):
    shape, middle = POLYTOPES[name]
    solid = ShapeInWorld(shape, R, AT)
    inside = ShapeInWorld(Ellipsoid(HALF_AXES), S, R @ middle + AT)
    flat = polytope(shape)
    assert flat is not None
    normals = flat.normals @ R.T
    # A face's plane is its offset from the origin, and the ellipsoid reaches |E S' n| behind it.
    expected = flat.normals @ middle - flat.offsets
    expected = expected - np.linalg.norm((normals @ S) * HALF_AXES, axis=1)
    sides = (inside, solid) if turned_round else (solid, inside)
    ways = -normals if turned_round else normals
    assert_within(gaps(*sides, ways), expected, ROUNDING)
    order = np.argsort(-expected)
    first = ways[order[0]]
    phi = float(expected[order[0]])
    for left in (1, 2):
        # Gaps as wide as that of the first but for REACH * size are looked at.
        least = (expected[order[left]] + expected[order[left + 1]]) / 2
        found = np.array(rival_directions(*sides, first, phi, (phi - least) / REACH))
        assert (np.diff(gaps(*sides, found)) <= 0).all()
        assert gaps(*sides, found).min() > least
        away = np.linalg.norm(found[:, None] - ways[order[1 : left + 1]], axis=2)
        assert_within(away.min(axis=0), 0, ROUNDING)
        # None is near another, or near the first: on ridges some are local maxima of the spread.
        cosines = np.vstack([found, first]) @ found.T
        assert (cosines[~np.eye(*cosines.shape, dtype=bool)] < APART).all()
        assert len(found) <= STARTS


def test_six_ways_of_eight_are_followed():
    solid = ShapeInWorld(convex_hull(0.1 * np.concatenate([np.eye(3), -np.eye(3)])), R, AT)
    inside = ShapeInWorld(Ellipsoid(HALF_AXES), S, AT)
    first = R @ np.ones(3) / np.sqrt(3)
    found = rival_directions(solid, inside, first, 0.0, 10.0)
    assert len(found) == STARTS == 6


def test_a_smooth_way_out_between_all_axes_is_near_a_sample():
    """Discs tilted by 0.35 and -0.35 about x: the sum of their reaches is least along z and -z."""
    tilted = [Rotation.from_rotvec([angle, 0, 0]).as_matrix() for angle in (0.35, -0.35)]
    disc = Ellipsoid((0.1, 0.1, 0.05))
    a, b = (ShapeInWorld(disc, tilt, AT) for tilt in tilted)
    z = np.array([0.0, 0.0, 1.0])
    (found,) = rival_directions(a, b, z, float(gaps(a, b, z[None])[0]), 0.05)
    assert found @ -z > np.cos(REACH)


def test_samples_are_unit_vectors_everywhere_with_eight_neighbours():
    sphere, neighbours = _sphere()
    assert_within(np.linalg.norm(sphere, axis=1), 1.0, ROUNDING)
    # The plane of a facet of the hull cuts off the largest empty cap about its normal.
    holes = np.arccos(-ConvexHull(sphere).equations[:, 3])
    assert 0.99 * REACH < holes.max() < REACH
    own_and_eight = KDTree(sphere).query(sphere, 9)[0]
    away = np.linalg.norm(sphere[neighbours] - sphere[:, None], axis=2)
    assert_within(away, own_and_eight[:, 1:], ROUNDING)


def test_known_gaps_are_along_axes_and_the_normals_of_faces_at_the_closest_points():
    """Of a cone that rises by 2 h over its radius r, above a cylinder."""
    a = ShapeInWorld(Cylinder(0.1, 0.2), R, AT)
    b = ShapeInWorld(Cone(0.3, 0.2), S, np.array([0.0, 0.3, 0.4]))
    around = np.array([0.6, -0.8, 0.0])
    slant = np.array([0.4 * 0.8, 0.4 * 0.6, 0.3]) / 0.5
    alpha = R @ (0.1 * around + [0, 0, 0.05]) + a.t
    beta = S @ [0.15 * 0.8, 0.15 * 0.6, 0.0] + b.t
    found, ways = known_gaps(a, b, Witness(0.0, alpha, beta, R[:, 2]))
    z = np.eye(3)[2]
    axes = np.concatenate([np.eye(3), -np.eye(3)])
    expected = [axes @ R.T, -axes @ S.T, [around, z, -z] @ R.T, -np.array([slant, -z]) @ S.T]
    assert_within(ways, np.concatenate(expected), ROUNDING)
    # A cylinder reaches r |n_xy| + h |n_z| along n, a cone h n_z or r |n_xy| - h n_z.
    n = ways @ R
    of_cylinder = 0.1 * np.hypot(n[:, 0], n[:, 1]) + 0.2 * abs(n[:, 2])
    n = -ways @ S
    of_cone = np.maximum(0.2 * n[:, 2], 0.3 * np.hypot(n[:, 0], n[:, 1]) - 0.2 * n[:, 2])
    expected_gaps = ways @ (b.t - a.t) - of_cylinder - of_cone
    assert_within(found, expected_gaps, ROUNDING)
