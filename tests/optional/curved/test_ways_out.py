"""Ways out of a solid: the faces of a polytope from a small ellipsoid inside, the nearest first."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from quasistatic_ref.contact.separations import gaps
from quasistatic_ref.contact.shape_in_world import ShapeInWorld
from quasistatic_ref.contact.solids.polytope import polytope
from quasistatic_ref.optional.curved.ways_out import APART, REACH, STARTS, rival_directions
from quasistatic_ref.shapes.convex_mesh import convex_hull
from quasistatic_ref.shapes.placed_shape import Box, Cylinder, Ellipsoid
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


def test_a_way_out_along_an_axis_of_an_ellipsoid_is_that_axis() -> None:
    x = R[:, 0]
    wide = ShapeInWorld(Ellipsoid(np.array([0.1, 0.3, 0.35])), R, AT)
    inside = ShapeInWorld(Ellipsoid(HALF_AXES), S, AT + 0.01 * x)
    (found,) = rival_directions(wide, inside, x, gaps(wide, inside, x[None])[0], 0.5)
    np.testing.assert_allclose(found, -x, rtol=EXACT, atol=ROUNDING)


def test_a_way_out_through_a_side_is_found_between_the_axes() -> None:
    # A small ellipsoid off the axis of a cylinder, by 1 rad from its x axis; the cap is known.
    way = R @ [np.cos(1), np.sin(1), 0]
    cylinder = ShapeInWorld(Cylinder(0.1, 0.12), R, AT)
    inside = ShapeInWorld(Ellipsoid(HALF_AXES), S, AT + 0.05 * way)
    found = rival_directions(cylinder, inside, R[:, 2], -0.14, 0.1)
    # On the ridge of such ways the widest sampled gap need not be the nearest one.
    assert np.arccos(found[0] @ way) <= 2 * REACH


def test_no_more_ways_out_are_followed_than_starts() -> None:
    # From the middle of a hull of twelve points, evenly spread, all faces are as near.
    g = (1 + np.sqrt(5)) / 2
    plane = np.array([[0, s, u * g] for s in (-1, 1) for u in (-1, 1)])
    hull = convex_hull(np.concatenate([np.roll(plane, k, axis=1) for k in range(3)]))
    a = ShapeInWorld(hull, R, AT)
    b = ShapeInWorld(Ellipsoid(HALF_AXES), S, AT)
    assert len(rival_directions(a, b, R[:, 0], -10.0, 1.0)) == STARTS
