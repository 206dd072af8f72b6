"""The tree of a cloud: how many balls, and that they are the least about what they hold."""

import itertools

import numpy as np
import pytest

from quasistatic_ref.optional.fast.tracker.ball_tree import ball_tree
from tests.tolerances import ROUNDING

SMALL_TREES = {
    # points: numbers of balls of the levels, with at most 4 on top and 2 points in a ball
    1: [1],
    4: [4],
    5: [4, 8],
    8: [4, 8],
    9: [4, 8, 16],
    33: [4, 8, 16, 32, 64],
}


@pytest.mark.parametrize("N", SMALL_TREES)
def test_balls_are_the_least_about_the_middle_of_what_they_hold(N, rng, small_leaves):
    points = rng.normal(loc=(3.0, -2.0, 1.0), size=(N, 3))
    tree = ball_tree(points)
    assert [len(level.centre) for level in tree.levels] == SMALL_TREES[N]
    real = tree.index >= 0
    assert sorted(tree.index[real]) == list(range(N))
    arranged = tree.levels[-1].centre
    np.testing.assert_array_equal(arranged[real], points[tree.index[real]])
    for level in tree.levels:
        held = arranged.reshape(len(level.centre), -1, 3)
        low = held.min(axis=1)
        high = held.max(axis=1)
        np.testing.assert_array_equal(level.centre, (low + high) / 2)
        np.testing.assert_array_equal(level.half_extents, (high - low) / 2)
        away = np.linalg.norm(held - level.centre[:, None], axis=2).max(axis=1)
        np.testing.assert_allclose(level.radius, away, rtol=ROUNDING)
        some = real.reshape(len(level.centre), -1).any(axis=1)
        np.testing.assert_array_equal(level.far_side, np.where(some, level.radius, np.inf))
    corners = itertools.product(*zip(points.min(axis=0), points.max(axis=0), strict=True))
    assert sorted(map(tuple, tree.box)) == sorted(corners)
