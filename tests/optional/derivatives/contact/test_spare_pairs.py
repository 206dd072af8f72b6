"""Closest pairs that are left out for corners: those that a motion would bring back are named."""

import numpy as np
import pytest

from quasistatic_ref.optional.derivatives.contact.spare_pairs import spare_pair
from quasistatic_ref.optional.derivatives.model.motion_rates import MotionRates
from quasistatic_ref.optional.derivatives.step import reason
from quasistatic_ref.shapes.convex_mesh import convex_hull
from quasistatic_ref.shapes.placed_shape import Box
from tests.optional.derivatives.contact.test_couples import body, kept, pair_of

SLAB = Box(np.array([0.3, 0.3, 0.05]))
SMALL = Box(np.array([0.1, 0.1, 0.05]))
LONG = Box(np.array([0.2, 0.02, 0.05]))
BAR = Box(np.array([0.02, 0.2, 0.05]))
PYRAMID = convex_hull([[0.1, 0.1, 0], [0.1, -0.1, 0], [-0.1, 0.1, 0], [-0.1, -0.1, 0], [0, 0, 0.1]])
TRIANGLE = [(-0.2, -0.2), (0.05, -0.05), (-0.05, 0.05)]
PRISM = convex_hull([[x, y, z] for x, y in TRIANGLE for z in (-0.05, 0.05)])


def kind(lower, upper, xyz, first, k):
    """The jump's kind of an upper shape at xyz over a lower one at the origin, or None."""
    system = body(xyz)
    points, found = kept(system, pair_of(system, lower, upper, first, k))
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


def test_corners_of_one_face_do_not_stand_for_those_of_the_other():
    # Two of the three corners of the prism's face are on the box, and the box's first corner is on
    # the prism's face: three corners touch, but not all of either face.
    assert kind(PRISM, SMALL, (0.0, 0.0, 0.101), "fixed", 2) == reason.MANY
    assert kind(PRISM, SMALL, (0.0, 0.0, 0.101), "body", 2) == reason.MANY
