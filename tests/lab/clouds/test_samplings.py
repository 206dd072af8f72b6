"""Clouds on a mesh: uniform, far apart, on vertices, as a scanner sees them."""

import numpy as np
import pytest
from scipy.spatial import cKDTree
from scipy.spatial.transform import Rotation

from quasistatic_ref import convex_hull
from quasistatic_ref.lab.clouds.samplings import (
    GRAZING,
    NOISE,
    SAMPLINGS,
    VIEWS,
    Mesh,
    farthest_points,
    random_points,
    scan,
    some_vertices,
)

CORNERS = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], dtype=np.float64)
FACES = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
TETRAHEDRON = Mesh(CORNERS, FACES)
"""Three faces of area 1/2 and one of sqrt(3)/2."""


def off_the_faces(points):
    """The distance of points from the nearest of the four planes [m]."""
    return np.abs(np.column_stack([points, (1 - points.sum(axis=1)) / np.sqrt(3)])).min(axis=1)


@pytest.mark.parametrize("sampling", SAMPLINGS)
def test_a_cloud_has_its_number_of_points_and_depends_on_the_seed_alone(sampling):
    one, same, other = (
        SAMPLINGS[sampling](TETRAHEDRON, 200, np.random.default_rng(seed)) for seed in (1, 1, 2)
    )
    assert one.shape == (200, 3)
    np.testing.assert_array_equal(one, same)
    assert not np.array_equal(one, other)
    assert len(np.unique(one, axis=0)) == 200
    assert off_the_faces(one).max() < (6 * NOISE if sampling == "scan" else 1e-15)


def test_random_points_are_uniform_over_the_area():
    """Of n points a share p of the area gets n p, by sqrt(n p (1 - p)) more or less."""
    n = 20_000
    points = random_points(TETRAHEDRON, n, np.random.default_rng(0))
    slanted = np.isclose(points.sum(axis=1), 1.0)
    p = np.sqrt(3) / (3 + np.sqrt(3))
    assert abs(slanted.sum() - n * p) < 4 * np.sqrt(n * p * (1 - p))
    low = (points[:, 2] == 0.0) & (points[:, :2].sum(axis=1) < 0.5)  # a quarter of that face
    p = 0.5 / (1.5 + np.sqrt(3) / 2) / 4
    assert abs(low.sum() - n * p) < 4 * np.sqrt(n * p * (1 - p))


def test_each_of_the_farthest_points_is_nearer_to_the_others_than_those_before_it():
    points = farthest_points(TETRAHEDRON, 150, np.random.default_rng(0))
    nearest = [np.linalg.norm(points[:i] - points[i], axis=1).min() for i in range(1, 150)]
    assert (np.diff(nearest) <= 0).all()
    random = random_points(TETRAHEDRON, 150, np.random.default_rng(0))
    gaps = [cKDTree(cloud).query(cloud, 2)[0][:, 1].min() for cloud in (points, random)]
    assert gaps[0] > 3 * gaps[1]


def test_vertices_are_those_of_a_mesh_that_is_subdivided_until_it_has_enough():
    """V' = V + E: 4, 10, 34 vertices of a tetrahedron, at multiples of 1, 1/2, 1/4."""
    assert [len(m.vertices) for m in (TETRAHEDRON, TETRAHEDRON.subdivided())] == [4, 10]
    fine = TETRAHEDRON.subdivided().subdivided()
    assert len(fine.vertices) == 34
    np.testing.assert_allclose(fine.areas.sum(), TETRAHEDRON.areas.sum())
    points = some_vertices(TETRAHEDRON, 34, np.random.default_rng(0))
    assert set(map(tuple, points)) == set(map(tuple, fine.vertices))


def test_a_scan_misses_what_no_view_sees():
    """The normal of a vertex of a sphere is its direction; the views are the first numbers drawn.

    The normal of a face has a cosine of GRAZING at least with a view that sees its points. Their
    directions are within the angle between that normal and the face's corners, and within what the
    noise turns a point by.
    """
    directions = Rotation.random(400, random_state=0).as_matrix()[:, 0]
    hull = convex_hull(directions)
    sphere = Mesh(hull.vertices, hull.triangles)
    points = scan(sphere, 500, np.random.default_rng(3))
    views = np.random.default_rng(3).normal(size=(VIEWS, 3))
    views /= np.linalg.norm(views, axis=1, keepdims=True)
    lengths = np.linalg.norm(points, axis=1)
    seen = (points @ views.T).max(axis=1) / lengths
    off = np.arccos(
        np.einsum("ti,tci->tc", sphere.normals, sphere.vertices[sphere.triangles])
    ).max()
    turned = 5 * NOISE / lengths.min()
    assert seen.min() > np.cos(np.arccos(GRAZING) + off + turned)
    assert (directions @ views.T).max(axis=1).min() < 0.0
