"""The contacts of two faces: corners, rims and the closest pair, in that order."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from quasistatic_ref.contact.distance import ClosestPoints
from quasistatic_ref.contact.shape_in_world import ShapeInWorld
from quasistatic_ref.contact.solids.solid_pair import solid_pair
from quasistatic_ref.shapes.convex_mesh import convex_hull
from quasistatic_ref.shapes.placed_shape import (
    Box,
    Cylinder,
    HalfSpace,
    Shape,
)
from tests.contact.still import found_for, pair, placed, standing
from tests.tolerances import CLOSED_FORM, EXACT


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


def test_candidates_are_alphas_corners_betas_corners_and_the_closest_pair() -> None:
    cube = Box(np.full(3, 0.05))
    shelf = Box(np.array([0.3, 0.3, 0.1]))
    points = found(cube, shelf, np.eye(3), np.array([0.02, 0.01, -0.15]), 17)
    # alpha's corners are 0..7 (binary: x lowest), beta's 8..15, the pair 16. The four lower
    # corners of the cube touch, and the pair, which is one of them again.
    assert sorted(points.point[:5].tolist()) == [0, 1, 2, 3, 16]
    np.testing.assert_allclose(points.phi[:5], 0, rtol=EXACT, atol=CLOSED_FORM)
    assert (points.phi[5:] > 0.05).all()
    four = found(cube, shelf, np.eye(3), np.array([0.02, 0.01, -0.15]), 4)
    assert sorted(four.point.tolist()) == [0, 1, 2, 3]


def test_on_a_slope_the_middle_of_an_edge_takes_no_corners_place() -> None:
    # The lower corners are level but for rounding, and so is the middle of their edge, where the
    # support point lies when an edge is parallel to the slope.
    for degrees in range(1, 45):
        R = Rotation.from_rotvec([0, np.deg2rad(degrees), 0]).as_matrix()
        slope = HalfSpace(R[:, 2], 0.0)
        points = found(slope, CUBE, R, R @ [0.3, 0.2, 0.05], 4)
        assert sorted(points.point.tolist()) == [0, 1, 2, 3]
        np.testing.assert_allclose(points.phi, 0, rtol=EXACT, atol=CLOSED_FORM)


@pytest.mark.parametrize("seed", range(6))
def test_a_rims_first_corner_is_the_closest_point_and_repeats_it(seed: int) -> None:
    # Rims of two cylinders 1e-5 m apart: the normal is right to 1e-11, and a corner that it led to
    # would have another by 1e-7. The closest pair, and each rim's corner there, are one contact.
    rng = np.random.default_rng(seed)
    one = Cylinder(0.06, 0.04)
    other = Cylinder(0.05, 0.07)
    R = Rotation.random(random_state=seed).as_matrix()
    way = rng.normal(size=3)
    t = 0.3 * way / np.sqrt(way @ way)
    here = ShapeInWorld(one, np.eye(3), np.zeros(3))
    for _ in range(3):  # along the normal, until they are as near
        phi, _, _, n = solid_pair("p", here, ShapeInWorld(other, R, t))
        t = t - (phi - 1e-5) * n
    points = found(one, other, R, t, 17)
    nearest = points.alpha[points.point == 16]
    again = np.abs(points.alpha - nearest).max(axis=1) < 1e-6
    on_rim = np.hypot(*nearest[0, :2]) > 0.06 - 1e-9
    for x in (points.n, points.alpha):
        np.testing.assert_allclose(
            x[again], x[again][:1].repeat(again.sum(), 0), rtol=0, atol=1e-10
        )
    assert again.sum() >= 1 + on_rim
    kept = found(one, other, R, t, 2)
    apart = np.abs(kept.alpha[:, None] - kept.alpha).max(axis=2) + np.eye(2)
    assert apart.min() > 1e-3


def test_of_two_corners_that_are_one_contact_alpha_s_is_kept() -> None:
    # Two equal cubes, one on the other: the four corners of either's face are in the same places.
    # Alpha's corners are 0 to 7 (binary: x lowest), so that its upper ones are 4 to 7.
    cube = Box(np.full(3, 0.25))
    points = found(cube, cube, np.eye(3), np.array([0, 0, 0.5]), 4)
    assert sorted(points.point.tolist()) == [4, 5, 6, 7]
