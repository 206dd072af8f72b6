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
from tests.scenes import chain_scene
from tests.tolerances import CURVED_PAIR, EXACT, ROUNDING, SIGNED_DISTANCE

Z = np.eye(3)[2]
CONVEX = {
    "sphere": Sphere(0.1),
    "box": Box(np.array([0.1, 0.15, 0.2])),
    "capsule": Capsule(0.08, 0.15),
    "cylinder": Cylinder(0.1, 0.15),
}


SOLIDS = CONVEX | {"half-space": HalfSpace(np.array([1.0, 2.0, 2.0]), 0.3)}


def random_pose(rng, distance):
    t = rng.normal(size=3)
    return Rotation.random(rng=rng).as_matrix(), distance * t / np.linalg.norm(t)


def consistent(found, atol):
    """Every result says beta - alpha = phi n with |n| = 1."""
    gap = found.beta - found.alpha
    np.testing.assert_allclose(gap, found.phi[:, None] * found.n, rtol=EXACT, atol=atol)
    np.testing.assert_allclose(np.linalg.norm(found.n, axis=1), 1.0, rtol=EXACT, atol=atol)


@pytest.mark.parametrize("name", SOLIDS)
def test_a_cloud_s_contacts_are_its_nearest_points_by_brute_force(name, rng):
    solid, points = placed(SOLIDS[name], 1), rng.uniform(-0.4, 0.4, size=(50, 3))
    pose, own = random_pose(rng, 0.2), random_pose(rng, 0.3)
    kinematics = standing(pose, own)
    found = found_for(solid, placed(PointCloud(points), 2), kinematics, k=7)
    each = []
    for i, p in enumerate(points):
        world = own[0] @ p + own[1]
        phi, n = solid.shape.signed_distance((pose[0].T @ (world - pose[1]))[None])
        each.append((phi[0], i, world, pose[0] @ n[0]))
    each.sort(key=lambda item: item[:2])
    assert found.point.tolist() == [item[1] for item in each[:7]]
    expected = {
        "phi": [item[0] for item in each[:7]],
        "beta": [item[2] for item in each[:7]],
        "n": [item[3] for item in each[:7]],
    }
    for key, value in expected.items():
        np.testing.assert_allclose(getattr(found, key), value, rtol=EXACT, atol=SIGNED_DISTANCE)
    consistent(found, SIGNED_DISTANCE)


STACKED = {
    "box on box": (Box(np.array([0.1, 0.1, 0.2])), 0.2),
    "capsule on box": (Capsule(0.05, 0.1), 0.15),
    "cylinder on box": (Cylinder(0.1, 0.2), 0.2),
}


@pytest.mark.parametrize("gap", [1e-3, 0.0, -1e-3])
@pytest.mark.parametrize(("shape", "height"), STACKED.values(), ids=STACKED)
def test_the_normal_on_a_box_is_upwards_apart_touching_or_sunk(shape, height, gap):
    table = placed(Box(np.array([1.0, 1.0, 0.5])))
    for turn in (0.0, 0.5, 2.0):
        R = Rotation.from_rotvec(turn * Z).as_matrix()
        pose = (R, np.array([0.1, -0.2, 0.5 + height + gap]))
        found = found_for(table, placed(shape, 1), standing(pose))
        np.testing.assert_allclose(found.phi, [gap], rtol=EXACT, atol=CURVED_PAIR)
        np.testing.assert_allclose(found.n, [Z], rtol=EXACT, atol=CURVED_PAIR)
        swapped = found_for(placed(shape, 1), table, standing(pose))
        np.testing.assert_allclose(swapped.n, [-Z], rtol=EXACT, atol=CURVED_PAIR)


def test_shapes_sit_where_their_links_carry_them(tmp_path, rng):
    system = chain_scene(tmp_path)
    kinematics = system.kinematics(system.integrate(system.neutral(), rng.normal(size=system.n_v)))
    lower, box = system.link("arm/lower"), system.link("box/box")
    R_s, R_c = Rotation.random(2, rng=rng).as_matrix()
    t_s, t_c = rng.normal(size=(2, 3))
    points = rng.normal(size=(6, 3))
    solid = placed(Box(np.array([0.3, 0.2, 0.1])), lower, R_s, t_s)
    cloud = placed(PointCloud(points), box, R_c, t_c)
    found = found_for(solid, cloud, kinematics, k=6)

    def world(link, R, t, p):
        return kinematics.R[link] @ (R @ p + t) + kinematics.t[link]

    expected = [world(box, R_c, t_c, points[i]) for i in found.point]
    np.testing.assert_allclose(found.beta, expected, rtol=ROUNDING, atol=ROUNDING)
    for i in range(6):
        in_solid = kinematics.R[lower].T @ (found.alpha[i] - kinematics.t[lower])
        phi, _ = solid.shape.signed_distance((R_s.T @ (in_solid - t_s))[None])
        np.testing.assert_allclose(phi, [0.0], rtol=EXACT, atol=SIGNED_DISTANCE)


def test_a_rotated_shape_of_the_world_is_rotated():
    # A half-space z <= 0.1 turned about y by 90 degrees is x <= 0.1, then moved to x <= 0.4.
    R = Rotation.from_euler("y", 90, degrees=True).as_matrix()
    wall = placed(HalfSpace(Z, 0.1), R=R, t=(0.3, 0.0, 0.0))
    cloud = placed(PointCloud(np.array([[0.0, 0.0, 0.0]])), 1)
    found = found_for(wall, cloud, standing((np.eye(3), np.array([0.65, 0.2, 0.3]))))
    np.testing.assert_allclose(found.phi, [0.25], rtol=ROUNDING)
    np.testing.assert_allclose(found.n, [[1, 0, 0]], rtol=EXACT, atol=ROUNDING)
    np.testing.assert_allclose(found.alpha, [[0.4, 0.2, 0.3]], rtol=ROUNDING)


def test_pairs_follow_one_another_each_nearest_first(rng):
    floor, ball = placed(HalfSpace(Z, 0.0)), placed(Sphere(0.1), 2)
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


def test_no_pairs_have_no_closest_points():
    found = closest_points([], standing())
    assert found.phi.shape == found.point.shape == (0,)
    assert found.alpha.shape == found.beta.shape == found.n.shape == (0, 3)


def test_a_pose_that_is_not_finite_is_refused() -> None:
    still = Kinematics(np.full((1, 3, 3), np.nan), np.zeros((1, 3)), np.zeros((6, 0)))
    with pytest.raises(ContactError, match="poses: must be finite"):
        closest_points([], still)
