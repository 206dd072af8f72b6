"""Closest points of pairs in the world frame: methods, signs, placements, the guard on coal."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from quasistatic_ref.contact.distance import closest_points
from quasistatic_ref.errors import ContactError
from quasistatic_ref.model.system import Kinematics
from quasistatic_ref.shapes.placed_shape import (
    Box,
    Capsule,
    Cylinder,
    HalfSpace,
    PointCloud,
    Sphere,
)
from tests.contact.still import found_for, pair, placed, standing
from tests.tolerances import EXACT, SIGNED_DISTANCE

Z = np.eye(3)[2]
SOLIDS = {
    "sphere": Sphere(0.1),
    "box": Box(np.array([0.1, 0.15, 0.2])),
    "capsule": Capsule(0.08, 0.15),
    "cylinder": Cylinder(0.1, 0.15),
    "half-space": HalfSpace(np.array([1.0, 2.0, 2.0]), 0.3),
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
    solid = placed(SOLIDS[name], 1, *own[0])
    cloud = placed(PointCloud(points), 2, *own[1])
    found = found_for(solid, cloud, standing(*links), k=7)
    each = []
    for i, p in enumerate(points):
        world = R_cloud @ p + t_cloud
        phi, n = solid.shape.signed_distance((R_solid.T @ (world - t_solid))[None])
        each.append((phi[0], i, world, R_solid @ n[0]))
    each.sort(key=lambda item: item[:2])
    phi, point, beta, n = zip(*each[:7], strict=True)
    assert found.point.tolist() == list(point)
    for actual, expected in ((found.phi, phi), (found.beta, beta), (found.n, n)):
        np.testing.assert_allclose(actual, expected, rtol=EXACT, atol=SIGNED_DISTANCE)
    gap = found.beta - found.alpha
    np.testing.assert_allclose(gap, found.phi[:, None] * found.n, rtol=EXACT, atol=SIGNED_DISTANCE)


def test_pairs_follow_one_another_each_nearest_first(rng):
    floor = placed(HalfSpace(Z, 0.0))
    ball = placed(Sphere(0.1), 2)
    cloud = placed(PointCloud(rng.uniform(-0.4, 0.4, size=(20, 3))), 1)
    kinematics = standing(random_pose(rng, 0.2), random_pose(rng, 0.3))
    pairs = [pair(floor, cloud, 3), pair(floor, ball), pair(ball, cloud, 2)]
    found = closest_points(pairs, kinematics)
    assert found.phi.shape == (6,)
    start = 0
    for one in pairs:
        alone = closest_points([one], kinematics)
        part = slice(start, start + one.n_c)
        for key in ("phi", "alpha", "beta", "n", "point"):
            np.testing.assert_allclose(
                getattr(found, key)[part], getattr(alone, key), rtol=EXACT, atol=EXACT
            )
        assert (np.diff(alone.phi) >= 0).all()
        start += one.n_c


def test_a_pose_that_is_not_finite_is_refused() -> None:
    still = Kinematics(np.full((1, 3, 3), np.nan), np.zeros((1, 3)), np.zeros((6, 0)))
    with pytest.raises(ContactError, match="poses: must be finite"):
        closest_points([], still)
