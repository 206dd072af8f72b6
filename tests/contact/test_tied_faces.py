"""The contacts of two faces, and which normal they have on edges."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from quasistatic_ref import Box, HalfSpace, PointCloud, convex_hull
from quasistatic_ref.contact.separations import OF_CLOUD, OF_PAIR
from quasistatic_ref.contact.shape_in_world import ShapeInWorld
from quasistatic_ref.contact.tied_faces import _over, corner_surface, faces_apart
from quasistatic_ref.tolerances import SAME_NORMAL
from tests.closeness import assert_within
from tests.contact.still import found_for, pair, placed_shape, standing_links
from tests.tolerances import CLOSED_FORM

X, Y, Z = np.eye(3)


def closest_points_of(a, b, R, t, k):
    points = found_for(placed_shape(a), placed_shape(b, 1), standing_links((R, t)), k)
    assert len(points.phi) == pair(placed_shape(a), placed_shape(b, 1), k).n_c
    return points


CUBE = Box(np.full(3, 0.05))


def test_on_a_slope_the_middle_of_an_edge_takes_no_corners_place():
    # The lower corners are level but for rounding, and so is the middle of their edge, where the
    # support point lies when an edge is parallel to the slope.
    for degrees in range(1, 45):
        R = Rotation.from_rotvec([0, np.deg2rad(degrees), 0]).as_matrix()
        slope = HalfSpace(R[:, 2], 0.0)
        points = closest_points_of(slope, CUBE, R, R @ [0.3, 0.2, 0.05], 4)
        assert sorted(points.point.tolist()) == [0, 1, 2, 3]
        assert_within(points.phi, 0, CLOSED_FORM)


def test_of_two_corners_that_are_one_contact_alpha_s_is_kept():
    # Two equal cubes, one on the other: the four corners of either's face are in the same places.
    # Alpha's corners are 0 to 7 (binary: x lowest), so that its upper ones are 4 to 7.
    cube = Box(np.full(3, 0.25))
    points = closest_points_of(cube, cube, np.eye(3), np.array([0, 0, 0.5]), 4)
    assert sorted(points.point.tolist()) == [4, 5, 6, 7]


def test_rivals_are_faces_of_another_normal_that_are_as_high_but_for_rounding():
    # After the highest: one that is lower by just what is rounding, one by more, and the same face.
    heights = np.array([[0.0, -0.5, -0.75, 0.0]])
    normals = np.array([[Z, X, Y, Z + SAME_NORMAL * X]])
    highest, rivals = faces_apart(heights, normals, 0.5)
    assert highest.tolist() == [0]
    assert rivals.tolist() == [[False, True, False, False]]


def surface(shape, x, n, within):
    """What a corner x has on a shape where the pair's normal is n: phi and normal, and the tie."""
    body = ShapeInWorld(shape, np.eye(3), np.zeros(3))
    phi, normal, tie = corner_surface(body, np.array([x]), n, within)
    return [phi[0], *normal[0]], tie[0]


@pytest.mark.parametrize(("half", "within", "off"), [(100.0, 0.0, 1e-8), (1.0, 1e-6, 5e-7)])
def test_a_corner_is_over_a_face_or_on_an_edge_but_for_rounding(half, within, off):
    # It is off the side x = half of a box, by less than 1e-9 of the size or what is rounding.
    box = Box(np.full(3, half))
    tilted = np.array([np.sin(0.2), 0.0, np.cos(0.2)])
    between = (X + Z) / np.sqrt(2)
    over, tie = surface(box, [half + off, 0.0, 0.75 * half], tilted, within)
    assert_within(over, [-0.25 * half, *Z], CLOSED_FORM)
    edge, other = surface(box, [half + off, 0.0, half], between, within)
    assert_within(edge, [off / np.sqrt(2), *between], CLOSED_FORM)
    assert [tie, other] == [OF_PAIR] * 2


def test_a_point_is_over_a_face_up_to_what_is_near():
    # It is 0.25 above the top of a cube, and 0.25 beyond its side.
    x = np.array([[1.25, 0.0, 1.25]])
    cube = Box(np.ones(3))
    for near, over in ((0.25, True), (0.125, False)):
        assert _over(cube, x, np.array([0.25]), Z[None], near).tolist() == [over]


def test_a_corner_on_a_ridge_whose_faces_both_face_the_pair_has_the_pair_s_normal():
    top = np.tan(0.2)
    roof = convex_hull([[x, y, -x * x * top] for x in (-1, 0, 1) for y in (-1, 1)])
    ridge, tie = surface(roof, [0.0, 0.5, 0.0], Z, 1e-12)
    assert_within(ridge, [0.0, *Z], CLOSED_FORM)
    assert tie == OF_PAIR


def test_a_cloud_takes_the_face_along_which_it_is_farthest_out():
    # Two points are on an edge. Above the face x = 0.1 the lowest of all is at 0, above z = 1 at
    # -0.5.
    t = 5 * X
    cloud = PointCloud(np.array([[0.1, 0.0, 1.0], [0.1, 0.2, 1.0], [0.3, 0.0, 0.5]]) - t)
    points = closest_points_of(Box((0.1, 1.0, 1.0)), cloud, np.eye(3), t, 2)
    assert_within(points.n, [X, X], CLOSED_FORM)
    assert points.tie.tolist() == [OF_CLOUD] * 2
