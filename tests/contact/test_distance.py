"""Closest points of pairs in the world frame: methods, signs, placements, the guard on coal."""

import coal
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from quasistatic_ref.contact.cloud import signed_distance
from quasistatic_ref.contact.distance import closest_points
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
HARD = [
    (a, b)
    for a in ("box", "capsule", "cylinder", "half-space")
    for b in ("box", "capsule", "cylinder")
]


def random_pose(rng, distance):
    t = rng.normal(size=3)
    return Rotation.random(rng=rng).as_matrix(), distance * t / np.linalg.norm(t)


def consistent(found, atol):
    """Every result says beta - alpha = phi n with |n| = 1."""
    gap = found.beta - found.alpha
    np.testing.assert_allclose(gap, found.phi[:, None] * found.n, rtol=EXACT, atol=atol)
    np.testing.assert_allclose(np.linalg.norm(found.n, axis=1), 1.0, rtol=EXACT, atol=atol)


def exchanged(one, two, atol):
    """Two results are the same with alpha and beta exchanged."""
    np.testing.assert_allclose(two.phi, one.phi, rtol=EXACT, atol=atol)
    np.testing.assert_allclose(two.n, -one.n, rtol=EXACT, atol=atol)
    np.testing.assert_allclose(two.alpha, one.beta, rtol=EXACT, atol=atol)
    np.testing.assert_allclose(two.beta, one.alpha, rtol=EXACT, atol=atol)


@pytest.mark.parametrize("name", SOLIDS)
def test_a_cloud_s_contacts_are_its_nearest_points_by_brute_force(name, rng):
    solid, points = placed(SOLIDS[name], 1), rng.uniform(-0.4, 0.4, size=(50, 3))
    pose, own = random_pose(rng, 0.2), random_pose(rng, 0.3)
    kinematics = standing(pose, own)
    found = found_for(solid, placed(PointCloud(points), 2), kinematics, k=7)
    each = []
    for i, p in enumerate(points):
        world = own[0] @ p + own[1]
        phi, n = signed_distance(solid.shape, (pose[0].T @ (world - pose[1]))[None])
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


@pytest.mark.parametrize("name", SOLIDS)
def test_a_cloud_as_alpha_has_the_same_contacts_the_other_way_round(name, rng):
    solid = placed(SOLIDS[name], 1)
    cloud = placed(PointCloud(rng.uniform(-0.4, 0.4, size=(30, 3))), 2)
    kinematics = standing(random_pose(rng, 0.2), random_pose(rng, 0.3))
    one, two = (found_for(*sides, kinematics, k=5) for sides in ((solid, cloud), (cloud, solid)))
    exchanged(one, two, EXACT)
    assert one.point.tolist() == two.point.tolist()


@pytest.mark.parametrize("gap", [0.2, 0.0, -0.05, -0.25])
def test_two_spheres_have_their_closed_form_inside_one_another_too(gap, rng):
    turned, direction = random_pose(rng, 1.0)
    alpha, beta = placed(Sphere(0.1), 1), placed(Sphere(0.2), 2)
    t = (0.3 + gap) * direction  # centres r1 + r2 + gap apart
    found = found_for(alpha, beta, standing((turned, np.zeros(3)), (np.eye(3), t)))
    np.testing.assert_allclose(found.phi, [gap], rtol=EXACT, atol=SIGNED_DISTANCE)
    np.testing.assert_allclose(found.n, [direction], rtol=EXACT, atol=SIGNED_DISTANCE)
    np.testing.assert_allclose(found.alpha, [0.1 * direction], rtol=EXACT, atol=SIGNED_DISTANCE)
    np.testing.assert_allclose(found.beta, [t - 0.2 * direction], rtol=EXACT, atol=SIGNED_DISTANCE)


@pytest.mark.parametrize("name", SOLIDS)
def test_a_sphere_is_a_point_a_radius_away_from_every_shape(name, rng):
    solid, radius = SOLIDS[name], 0.07
    for distance in np.linspace(0.0, 0.6, 13):
        R, t = random_pose(rng, distance)
        centre, turned = random_pose(rng, 0.3)[::-1]
        kinematics = standing((R, t), (turned, centre))
        found = found_for(placed(solid, 1), placed(Sphere(radius), 2), kinematics)
        to_centre, n = signed_distance(solid, (R.T @ (centre - t))[None])
        np.testing.assert_allclose(found.phi, to_centre - radius, rtol=EXACT, atol=SIGNED_DISTANCE)
        np.testing.assert_allclose(found.n, [R @ n[0]], rtol=EXACT, atol=SIGNED_DISTANCE)
        expected = [centre - radius * (R @ n[0])]
        np.testing.assert_allclose(found.beta, expected, rtol=EXACT, atol=SIGNED_DISTANCE)
        consistent(found, SIGNED_DISTANCE)
        swapped = found_for(placed(Sphere(radius), 2), placed(solid, 1), kinematics)
        # Two spheres exchange which one is measured against: equal up to rounding.
        exchanged(found, swapped, SIGNED_DISTANCE)
        assert found.point.tolist() == [0]


