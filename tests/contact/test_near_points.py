"""Points and triangles that are left out do not count: the bits are those of a full search."""

import itertools

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from quasistatic_ref import (
    Box,
    Capsule,
    Cone,
    Cylinder,
    Ellipsoid,
    HalfSpace,
    PointCloud,
    Sphere,
    convex_hull,
)
from quasistatic_ref.contact.all_pairs import closest_points
from quasistatic_ref.contact.distance import in_world
from quasistatic_ref.contact.ranks import MANY_POINTS, closest, near_points, rounded_gaps
from quasistatic_ref.contact.shape_in_world import Pose
from quasistatic_ref.shapes import facets
from tests.contact.still import pair, placed_shape, standing_links

TURNED = Rotation.from_rotvec((0.3, -0.2, 0.5)).as_matrix()
AROUND = 2 * np.pi * np.arange(60) / 60
RIM = 0.02 * np.column_stack([np.cos(AROUND), np.sin(AROUND), 0.3 * np.ones(60)])


def sphere(N):
    points = np.random.default_rng(N).normal(size=(N, 3))
    return points / np.linalg.norm(points, axis=1)[:, None]


def grid(N):
    """Of which many points are as near as each other."""
    side = int(np.ceil(N ** (1 / 3)))
    return (np.stack(np.unravel_index(np.arange(N), (side,) * 3), axis=1) - side / 2) / side


MESHES = {
    "box": convex_hull(Box((0.01, 0.02, 0.03)).corners(np.eye(3)[0])[0]),
    "finger": convex_hull(sphere(100) * [0.01, 0.02, 0.03]),
    "plate of needles": convex_hull(np.concatenate([RIM, RIM * [1, 1, -0.01]])),
}
CLOUDS = {
    "sphere": PointCloud(0.03 * sphere(500)),
    "grid": PointCloud(0.06 * grid(300)),
    "large": PointCloud(0.06 * grid(MANY_POINTS + 1)),
}


EACH = [
    pytest.param(*each, marks=pytest.mark.long if each[1] == "large" else ())
    for each in itertools.product(MESHES, CLOUDS, (1, 70))
]
"""Those of the large cloud take seconds each."""


@pytest.mark.parametrize(("name", "on", "k"), [*EACH, ("box", "large", 4)])
def test_contacts_of_a_cloud_are_those_of_all_points_over_all_triangles(name, on, k, monkeypatch):
    mesh = MESHES[name]
    cloud = CLOUDS[on]
    one = pair(placed_shape(mesh, 1), placed_shape(cloud, 2), k)
    for R in (np.eye(3), TURNED):
        for t in ((0.0, 0.0, 0.0), (0.04, 0.001, 0.0), (0.03, -0.04, 0.05), (1e3, 0.0, 0.1)):
            links = standing_links((TURNED, np.zeros(3)), (R, np.array(t)))
            found = closest_points([one], links)
            a, b = in_world(one, links.R, links.t)
            with monkeypatch.context() as all_triangles:
                all_triangles.setattr(facets, "FEW_FACETS", len(mesh.triangles))
                x = a.pose.of(b.pose).points(cloud.points)
                rank, _ = mesh.signed_distance(x)
            expected = closest(rounded_gaps(rank, one.resolution), k)
            assert found.point.tolist() == expected.tolist()
            assert found.phi.tobytes() == (rank[expected] + 0.0).tobytes()


SOLIDS = [
    HalfSpace((0.3, 0.2, 1.0), -0.02),
    Box((0.01, 0.02, 0.03)),
    Sphere(0.02),
    Capsule(0.01, 0.02),
    Cylinder(0.02, 0.01),
    Cone(0.02, 0.02),
    Ellipsoid((0.01, 0.02, 0.03)),
    MESHES["box"],
]
PLANE = np.random.default_rng(0).uniform(-0.04, 0.04, size=(3 * MANY_POINTS, 3)) * [1.0, 1.0, 0.0]


@pytest.mark.parametrize("solid", SOLIDS, ids=lambda solid: type(solid).__name__)
def test_groups_of_a_large_cloud_leave_out_no_point_of_the_first(solid):
    """Of a grid, where many rank alike, and of a plane, at any pose and far away."""
    for cloud in (CLOUDS["large"], PointCloud(PLANE)):
        left = []
        for R, t in itertools.product(
            (np.eye(3), TURNED),
            ((0.0, 0.0, 0.0), (0.04, 0.001, 0.0), (-0.03, -0.06, 0.09), (1e3, 0.0, 0.1)),
        ):
            pose = Pose(R, np.array(t))
            phi, _ = solid.signed_distance(pose.points(cloud.points))
            for k, resolution in itertools.product((1, 5, 70), (0.0, 1e-11, 1e-3)):
                number, x = near_points(solid, cloud, pose, k, resolution)
                near = closest(rounded_gaps(solid.signed_distance(x)[0], resolution), k)
                every = closest(rounded_gaps(phi, resolution), k)
                assert number[near].tolist() == every.tolist()
            left.append(len(number) / len(cloud.points))
        assert np.median(left) < 0.5


def test_most_points_and_triangles_are_left_out():
    mesh = MESHES["finger"]
    pose = Pose(np.eye(3), np.array([0.04, 0.001, 0.0]))
    for name, cloud in CLOUDS.items():
        number, _ = near_points(mesh, cloud, pose, 5, 1e-11)
        assert len(number) < 0.1 * len(cloud.points), name
        tried = sum(near.size for _, near in mesh.facets.near(cloud.points))
        assert tried < 0.1 * len(cloud.points) * len(mesh.triangles)
