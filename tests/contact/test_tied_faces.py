"""The contacts of two faces, and which normal they have on edges."""

import numpy as np
from scipy.spatial.transform import Rotation

from quasistatic_ref import Box, HalfSpace, PointCloud
from quasistatic_ref.contact.separations import OF_CLOUD
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


def test_a_cloud_takes_the_face_along_which_it_is_farthest_out():
    # Two points are on an edge. Above the face x = 0.1 the lowest of all is at 0, above z = 1 at
    # -0.5.
    t = 5 * X
    cloud = PointCloud(np.array([[0.1, 0.0, 1.0], [0.1, 0.2, 1.0], [0.3, 0.0, 0.5]]) - t)
    points = closest_points_of(Box((0.1, 1.0, 1.0)), cloud, np.eye(3), t, 2)
    assert_within(points.n, [X, X], CLOSED_FORM)
    assert points.tie.tolist() == [OF_CLOUD] * 2