@pytest.mark.parametrize("name", ["sphere", "box", "capsule", "half-space"])
def test_a_sphere_s_distance_is_coal_s(name, rng):
    solid, ball = SOLIDS[name], Sphere(0.07)
    for _ in range(50):
        (R, t), (turned, centre) = random_pose(rng, 0.2), random_pose(rng, 0.4)
        found = found_for(placed(solid, 1), placed(ball, 2), standing((R, t), (turned, centre)))
        request, result = coal.DistanceRequest(), coal.DistanceResult()
        there, here = coal.Transform3s(turned, centre), coal.Transform3s(R, t)
        expected = coal.distance(solid.coal, here, ball.coal, there, request, result)
        np.testing.assert_allclose(found.phi, [expected], rtol=EXACT, atol=SIGNED_DISTANCE)


@pytest.mark.parametrize(("a", "b"), HARD, ids=[f"{a}-{b}" for a, b in HARD])
def test_convex_pairs_are_consistent_from_either_side(a, b, rng):
    for _ in range(20):
        kinematics = standing(random_pose(rng, 0.0), random_pose(rng, 0.6))
        alpha, beta = placed(SOLIDS[a], 1), placed(SOLIDS[b], 2)
        one = found_for(alpha, beta, kinematics)
        consistent(one, CURVED_PAIR)
        two = found_for(beta, alpha, kinematics)
        np.testing.assert_allclose(two.phi, one.phi, rtol=EXACT, atol=2 * CURVED_PAIR)


def segment_distance(p, d, q, e, half_p, half_q):
    """Least distance of two segments p + s d, q + u e by alternating exact projections."""
    s = u = 0.0
    for _ in range(2000):
        s = min(max((q + u * e - p) @ d, -half_p), half_p)
        u = min(max((p + s * d - q) @ e, -half_q), half_q)
    return np.linalg.norm(p + s * d - q - u * e)


def test_two_capsules_are_as_far_apart_as_their_segments_less_both_radii(rng):
    one, two = Capsule(0.08, 0.15), Capsule(0.05, 0.1)
    for _ in range(30):
        (R, t), (S, u) = random_pose(rng, 0.0), random_pose(rng, 0.4)
        found = found_for(placed(one, 1), placed(two, 2), standing((R, t), (S, u)))
        expected = segment_distance(t, R[:, 2], u, S[:, 2], 0.15, 0.1) - 0.13
        np.testing.assert_allclose(found.phi, [expected], rtol=EXACT, atol=CURVED_PAIR)


STACKED = {
    "box on box": (Box(np.array([0.1, 0.1, 0.2])), 0.2),
    "capsule on box": (Capsule(0.05, 0.1), 0.15),
    "cylinder on box": (Cylinder(0.1, 0.2), 0.2),
}


@pytest.mark.parametrize("gap", [1e-3, 0.0, -1e-3])
@pytest.mark.parametrize(("shape", "height"), STACKED.values(), ids=STACKED)
def test_the_normal_on_a_box_is_upwards_apart_touching_or_sunk(shape, height, gap):
    table = placed(Box(np.array([1.0, 1.0, 0.5])))
    for turn in np.linspace(0, 3, 7):
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
        phi, _ = signed_distance(solid.shape, (R_s.T @ (in_solid - t_s))[None])
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


def test_a_point_of_a_cloud_has_the_same_bits_in_any_company(rng):
    solid, points = placed(SOLIDS["box"], 1), rng.uniform(-0.4, 0.4, size=(20, 3))
    kinematics = standing(random_pose(rng, 0.2), random_pose(rng, 0.3))
    together = found_for(solid, placed(PointCloud(points), 2), kinematics, k=20)
    for j, i in enumerate(together.point):
        alone = found_for(solid, placed(PointCloud(points[i : i + 1]), 2), kinematics)
        for key in ("phi", "alpha", "beta", "n"):
            np.testing.assert_allclose(
                getattr(alone, key)[0], getattr(together, key)[j], rtol=EXACT, atol=EXACT
            )


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
