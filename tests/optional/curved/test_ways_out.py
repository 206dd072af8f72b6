"""Ways out of a solid: the faces of a polytope from a small ellipsoid inside, the nearest first."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from quasistatic_ref.contact.separations import gaps
from quasistatic_ref.contact.shape_in_world import ShapeInWorld
from quasistatic_ref.contact.solids.polytope import polytope
from quasistatic_ref.optional.curved.ways_out import APART, REACH, STARTS, rival_directions
from quasistatic_ref.shapes.convex_mesh import convex_hull
from quasistatic_ref.shapes.placed_shape import Box, Ellipsoid
from tests.tolerances import EXACT, ROUNDING

R, S = Rotation.from_euler("xyz", [[0.3, -0.7, 1.1], [1.0, 0.4, 0.2]]).as_matrix()
AT = np.array([0.1, 0.2, 0.3])
HALF_AXES = np.array([0.02, 0.021, 0.022])
POLYTOPES = {
    "box": (Box(np.array([0.1, 0.12, 0.14])), np.array([0.01, 0.015, 0.018])),
    "mesh": (convex_hull([[0, 0, 0], [0.2, 0, 0], [0, 0.2, 0], [0, 0, 0.2]]), np.full(3, 0.045)),
}
"""A polytope, and the middle of the ellipsoid in its frame."""


@pytest.mark.parametrize("turned_round", [False, True])
@pytest.mark.parametrize("name", POLYTOPES)
def test_ways_out_of_a_polytope_are_its_normals_the_shortest_first(name, turned_round) -> None:
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
    np.testing.assert_allclose(gaps(*sides, ways), expected, rtol=EXACT, atol=ROUNDING)
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
        np.testing.assert_allclose(away.min(axis=0), 0, rtol=EXACT, atol=ROUNDING)
        # None is near another, or near the first: on ridges some are local maxima of the spread.
        cosines = np.vstack([found, first]) @ found.T
        assert (cosines[~np.eye(*cosines.shape, dtype=bool)] < APART).all()
        assert len(found) <= STARTS
