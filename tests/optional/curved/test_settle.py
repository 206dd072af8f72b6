"""Points of faces that lie flat, and of lines that cross: where a pair of solids settles."""

import numpy as np
import pytest

from quasistatic_ref import Box, Cylinder
from quasistatic_ref.contact.shape_in_world import ShapeInWorld, Witness
from quasistatic_ref.optional.curved import by_coal
from quasistatic_ref.optional.curved.settle import settled
from tests.closeness import assert_within
from tests.tolerances import CURVED_PAIR

UP = np.array([0.0, 0.0, 1.0])


def test_points_of_faces_that_lie_flat_on_each_other_are_those_of_the_start():
    """A cylinder on a box: any point of the disc will do, so that the one asked for is taken."""
    low = ShapeInWorld(Box((0.2, 0.2, 0.1)), np.eye(3), np.zeros(3))
    top = ShapeInWorld(Cylinder(0.1, 0.05), np.eye(3), np.array([0.15, 0.0, 0.16]))
    start = Witness(0.01, np.array([0.13, 0.02, 0.1]), np.array([0.15, 0.04, 0.11]), UP)
    for found in settled(low, top, start):
        expected = 0.01, [0.14, 0.03, 0.1], [0.14, 0.03, 0.11], UP
        for one, two in zip(found, expected, strict=True):
            assert_within(one, two, CURVED_PAIR)


@pytest.mark.parametrize("sine", [0.6, 1e-5, 0.0])
def test_axes_that_are_nearly_parallel_have_a_normal_across_both(sine):
    """Cylinders one over the other, at a gap: the normal is z, and both lines cross at (x, 0)."""
    x = 0.05
    cosine = np.sqrt(1 - sine**2)
    along_x = np.array([[0.0, 0, 1], [1, 0, 0], [0, 1, 0]])
    skew = np.array([[0.0, -sine, cosine], [0, cosine, sine], [-1, 0, 0]])
    low = ShapeInWorld(Cylinder(0.1, 0.3), along_x, np.zeros(3))
    top = ShapeInWorld(Cylinder(0.05, 0.4), skew, [x, 0, 0.16] + 0.2 * skew[:, 2])
    off = np.array([np.sin(2e-4), np.sin(3e-4), 1.0])
    near = np.array([-0.1, 0.0, 0.1])
    start = Witness(0.01, near, near, off / np.linalg.norm(off))
    ways = [by_coal.judged(low, top, *way) for way in settled(low, top, start)]
    best = min(ways, key=lambda way: way.defect)
    assert best.defect <= CURVED_PAIR
    assert_within(best.n, UP, CURVED_PAIR)
    assert_within(best.alpha[1:], [0, 0.1], 1e-10)
    if sine:  # of parallel lines any point will do
        assert_within(best.alpha[0], x, 1e-10)
