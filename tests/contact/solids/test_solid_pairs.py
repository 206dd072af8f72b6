"""Every pair of solids against an independent computation, on a sample of poses.

The whole table, 1,000 poses a pair, is printed by validation/make/pair_distances.py.
"""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from quasistatic_ref.contact.cloud import signed_distance
from quasistatic_ref.contact.distance import ClosestPoints, closest_points, pair_closest_points
from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.contact.shape_in_world import ShapeInWorld
from quasistatic_ref.contact.solids.solid_pair import solid_pair
from quasistatic_ref.errors import ContactError
from quasistatic_ref.model.system import Kinematics
from quasistatic_ref.shapes.convex_mesh import convex_hull
from quasistatic_ref.shapes.placed_shape import (
    Box,
    Capsule,
    Cylinder,
    HalfSpace,
    PlacedShape,
    Shape,
)
from tests.oracles import closest
from tests.tolerances import CLOSED_FORM, CONE_PROGRAM, CURVED_PAIR, EXACT, WAY_OUT

CURVED = {"cylinder", "cone", "ellipsoid"}
SOLIDS = closest.solids()
STEP = 1e-3
NORMAL_BESIDE = 1e-10
"""Error of the normal of points 1e-5 m apart [-]: places of decimetres are right to 1e-16 m."""


def by_coal(names: tuple[str, str]) -> bool:
    return bool(CURVED & set(names)) and not {"sphere", "half-space"} & set(names)


@pytest.mark.parametrize("names", closest.pairs(), ids="-".join)
def test_a_pair_is_as_far_apart_as_another_computation_says(names: tuple[str, str]) -> None:
    a, b = (SOLIDS[name] for name in names)
    atol = CURVED_PAIR if by_coal(names) else CLOSED_FORM
    reference = CONE_PROGRAM if by_coal(names) else CLOSED_FORM
    random = np.random.default_rng(5)
    directions = random.normal(size=(2000, 3))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    here, answered = ShapeInWorld(a, np.eye(3), np.zeros(3)), 0
    for R, t in closest.poses(16, 11):
        try:
            phi, alpha, beta, n = solid_pair("p", here, ShapeInWorld(b, R, t))
            moved = solid_pair("p", here, ShapeInWorld(b, R, t + STEP * n)).phi
        except ContactError:
            assert by_coal(names)
            continue
        answered += 1
        on_a = signed_distance(a, alpha[None])[0]
        on_b = signed_distance(b, ((beta - t) @ R)[None])[0]
        np.testing.assert_allclose(n @ n, 1, rtol=EXACT, atol=CLOSED_FORM)
        np.testing.assert_allclose([on_a, on_b], 0, rtol=EXACT, atol=max(atol, WAY_OUT))
        np.testing.assert_allclose(beta - alpha, phi * n, rtol=EXACT, atol=CLOSED_FORM)
        # Moving beta's body by d along n makes the distance d larger, exactly.
        np.testing.assert_allclose(moved, phi + STEP, rtol=EXACT, atol=atol)
        if "half-space" not in names:
            gaps = closest.gap(a, b, R, t, np.vstack([n, directions]))
            np.testing.assert_allclose(gaps[0], phi, rtol=EXACT, atol=max(atol, CLOSED_FORM))
            assert gaps.max() <= phi + atol
        expected = closest.signed_distance(a, b, R, t)
        if expected is not None:
            np.testing.assert_allclose(phi, expected, rtol=EXACT, atol=reference)
    assert answered >= 15  # a curved pair may be refused where one is deep inside the other


def found(a: Shape, b: Shape, R: np.ndarray, t: np.ndarray, k: int) -> ClosestPoints:
    still = Kinematics(np.array([np.eye(3), R]), np.array([np.zeros(3), t]), np.zeros((6, 0)))
    alpha = PlacedShape("a", 0, np.eye(3), np.zeros(3), a)
    beta = PlacedShape("b", 1, np.eye(3), np.zeros(3), b)
    pair = ContactPair("p", alpha, beta, 0.5, 0.0, 4, k)
    points = pair_closest_points(pair, still.R, still.t)
    assert len(points.phi) == pair.n_c
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
    cube, shelf = Box(np.full(3, 0.05)), Box(np.array([0.3, 0.3, 0.1]))
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


