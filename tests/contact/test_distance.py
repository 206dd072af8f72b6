"""Closest points of pairs in the world frame: methods, signs, placements, the guard on coal."""

import numpy as np
import pytest

from quasistatic_ref import Box, ClosestPoints, ContactError, Sphere
from quasistatic_ref.contact.closest_points import joined_contacts
from quasistatic_ref.tolerances import FILLED
from tests.contact.still import found_for, placed_shape, standing_links
from tests.tolerances import EXACT

Z = np.array([0.0, 0.0, 1.0])


def test_a_pose_that_is_not_finite_is_refused():
    sides = placed_shape(Sphere(0.1), 1), placed_shape(Box(np.full(3, 0.2)))
    for pose in ((np.nan * np.eye(3), np.zeros(3)), (np.eye(3), np.full(3, np.inf))):
        with pytest.raises(ContactError, match="poses: must be finite"):
            found_for(*sides, standing_links(pose))


def test_zero_is_never_minus_zero():
    none = np.zeros(1, dtype=int)
    places = np.zeros((2, 1, 3))
    points = ClosestPoints(-np.zeros(1), *places, Z[None], none, none)
    found = joined_contacts([points.swapped()])
    assert np.signbit([*found.phi, *found.n[0]]).tolist() == [False, False, False, True]


def test_copies_of_the_closest_pair_fill_the_number_at_a_distance_that_bears_nothing():
    # A ball above the middle of a face: of the box's 8 corners none has a normal about the pair's.
    ball = placed_shape(Sphere(0.1), 1, t=(0.0, 0.0, 0.4))
    box = placed_shape(Box(np.full(3, 0.2)))
    world = standing_links((np.eye(3), np.zeros(3)))
    found = found_for(ball, box, world, k=4)
    assert found.phi == pytest.approx([0.1, FILLED, FILLED, FILLED], rel=EXACT)
    assert found.point.tolist() == [8, 9, 10, 11]
    assert np.array_equal(found.n, np.tile(-Z, (4, 1)))
    assert found_for(ball, box, world).point.tolist() == [0]
    # A ball 3e6 m away: its copies are twice as far, not nearer than itself.
    plain = placed_shape(Box((1e7, 1e7, 0.2)))
    beyond = found_for(placed_shape(Sphere(0.1), 1, t=(0.0, 0.0, 3e6)), plain, world, k=4).phi
    assert beyond.tolist() == [beyond[0], *[2 * beyond[0]] * 3]
