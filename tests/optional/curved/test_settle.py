"""Normals that are off settle on the maximum of the gap near them."""

import numpy as np
import pytest

from quasistatic_ref import Box, ContactError, Cylinder
from quasistatic_ref.contact.shape_in_world import ShapeInWorld, Witness
from quasistatic_ref.contact.solids.solid_pair import solid_pair
from quasistatic_ref.optional.curved import by_coal
from quasistatic_ref.optional.curved.settle import settled
from tests.closeness import assert_within
from tests.contact.solids.test_curved_pair import HERE, PAIRS, SOLIDS
from tests.oracles import closest
from tests.tolerances import CURVED_PAIR

UP = np.array([0.0, 0.0, 1.0])


@pytest.mark.parametrize("names", PAIRS, ids="-".join)
def test_a_normal_that_is_off_by_a_thousandth_settles_where_it_was(names):
    a, b = (SOLIDS[name] for name in names)
    random = np.random.default_rng(4)
    settles = 0
    for R, t in closest.poses(6, 29):
        here = ShapeInWorld(a, *HERE)
        there = ShapeInWorld(b, R, t)
        try:
            phi, alpha, beta, n = solid_pair("p", here, there)
        except ContactError:
            continue
        off = n + 3e-4 * random.normal(size=3)
        start = Witness(phi, alpha, beta, off / np.linalg.norm(off))
        gaps = [by_coal.judged(here, there, *way) for way in settled(here, there, start)]
        settles += any(
            way.defect <= CURVED_PAIR and abs(way.phi - phi) <= CURVED_PAIR for way in gaps
        )
    assert settles >= 5


def test_points_of_faces_that_lie_flat_on_each_other_are_those_of_the_start():
    """A cylinder on a box: any point of the disc will do, so that the one asked for is taken."""
    low = ShapeInWorld(Box((0.2, 0.2, 0.1)), *HERE)
    top = ShapeInWorld(Cylinder(0.1, 0.05), np.eye(3), np.array([0.15, 0.0, 0.16]))
    start = Witness(0.01, np.array([0.13, 0.02, 0.1]), np.array([0.15, 0.04, 0.11]), UP)
    for found in settled(low, top, start):
        expected = 0.01, [0.14, 0.03, 0.1], [0.14, 0.03, 0.11], UP
        for one, two in zip(found, expected, strict=True):
            assert_within(one, two, CURVED_PAIR)


@pytest.mark.parametrize("sine", [0.6, 1e-5])
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
    assert_within(best.alpha, [x, 0, 0.1], 1e-10)
