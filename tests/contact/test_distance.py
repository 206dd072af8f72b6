"""Closest points of pairs in the world frame: methods, signs, placements, the guard on coal."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from quasistatic_ref import Box, Capsule, ContactError, Cylinder, HalfSpace, PointCloud, Sphere
from quasistatic_ref.contact.all_pairs import closest_points
from quasistatic_ref.contact.distance import (
    ClosestPoints,
    joined_contacts,
)
from quasistatic_ref.model.system import Kinematics
from quasistatic_ref.tolerances import FILLED
from tests.closeness import assert_within
from tests.contact.still import found_for, placed_shape, standing_links
from tests.tolerances import EXACT, SIGNED_DISTANCE

X, _, Z = np.eye(3)
SOLIDS = {
    "sphere": Sphere(0.1),
    "box": Box((0.1, 0.15, 0.2)),
    "capsule": Capsule(0.08, 0.15),
    "cylinder": Cylinder(0.1, 0.15),
    "half-space": HalfSpace((1.0, 2.0, 2.0), 0.3),
}


def random_pose(rng, distance):
    t = rng.normal(size=3)
    return Rotation.random(rng=rng).as_matrix(), distance * t / np.linalg.norm(t)


@pytest.mark.parametrize("name", SOLIDS)
def test_a_cloud_s_contacts_are_its_nearest_points_by_brute_force(name, rng):
    """Each shape has a pose in the frame of its link, which has one in the world."""
    points = rng.uniform(-0.4, 0.4, size=(50, 3))
    links, own = ([random_pose(rng, size) for _ in range(2)] for size in (0.2, 0.1))
    (R_solid, t_solid), (R_cloud, t_cloud) = (
        (S @ R, S @ t + s) for (S, s), (R, t) in zip(links, own, strict=True)
    )
    solid = placed_shape(SOLIDS[name], 1, *own[0])
    cloud = placed_shape(PointCloud(points), 2, *own[1])
    found = found_for(solid, cloud, standing_links(*links), k=7)
    each = []
    for i, p in enumerate(points):
        world = R_cloud @ p + t_cloud
        phi, n = solid.shape.signed_distance((R_solid.T @ (world - t_solid))[None])
        each.append((phi[0], i, world, R_solid @ n[0]))
    each.sort(key=lambda item: item[:2])
    phi, point, beta, n = zip(*each[:7], strict=True)
    assert found.point.tolist() == list(point)
    for actual, expected in ((found.phi, phi), (found.beta, beta), (found.n, n)):
        assert_within(actual, expected, SIGNED_DISTANCE)
    gap = found.beta - found.alpha
    assert_within(gap, found.phi[:, None] * found.n, SIGNED_DISTANCE)


def test_a_pose_that_is_not_finite_is_refused():
    still = Kinematics(np.full((1, 3, 3), np.nan), np.zeros((1, 3)), np.zeros((6, 0)), None)
    with pytest.raises(ContactError, match="poses: must be finite"):
        closest_points([], still)


def candidates_at(phi, x, number):
    """Candidates at distances phi [m], at places along the x axis [m], with their numbers."""
    alpha = np.outer(x, X)
    n = np.tile(Z, (len(phi), 1))
    return ClosestPoints(phi, alpha, alpha + phi[:, None] * n, n, number, 0 * number)


def test_zero_is_never_minus_zero():
    points = candidates_at(-np.zeros(1), np.zeros(1), np.zeros(1, dtype=int))
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
