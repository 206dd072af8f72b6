"""Closest pairs that are left out for corners: those that a motion would bring back are named."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from quasistatic_ref import Box, Cylinder, Sphere, convex_hull
from quasistatic_ref.contact.shape_in_world import ShapeInWorld
from quasistatic_ref.optional.derivatives.contact import spare_pairs
from quasistatic_ref.optional.derivatives.contact.spare_pairs import _face_corners, spare_pair
from quasistatic_ref.optional.derivatives.model.motion_rates import MotionRates
from quasistatic_ref.optional.derivatives.step import reason
from tests.optional.derivatives.contact.test_couples import body, couples_of, pair_of

SLAB = Box((0.3, 0.3, 0.05))
SMALL = Box((0.1, 0.1, 0.05))
LONG = Box((0.2, 0.02, 0.05))
BAR = Box((0.02, 0.2, 0.05))
PYRAMID = convex_hull([[0.1, 0.1, 0], [0.1, -0.1, 0], [-0.1, 0.1, 0], [-0.1, -0.1, 0], [0, 0, 0.1]])
TRIANGLE = [(-0.2, -0.2), (0.05, -0.05), (-0.05, 0.05)]
PRISM = convex_hull([[x, y, z] for x, y in TRIANGLE for z in (-0.05, 0.05)])


def kind(lower, upper, xyz, first, k):
    """The jump's kind of an upper shape at xyz over a lower one at the origin, or None."""
    system = body(xyz)
    points, found = couples_of(system, pair_of(system, lower, upper, first, k))
    rates = MotionRates(system.kinematics(system.q_start), system.column_map)
    jump = spare_pair(found, points, rates.J)
    return None if jump is None else jump[0]


@pytest.mark.parametrize("first", ["fixed", "body"])
@pytest.mark.parametrize(
    ("lower", "upper", "xyz", "k", "expected"),
    [
        # All four corners of the smaller face are on the larger one: they are all there is.
        (SLAB, SMALL, (0.0, 0.0, 0.101), 4, None),
        (SMALL, SLAB, (0.0, 0.0, 0.101), 4, None),
        (SLAB, PYRAMID, (0.0, 0.0, 0.051), 4, None),
        # Faces that overlap in part: one corner of either, or two of the upper one.
        (SMALL, SMALL, (0.06, 0.05, 0.101), 2, reason.MANY),
        (SLAB, PYRAMID, (0.29, 0.0, 0.051), 2, reason.MANY),
        # The closest pair itself is kept: alone, or with all others.
        (SMALL, SMALL, (0.06, 0.05, 0.101), 1, None),
        (SMALL, SMALL, (0.06, 0.05, 0.101), 25, None),
        # Faces cross without any corner: their crossings are.
        (BAR, LONG, (0.0, 0.0, 0.101), 4, reason.MANY),
    ],
)
def test_parallel_faces_jump_unless_the_smaller_lies_on_the_larger(
    lower, upper, xyz, k, expected, first
):
    assert kind(lower, upper, xyz, first, k) == expected


def test_a_unique_closest_pair_stays_where_it_is_whatever_corners_are_as_near(monkeypatch):
    """A tip over a slab."""
    monkeypatch.setattr(spare_pairs, "_covered", lambda of: False)
    tip = convex_hull(-np.array([*PYRAMID.vertices]))
    assert kind(SLAB, tip, (0.0, 0.0, 0.151), "fixed", 2) is None


DISC = Cylinder(0.5, 0.2)
CORNERS_FARTHEST_ALONG = [
    (Box((0.5, 0.3, 0.2)), (0, 0, 1), 4),
    (Box((0.5, 0.3, 0.2)), (0, 1, 1), 2),
    (Box((0.5, 0.3, 0.2)), (1, 1, 1), 1),
    (DISC, (0, 0, 1), 1),  # its rim is a curve, whose corners stand for its face together
    (DISC, (1, 0, 0), 2),
    (DISC, (1, 0, 1), 1),
    (Sphere(0.5), (0, 0, 1), 1),
]


@pytest.mark.parametrize("scale", [1e-4, 1.0, 1e4])
@pytest.mark.parametrize(("shape", "way", "count"), CORNERS_FARTHEST_ALONG)
def test_corners_of_a_face_are_counted_at_every_size(shape, way, count, scale):
    R = Rotation.from_rotvec([0.3, -0.5, 0.8]).as_matrix()
    lengths = {name: scale * length for name, length in vars(shape).items()}
    there = ShapeInWorld(type(shape)(**lengths), R, np.ones(3))
    assert _face_corners(there, R @ (np.array(way) / np.linalg.norm(way))) == count


def test_corners_of_one_face_do_not_stand_for_those_of_the_other():
    # Two of the three corners of the prism's face are on the box, and the box's first corner is on
    # the prism's face: three corners touch, but not all of either face.
    assert kind(PRISM, SMALL, (0.0, 0.0, 0.101), "fixed", 2) == reason.MANY
    assert kind(PRISM, SMALL, (0.0, 0.0, 0.101), "body", 2) == reason.MANY
