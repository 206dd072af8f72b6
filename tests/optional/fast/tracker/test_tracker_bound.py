"""What is promised of the points that a short list leaves out, with points at the very bounds."""

import itertools

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.optional.fast.tracker import ball_tree
from quasistatic_ref.optional.fast.tracker.tracker import SHORT, ContactTracker
from quasistatic_ref.optional.fast.tracker.tracker_bound import (
    Shortlist,
    shortlist,
    solid_extent,
    support_height,
)
from quasistatic_ref.shapes.convex_mesh import convex_hull
from quasistatic_ref.shapes.placed_shape import (
    HalfSpace,
    PlacedShape,
    PointCloud,
)
from quasistatic_ref.step.ordered import rotated
from quasistatic_ref.tolerances import UNSEEN
from tests.properties.test_tracker import SHAPES as EVERY
from tests.properties.test_tracker import WEDGE
from tests.tolerances import EXACT, ROUNDING

X, _, Z = np.eye(3)
SHAPES = {name: shape for name, shape in EVERY.items() if name != "tilted half-space"}
K = 5
WIDTH = 32


def rounding_margin(shape, points, x):
    """For rounding, relative to the sizes of solid and cloud and their distance [m]."""
    return UNSEEN * (solid_extent(shape) + np.abs(points).max() + np.abs(x).max())


def spare(made, shape, points, R, t, n):
    """By how much each point that is left out lies beyond the better of its two bounds [m]."""
    out = np.setdiff1d(np.arange(len(points)), made.index)
    x = rotated(R, points[out]) + t
    by_distance = shape.signed_distance(x)[0] - made.by_distance
    by_height = x @ n - support_height(shape, n) - made.by_height
    return np.maximum(by_distance, by_height)


def dumb_bells(rng):
    """Pairs of points, each in line with the origin: the nearer one is where its ball begins."""
    ways = rng.normal(size=(60, 3))
    ways /= np.linalg.norm(ways, axis=1)[:, None]
    far = np.linspace(0.3, 3.0, 60)[:, None]
    return np.concatenate([far * ways, (far + 0.05) * ways])


def limit(made, R, t):
    """The least of a list's bounds at a pose: no point that is left out has come below it."""
    slope, offset = made.bounds
    return (slope @ np.column_stack([R, t]).ravel() + offset).min()


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
        assert beyond.min() >= (1 - 1e-3) * rounding_margin(shape, points, x)
        assert limit(made, R, t) > np.sort(phi)[K - 1]
        tightest = min(tightest, beyond.min())
    assert tightest < 1.0  # the bounds say something


def test_points_that_rounding_may_order_otherwise_are_all_in_the_list(rng):
    points = rng.uniform(-1, 1, size=(300, 3))
    points[:, 2] = 0.0
    floor = HalfSpace(Z, 0.0)
    points[:, 2] = rng.uniform(0, 1.9, size=300) * rounding_margin(floor, points, points + Z)
    made = shortlist(ball_tree.ball_tree(points), floor, np.eye(3), Z, Z, np.inf, K, WIDTH)
    assert len(made.index) == 300


def test_a_solid_s_size_is_no_less_than_it_reaches_in_any_direction():
    for shape in (*SHAPES.values(), convex_hull(-WEDGE)):
        if not isinstance(shape, HalfSpace):
            reaches = [support_height(shape, sign * axis) for axis in np.eye(3) for sign in (1, -1)]
            assert solid_extent(shape) >= max(reaches)


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
        lowest = limit(made, R, t)
        above = shape.signed_distance(rotated(R, points[out]) + t)[0].min() - lowest
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
        lowest = limit(made, np.eye(3), -down * Z)
        least = 2 * UNSEEN * 0.099  # sizes of the cloud, and of where it was
        assert (
            least - ROUNDING <= 1e-3 * WIDTH - down - lowest <= least + 2 * UNSEEN * down + ROUNDING
        )


def test_a_limit_by_distance_falls_by_the_motion_and_the_room_for_that():
    # The box about a cloud, moved along an axis by 1 m: |u| <= sqrt(3) max |u_i|, for all ways.
    box = np.array(list(itertools.product((-0.1, 0.1), repeat=3)))
    made = Shortlist(np.arange(2), 3.0, np.inf, Z, box, box)
    for u in (X, -X, Z):
        lowest = limit(made, np.eye(3), u)
        expected = 3.0 - np.sqrt(3) * (1 + UNSEEN)
        np.testing.assert_allclose(lowest, expected, rtol=EXACT, atol=ROUNDING)


def test_a_list_that_suffices_for_few_steps_is_made_twice_as_long(rng):
    # Twice the cloud is turned upside down: after as many steps as is worth it, and one fewer.
    k = 12
    points = PointCloud(rng.uniform(-0.1, 0.1, size=(500, 3)))
    floor = PlacedShape("floor", 0, np.eye(3), np.zeros(3), HalfSpace(Z, 0.0))
    cloud = PlacedShape("cloud", 1, np.eye(3), np.zeros(3), points)
    tracker = ContactTracker([ContactPair("p", floor, cloud, 0.5, 0.0, 4, k)])
    upright = np.eye(3)
    upside_down = np.diag([1.0, -1.0, -1.0])
    widths = []
    for R, steps in ((upright, SHORT), (upside_down, SHORT - 1), (upright, 1)):
        for _ in range(steps):
            tracker.closest_points(np.stack([np.eye(3), R]), np.zeros((2, 3)))
        widths.append(tracker.lists[0].width)
    assert tracker.lists_made == 3
    assert widths == [4 * k, 4 * k, 8 * k]