def test_a_closest_pair_is_kept_where_corners_are_farther() -> None:
    # Two beams crossed at right angles, 0.01 m apart: no corner faces the other beam.
    beam, across = Box(np.array([0.5, 0.02, 0.02])), Box(np.array([0.02, 0.5, 0.02]))
    points = found(beam, across, np.eye(3), np.array([0.0, 0.0, 0.05]), 4)
    assert points.point[0] == 16
    np.testing.assert_allclose(points.phi[0], 0.01, rtol=EXACT, atol=CLOSED_FORM)


def test_a_capsule_lies_on_its_two_caps_and_a_cylinder_on_its_rims() -> None:
    floor = HalfSpace(np.eye(3)[2], 0.0)
    lying = Rotation.from_rotvec([0, np.pi / 2, 0]).as_matrix()
    height = np.array([0, 0, 0.03])
    caps = found(floor, Capsule(0.03, 0.1), lying, height, 2)
    rims = found(floor, Cylinder(0.03, 0.1), lying, height, 2)
    for points in (caps, rims):
        np.testing.assert_allclose(points.phi, 0, rtol=EXACT, atol=CLOSED_FORM)
        np.testing.assert_allclose(
            np.sort(points.beta[:, 0]), [-0.1, 0.1], rtol=EXACT, atol=CLOSED_FORM
        )
    standing = found(floor, Cylinder(0.03, 0.1), np.eye(3), np.array([0, 0, 0.1]), 4)
    np.testing.assert_allclose(standing.phi, 0, rtol=EXACT, atol=CLOSED_FORM)
    around = np.hypot(standing.beta[:, 0], standing.beta[:, 1])
    np.testing.assert_allclose(around, 0.03, rtol=EXACT, atol=CLOSED_FORM)


def test_parallel_and_crossing_capsules_have_a_normal_to_both_axes() -> None:
    one = ShapeInWorld(Capsule(0.03, 0.1), np.eye(3), np.zeros(3))
    crossing = Rotation.from_rotvec([0, np.pi / 3, 0]).as_matrix()
    for R in (np.eye(3), crossing):
        phi, _, _, n = solid_pair("p", one, ShapeInWorld(Capsule(0.02, 0.1), R, np.zeros(3)))
        np.testing.assert_allclose(phi, -0.05, rtol=EXACT, atol=CLOSED_FORM)
        np.testing.assert_allclose([n[2], n @ R[:, 2]], 0, rtol=EXACT, atol=CLOSED_FORM)
    end_to_end = ShapeInWorld(Capsule(0.02, 0.1), np.eye(3), np.array([0, 0, 0.3]))
    phi, _, _, n = solid_pair("p", one, end_to_end)
    np.testing.assert_allclose(phi, 0.1 - 0.05, rtol=EXACT, atol=CLOSED_FORM)
    np.testing.assert_allclose(n, [0, 0, 1], rtol=EXACT, atol=CLOSED_FORM)


def test_a_pose_that_is_not_finite_is_refused() -> None:
    still = Kinematics(np.full((1, 3, 3), np.nan), np.zeros((1, 3)), np.zeros((6, 0)))
    with pytest.raises(ContactError, match="poses: must be finite"):
        closest_points([], still)


@pytest.mark.parametrize("off", [1e-6, 1e-8, 1e-10])
def test_just_beyond_a_face_the_normal_leans_away_from_its_edge(off: float) -> None:
    # The edge is at x = 0.1, z = 0.2: a point 1e-5 above the face and a little beyond the edge.
    up = 1e-5
    lean = np.array([off, 0.0, up]) / np.hypot(off, up)
    corners = np.array([[x, y, z] for x in (-0.1, 0.1) for y in (-0.3, 0.3) for z in (-0.2, 0.2)])
    point = np.array([0.1 + off, 0.05, 0.2 + up])
    for shape in (convex_hull(corners), Box(np.array([0.1, 0.3, 0.2]))):
        phi, n = signed_distance(shape, point[None])
        np.testing.assert_allclose(n[0], lean, rtol=0, atol=NORMAL_BESIDE)
        np.testing.assert_allclose(phi[0], np.hypot(off, up), rtol=0, atol=CLOSED_FORM)


