"""Convex hulls of meshes: orientation, corners, and by how much a mesh is not convex."""

import numpy as np
import pytest

from quasistatic_ref import ModelError, convex_hull
from quasistatic_ref.shapes.convex_mesh import hull_of_mesh
from tests.closeness import assert_relative
from tests.tolerances import CLOSED_FORM

CORNERS = np.array([[x, y, z] for x in (5, 8) for y in (-2, -1) for z in (7, 9)], dtype=float)
"""Of a box of 3 m, 1 m and 2 m, away from the origin."""


def test_triangles_of_a_hull_are_counter_clockwise_from_outside():
    # (b - a) x (c - a) is twice the area times the outward normal; all areas are the box's.
    hull = convex_hull(CORNERS)
    a, b, c = hull.vertices[hull.triangles].transpose(1, 0, 2)
    areas = np.cross(b - a, c - a) / 2
    assert_relative(np.sum(areas * hull.normals), 2 * (3 + 6 + 2), CLOSED_FORM)
    assert_relative(np.sum(a * areas) / 3, 3 * 1 * 2, CLOSED_FORM)


def test_the_hull_of_a_mesh_has_its_corners():
    box = convex_hull(CORNERS)
    hull = hull_of_mesh(box.vertices, box.triangles)
    assert {tuple(corner) for corner in hull.vertices} == {tuple(corner) for corner in CORNERS}
    assert hull.is_convex
    spare = np.vstack([box.vertices, [[100, 100, 100]]])  # of no triangle, and still a corner
    hull = hull_of_mesh(spare, box.triangles)
    assert (100, 100, 100) in {tuple(corner) for corner in hull.vertices}
    assert not hull.is_convex


def test_a_fan_of_many_edges_has_the_volume_of_a_pyramid():
    turn = np.linspace(0, 2 * np.pi, 300, endpoint=False)
    rim = np.column_stack([np.cos(turn), np.sin(turn), np.zeros(300)])
    cone = convex_hull(np.vstack([rim, [[0, 0, 1]]]))
    assert_relative(cone.volume, 300 / 2 * np.sin(2 * np.pi / 300) / 3, CLOSED_FORM)


def test_a_fin_inside_a_mesh_counts_by_its_depth():
    # A fin holds no volume: its tip is 0.25 below the nearest face, of a box of 3 m at most.
    box = convex_hull(CORNERS)
    vertices = np.vstack([box.vertices, [[6.5, -1.25, 8.0]]])
    hull = hull_of_mesh(vertices, np.vstack([box.triangles, [[0, 1, 8], [0, 8, 1]]]))
    assert_relative(hull.excess, 0.25 / 3, CLOSED_FORM)
    assert not hull.is_convex


def test_an_open_mesh_encloses_what_its_triangles_and_its_centre_do():
    # Of a tetrahedron's four faces three are there, each with a quarter of the volume.
    corners = np.array([3.0, -1.0, 2.0]) + np.vstack([np.zeros(3), np.eye(3)])
    faces = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2]])
    assert_relative(hull_of_mesh(corners, faces).excess, 1 / 4, CLOSED_FORM)


def test_a_flat_mesh_is_refused():
    with pytest.raises(ModelError, match="vertices: must not lie in one plane"):
        convex_hull([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]])
