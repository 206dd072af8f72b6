"""The contacts of two faces, and which normal they have on edges."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from quasistatic_ref.contact.distance import ClosestPoints
from quasistatic_ref.contact.separations import OF_CLOUD, OF_PAIR
from quasistatic_ref.contact.shape_in_world import ShapeInWorld
from quasistatic_ref.contact.tied_faces import corner_surface, faces_apart
from quasistatic_ref.shapes.convex_mesh import convex_hull
from quasistatic_ref.shapes.placed_shape import (
    Box,
    HalfSpace,
    PointCloud,
    Shape,
)
from quasistatic_ref.tolerances import SAME_NORMAL
from tests.contact.still import found_for, pair, placed, standing
from tests.tolerances import CLOSED_FORM, EXACT

X, Y, Z = np.eye(3)


def found(a: Shape, b: Shape, R: np.ndarray, t: np.ndarray, k: int) -> ClosestPoints:
    points = found_for(placed(a), placed(b, 1), standing((R, t)), k)
    assert len(points.phi) == pair(placed(a), placed(b, 1), k).n_c
    return points


CUBE = Box(np.full(3, 0.05))


CUBE_MESH = convex_hull(
    [[x, y, z] for x in (-0.05, 0.05) for y in (-0.05, 0.05) for z in (-0.05, 0.05)]
)


@pytest.mark.parametrize("box", [CUBE, CUBE_MESH], ids=["box", "mesh"])
@pytest.mark.parametrize(
    "floor", [HalfSpace(np.eye(3)[2], 0.1), Box(np.array([0.3, 0.3, 0.1]))], ids=["plane", "table"]
)
@pytest.mark.parametrize("gap", [-1e-3, 0.0, 1e-3])
def test_a_box_that_lies_flat_touches_with_its_four_lower_corners(box, floor, gap) -> None:
    R = Rotation.from_rotvec([0, 0, 0.3]).as_matrix()
    points = found(floor, box, R, np.array([0.02, 0.01, 0.15 + gap]), 4)
    np.testing.assert_allclose(points.phi, gap, rtol=EXACT, atol=CLOSED_FORM)
    np.testing.assert_allclose(points.n, [[0, 0, 1]] * 4, rtol=EXACT, atol=CLOSED_FORM)
    corners = [[x, y, -0.05] for x in (-0.05, 0.05) for y in (-0.05, 0.05)]
    expected = np.array(corners) @ R.T + [0.02, 0.01, 0.15 + gap]
    order = np.lexsort(points.beta.round(6).T)
    np.testing.assert_allclose(
        points.beta[order], expected[np.lexsort(expected.round(6).T)], rtol=EXACT, atol=CLOSED_FORM
    )


def test_on_a_slope_the_middle_of_an_edge_takes_no_corners_place() -> None:
    # The lower corners are level but for rounding, and so is the middle of their edge, where the
    # support point lies when an edge is parallel to the slope.
    for degrees in range(1, 45):
        R = Rotation.from_rotvec([0, np.deg2rad(degrees), 0]).as_matrix()
        slope = HalfSpace(R[:, 2], 0.0)
        points = found(slope, CUBE, R, R @ [0.3, 0.2, 0.05], 4)
        assert sorted(points.point.tolist()) == [0, 1, 2, 3]
        np.testing.assert_allclose(points.phi, 0, rtol=EXACT, atol=CLOSED_FORM)


def test_of_two_corners_that_are_one_contact_alpha_s_is_kept() -> None:
    # Two equal cubes, one on the other: the four corners of either's face are in the same places.
    # Alpha's corners are 0 to 7 (binary: x lowest), so that its upper ones are 4 to 7.
    cube = Box(np.full(3, 0.25))
    points = found(cube, cube, np.eye(3), np.array([0, 0, 0.5]), 4)
    assert sorted(points.point.tolist()) == [4, 5, 6, 7]


def test_rivals_are_faces_of_another_normal_that_are_as_high_but_for_rounding() -> None:
    # After the highest: one that is lower by just what is rounding, one by more, and the same face.
    heights = np.array([[0.0, -0.5, -0.75, 0.0]])
    normals = np.array([[Z, X, Y, Z + SAME_NORMAL * X]])
    highest, rivals = faces_apart(heights, normals, 0.5)
    assert highest.tolist() == [0]
    assert rivals.tolist() == [[False, True, False, False]]


def surface(shape: Shape, x: list[float], n: np.ndarray, within: float) -> tuple[list[float], int]:
    """What a corner x has on a shape where the pair's normal is n: phi and normal, and the tie."""
    body = ShapeInWorld(shape, np.eye(3), np.zeros(3))
    phi, normal, tie = corner_surface(body, np.array([x]), n, within)
    return [phi[0], *normal[0]], tie[0]


@pytest.mark.parametrize(("half", "within", "off"), [(100.0, 0.0, 1e-8), (1.0, 1e-6, 5e-7)])
def test_a_corner_is_over_a_face_or_on_an_edge_but_for_rounding(half, within, off) -> None:
    # It is off the side x = half of a box, by less than 1e-9 of the size or what is rounding.
    box = Box(np.full(3, half))
    tilted = np.array([np.sin(0.2), 0.0, np.cos(0.2)])
    between = (X + Z) / np.sqrt(2)
    over, tie = surface(box, [half + off, 0.0, 0.75 * half], tilted, within)
    np.testing.assert_allclose(over, [-0.25 * half, *Z], rtol=EXACT, atol=CLOSED_FORM)
    edge, other = surface(box, [half + off, 0.0, half], between, within)
    np.testing.assert_allclose(edge, [off / np.sqrt(2), *between], rtol=EXACT, atol=CLOSED_FORM)
    assert [tie, other] == [OF_PAIR] * 2


def test_a_corner_on_a_ridge_whose_faces_both_face_the_pair_has_the_pair_s_normal() -> None:
    top = np.tan(0.2)
    roof = convex_hull([[x, y, -x * x * top] for x in (-1, 0, 1) for y in (-1, 1)])
    ridge, tie = surface(roof, [0.0, 0.5, 0.0], Z, 1e-12)
    np.testing.assert_allclose(ridge, [0.0, *Z], rtol=EXACT, atol=CLOSED_FORM)
    assert tie == OF_PAIR


def test_a_cloud_takes_the_face_along_which_it_is_farthest_out() -> None:
    # Two points are on an edge. Above the face x = 0.1 the lowest of all is at 0, above z = 1 at
    # -0.5.
    t = 5 * X
    cloud = PointCloud(np.array([[0.1, 0.0, 1.0], [0.1, 0.2, 1.0], [0.3, 0.0, 0.5]]) - t)
    points = found(Box(np.array([0.1, 1.0, 1.0])), cloud, np.eye(3), t, 2)
    np.testing.assert_allclose(points.n, [X, X], rtol=EXACT, atol=CLOSED_FORM)
    assert points.tie.tolist() == [OF_CLOUD] * 2