@pytest.mark.parametrize("beyond", [1e-6, 3e-8, 1e-9, -1e-9, -1e-6])
@pytest.mark.parametrize("up", [1e-5, 0.05])
def test_a_corner_near_the_edge_of_another_solid(beyond: float, up: float) -> None:
    # A tip above the face z = 0.2, a little past its edge at x = 0.1 or within it. Distances to
    # face and edge differ by beyond^2 / (2 up), less than float64 has: where the foot is decides.
    lean = np.array([max(beyond, 0.0), 0.0, up])
    lean = lean / np.sqrt(lean @ lean)
    corners = np.array([[x, y, z] for x in (-0.1, 0.1) for y in (-0.3, 0.3) for z in (-0.2, 0.2)])
    tip = np.array([0.1 + beyond, 0.05, 0.2 + up])
    ways = np.array([[0, 0, 0], [0.03, 0.01, 0.05], [-0.02, 0.03, 0.06], [0.01, -0.03, 0.07]])
    here = np.eye(3), np.zeros(3)
    other = ShapeInWorld(convex_hull(tip + ways), *here)
    for shape in (convex_hull(corners), Box(np.array([0.1, 0.3, 0.2]))):
        for one, two, sign in (
            (ShapeInWorld(shape, *here), other, 1),
            (other, ShapeInWorld(shape, *here), -1),
        ):
            _, alpha, beta, n = solid_pair("p", one, two)
            np.testing.assert_allclose(sign * n, lean, rtol=0, atol=NORMAL_BESIDE)
            np.testing.assert_allclose(alpha if sign < 0 else beta, tip, rtol=0, atol=CLOSED_FORM)


@pytest.mark.parametrize("angle", [1e-2, 1e-4, 1e-5])
def test_edges_that_cross_nearly_parallel_have_their_common_normal(angle: float) -> None:
    # The edge of a cube turned by 45 degrees is the line z = 0.1 sqrt(2); one that crosses above.
    R = Rotation.from_rotvec([np.pi / 4, 0, 0]).as_matrix()
    cube = ShapeInWorld(Box(np.full(3, 0.1)), R, np.zeros(3))
    way, up = np.array([np.cos(angle), np.sin(angle), 0.0]), np.array([0.0, 0.0, 1.0])
    across = np.cross(up, way)
    middle = np.array([0.01, 0.0, 0.1 * np.sqrt(2) + 0.02])
    ends = [middle - 0.06 * way, middle + 0.04 * way]
    roof = convex_hull([*ends, *(middle + 0.05 * up + s * 0.02 * across for s in (-1, 1))])
    phi, alpha, _, n = solid_pair("p", cube, ShapeInWorld(roof, np.eye(3), np.zeros(3)))
    np.testing.assert_allclose(n, up, rtol=0, atol=CLOSED_FORM)
    np.testing.assert_allclose(phi, 0.02, rtol=0, atol=CLOSED_FORM)
    np.testing.assert_allclose(alpha[:2], middle[:2], rtol=0, atol=CLOSED_FORM / angle)


@pytest.mark.parametrize("seed", range(6))
def test_a_rims_first_corner_is_the_closest_point_and_repeats_it(seed: int) -> None:
    # Rims of two cylinders 1e-5 m apart: the normal is right to 1e-11, and a corner that it led to
    # would have another by 1e-7. The closest pair, and each rim's corner there, are one contact.
    rng = np.random.default_rng(seed)
    one, other = Cylinder(0.06, 0.04), Cylinder(0.05, 0.07)
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
