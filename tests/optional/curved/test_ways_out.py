"""Ways out of a solid: the faces of a polytope from a small ellipsoid inside, the nearest first."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from quasistatic_ref import Box, Ellipsoid, convex_hull
from quasistatic_ref.contact.separations import gaps
from quasistatic_ref.contact.shape_in_world import ShapeInWorld
from quasistatic_ref.contact.solids.polytope import polytope
from quasistatic_ref.optional.curved.ways_out import (
    APART,
    REACH,
    STARTS,
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


def test_a_smooth_way_out_between_all_axes_is_near_a_sample():
    """Discs tilted by 0.35 and -0.35 about x: the sum of their reaches is least along z and -z."""
    tilted = [Rotation.from_rotvec([angle, 0, 0]).as_matrix() for angle in (0.35, -0.35)]
    disc = Ellipsoid((0.1, 0.1, 0.05))
    a, b = (ShapeInWorld(disc, tilt, AT) for tilt in tilted)
    z = np.array([0.0, 0.0, 1.0])
    (found,) = rival_directions(a, b, z, float(gaps(a, b, z[None])[0]), 0.05)
    assert found @ -z > np.cos(REACH)
