"""Which candidates become contacts, and in which order: what is still keeps both."""

import itertools
import tracemalloc

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from quasistatic_ref import (
    Box,
    Capsule,
    ClosestPoints,
    Cylinder,
    HalfSpace,
    PointCloud,
    Sphere,
    convex_hull,
)
from quasistatic_ref.contact.distance import repeated
from quasistatic_ref.contact.normals import OF_CLOUD
from quasistatic_ref.contact.pairs import RANKED
from quasistatic_ref.tolerances import REPEATED, SAME_NORMAL
from tests.closeness import assert_within
from tests.contact.still import found_for, pair, placed_shape, standing_links

Z = np.array([0.0, 0.0, 1.0])
FLOOR = HalfSpace(Z, 0.0)
TABLE = Box((0.5, 0.5, 0.25))
CUBE = Box(np.full(3, 0.05))
TURNS = (0.0, 1e-12, 1e-9, 1e-6, -1e-6, 1e-3)


def lowered(shape, turn, yaw):
    """A shape's pose, turned by a rotation vector and by a yaw, so that it touches z = 0."""
    R = (Rotation.from_euler("z", yaw) * Rotation.from_rotvec(turn)).as_matrix()
    return R, np.array([0.0, 0.0, shape.support_value(-Z[None] @ R).item()])


def found_on(low, top, pose, k):
    """The contacts of a shape at a pose with one that is not moved."""
    return found_for(placed_shape(low), placed_shape(top, 1), standing_links(pose), k)


def prism(sides):
    angle = np.arange(sides) * 2 * np.pi / sides
    rim = 0.05 * np.column_stack([np.cos(angle), np.sin(angle)])
    return convex_hull(
        np.concatenate([np.column_stack([rim, np.full(sides, z)]) for z in (-0.05, 0.05)])
    )


@pytest.mark.parametrize("floor", [FLOOR, TABLE], ids=["half-space", "box"])
@pytest.mark.parametrize(
    ("solid", "corners"), [(CUBE, 4), *((prism(count), count) for count in (6, 64))]
)
def test_as_many_contacts_as_a_face_has_corners_are_its_corners(floor, solid, corners):
    """The middle of an edge, which is nearest after a turn about it, takes no corner's place."""
    under = placed_shape(floor, t=(0, 0, 0 if floor is FLOOR else -0.25))
    lower = solid.corners(Z)[0]
    lower = lower[lower[:, 2] < 0]
    for yaw, axis, turn in itertools.product((0.0, 0.3), np.eye(3)[:2], TURNS):
        R, t = lowered(solid, turn * axis, yaw)
        found = found_for(under, placed_shape(solid, 1), standing_links((R, t)), corners)
        apart = np.abs(((found.beta - t) @ R)[:, None] - lower).max(axis=2)
        assert sorted(apart.argmin(axis=1).tolist()) == list(range(corners))
        assert apart.min(axis=1).max() < 1e-12


@pytest.mark.parametrize("solid", [Cylinder(0.02, 0.05), Capsule(0.02, 0.05)])
@pytest.mark.parametrize("yaw", [0.0, 0.7])
def test_a_line_of_contact_has_its_ends_for_contacts_in_one_order(solid, yaw):
    """Noise of 1e-17 m in the pose changes neither which they are nor their order."""
    R = Rotation.from_euler("zy", [yaw, np.pi / 2]).as_matrix()
    k = min(4, solid.corner_count)
    orders = set()
    rng = np.random.default_rng(7)
    for _ in range(40):
        t = np.array([0.0, 0.0, 0.02]) + 1e-17 * rng.normal(size=3)
        noise = Rotation.from_rotvec(1e-16 * rng.normal(size=3)).as_matrix()
        found = found_on(FLOOR, solid, (noise @ R, t), k)
        orders.add(tuple(found.point.tolist()))
        along = np.abs((found.beta[:2] - t) @ R[:, 2])
        assert_within(along, 0.05)
    assert len(orders) == 1


def test_contacts_rank_by_a_share_of_the_smaller_shape_and_keep_their_distances():
    """A point is listed before a nearer one of a higher number only within one multiple."""
    size = 0.5
    steps = np.array([0.4, 0.0, 1.2, 0.9]) * RANKED * size
    points = np.column_stack([np.linspace(0, size, 4), np.zeros(4), steps])
    sides = (placed_shape(FLOOR), placed_shape(PointCloud(points), 1))
    assert pair(*sides).resolution == RANKED * size
    found = found_for(*sides, standing_links((np.eye(3), np.zeros(3))), 3)
    assert found.point.tolist() == [0, 1, 2]
    assert found.phi.tolist() == steps[:3].tolist()
    point = placed_shape(PointCloud([[1.0, 0, 0]]), 1)  # which has no size
    assert pair(placed_shape(Sphere(0.1)), point).size == 0.2
    assert pair(placed_shape(FLOOR), point).resolution == 0


def test_candidates_that_repeat_an_earlier_one_are_those_that_every_two_tell():
    rng = np.random.default_rng(5)
    for _ in range(200):
        count = int(rng.integers(2, 30))
        few = rng.normal(size=(count, 7))[rng.integers(0, 1 + count // 2, count)]
        gives = np.repeat([REPEATED, SAME_NORMAL], [4, 3])
        few += gives * rng.choice([-3, -1, -0.5, 0, 0.5, 1, 3], size=few.shape)
        none = np.zeros(count, dtype=np.int64)
        every = ClosestPoints(few[:, 0], few[:, 1:4], few[:, 1:4], few[:, 4:], none, none)
        of = rng.integers(0, rng.integers(1, 4), count)
        same = (np.abs(few[:, None] - few) <= gives).all(axis=2) & (of[:, None] == of)
        assert repeated(every, of).tolist() == np.tril(same, -1).any(axis=1).tolist()


def test_a_hull_of_many_corners_takes_no_memory_in_the_square_of_their_number():
    points = np.random.default_rng(6).normal(size=(4000, 3))
    ball = convex_hull(0.05 * points / np.linalg.norm(points, axis=1, keepdims=True))
    pose = lowered(ball, np.zeros(3), 0.0)
    tracemalloc.start()
    found = found_on(FLOOR, ball, pose, 4)
    assert tracemalloc.get_traced_memory()[1] < 20 * 2**20  # an eighth of 4000^2 numbers
    tracemalloc.stop()
    assert abs(found.phi[0]) < 1e-15


def test_of_two_corners_that_are_one_contact_alpha_s_is_kept():
    # Two equal cubes, one on the other: the four corners of either's face are in the same places.
    # Alpha's corners are 0 to 7 (binary: x lowest), so that its upper ones are 4 to 7.
    found = found_on(CUBE, CUBE, (np.eye(3), 0.1 * Z), 4)
    assert sorted(found.point.tolist()) == [4, 5, 6, 7]


def test_a_cloud_takes_the_face_along_which_it_is_farthest_out():
    # Two points are on an edge. Above the face x = 0.1 the lowest of all is at 0, above z = 1 at
    # -0.5.
    t = np.array([5.0, 0.0, 0.0])
    cloud = PointCloud(np.array([[0.1, 0.0, 1.0], [0.1, 0.2, 1.0], [0.3, 0.0, 0.5]]) - t)
    found = found_on(Box((0.1, 1.0, 1.0)), cloud, (np.eye(3), t), 2)
    assert_within(found.n, [[1, 0, 0]] * 2)
    assert found.tie.tolist() == [OF_CLOUD] * 2
