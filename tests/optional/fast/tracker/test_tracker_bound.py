"""What is promised of the points that a short list leaves out, with points at the very bounds."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from quasistatic_ref.optional.fast.tracker import ball_tree
from quasistatic_ref.optional.fast.tracker.tracker_bound import (
    reach,
    shortlist,
    size,
)
from quasistatic_ref.shapes.convex_mesh import convex_hull
from quasistatic_ref.shapes.placed_shape import (
    HalfSpace,
)
from quasistatic_ref.step.ordered import rotated
from quasistatic_ref.tolerances import UNSEEN
from tests.properties.test_tracker import SHAPES as EVERY
from tests.properties.test_tracker import WEDGE
from tests.tolerances import ROUNDING

X, _, Z = np.eye(3)
SHAPES = {name: shape for name, shape in EVERY.items() if name != "tilted half-space"}
K = 5
WIDTH = 32


@pytest.fixture
def small_leaves(monkeypatch):
    """Trees of several levels, with two points in a ball, already for few points."""
    monkeypatch.setattr(ball_tree, "SMALL", 4)
    monkeypatch.setattr(ball_tree, "LEAF", 2)


def room(shape, points, x):
    """For rounding, relative to the sizes of solid and cloud and their distance [m]."""
    return UNSEEN * (size(shape) + np.abs(points).max() + np.abs(x).max())


def spare(made, shape, points, R, t, n):
    """By how much each point that is left out lies beyond the better of its two bounds [m]."""
    out = np.setdiff1d(np.arange(len(points)), made.index)
    x = rotated(R, points[out]) + t
    by_distance = shape.signed_distance(x)[0] - made.by_distance
    by_height = x @ n - reach(shape, n) - made.by_height
    return np.maximum(by_distance, by_height)


def dumb_bells(rng):
    """Pairs of points, each in line with the origin: the nearer one is where its ball begins."""
    ways = rng.normal(size=(60, 3))
    ways /= np.linalg.norm(ways, axis=1)[:, None]
    far = np.linspace(0.3, 3.0, 60)[:, None]
    return np.concatenate([far * ways, (far + 0.05) * ways])


@pytest.mark.parametrize("name", SHAPES)
@pytest.mark.parametrize("kind", ["dumb bells", "random", "sheet"])
def test_points_left_out_lie_beyond_a_bound_with_room_for_rounding(name, kind, rng, small_leaves):
    shape = SHAPES[name]
    tightest = np.inf
    for _ in range(5):
        points = dumb_bells(rng) if kind == "dumb bells" else rng.uniform(-1, 1, size=(300, 3))
        if kind == "sheet":
            points[:, 2] *= 1e-3
        R = Rotation.random(rng=rng).as_matrix()
        t = rng.uniform(-0.3, 0.3, size=3)
        x = rotated(R, points) + t
        phi, normal = shape.signed_distance(x)
        n = shape.normal if isinstance(shape, HalfSpace) else normal[phi.argmin()]
        made = shortlist(ball_tree.ball_tree(points), shape, R, t, n, np.inf, K, WIDTH)
        beyond = spare(made, shape, points, R, t, n)
        assert K <= len(made.index) < len(points)
        assert beyond.min() >= (1 - 1e-3) * room(shape, points, x)
        tightest = min(tightest, beyond.min())
    assert tightest < 1.0  # the bounds say something


def test_a_solid_s_size_is_no_less_than_it_reaches_in_any_direction():
    for shape in (*SHAPES.values(), convex_hull(-WEDGE)):
        if not isinstance(shape, HalfSpace):
            reaches = [reach(shape, sign * axis) for axis in np.eye(3) for sign in (1, -1)]
            assert size(shape) >= max(reaches)


@pytest.mark.parametrize("name", SHAPES)
def test_no_point_left_out_comes_below_the_limit_at_any_motion(name, rng):
    shape = SHAPES[name]
    tightest = np.inf
    points = rng.uniform(-0.2, 0.2, size=(300, 3))
    n = Z
    phi = points[:, 2]
    if not isinstance(shape, HalfSpace):
        phi, normal = shape.signed_distance(points + Z)
        n = normal[phi.argmin()]
    made = shortlist(ball_tree.ball_tree(points), shape, np.eye(3), Z, n, np.inf, K, WIDTH)
    out = np.setdiff1d(np.arange(300), made.index)
    for scale in (1e-6, 1e-3, 0.1, 1.0) * 10:
        R = Rotation.from_rotvec(scale * rng.normal(size=3)).as_matrix()
        t = Z + scale * rng.normal() * (n if scale < 1e-2 else rng.normal(size=3))
        limit = made.limit(np.column_stack([R, t]))
        above = shape.signed_distance(rotated(R, points[out]) + t)[0].min() - limit
        assert above > 0
        tightest = min(tightest, above)
    assert tightest < 1e-2


def test_the_limit_of_a_falling_cloud_is_the_next_height_less_the_room():
    # A column of points above a floor, each 1 mm above the other, of which the lowest 32 are
    # listed: the next is at 32 mm, and comes down with the cloud.
    points = np.outer(1e-3 * np.arange(100), Z)
    floor = HalfSpace(Z, 0.0)
    tree = ball_tree.ball_tree(points)
    made = shortlist(tree, floor, np.eye(3), np.zeros(3), Z, np.inf, K, WIDTH)
    assert made.index.tolist() == list(range(WIDTH))
    for down in (0.0, 0.01, 0.5):
        limit = made.limit(np.column_stack([np.eye(3), -down * Z]))
        least = 2 * UNSEEN * 0.099  # sizes of the cloud, and of where it was
        assert (
            least - ROUNDING <= 1e-3 * WIDTH - down - limit <= least + 2 * UNSEEN * down + ROUNDING
        )
