"""Curved pairs: the same answer at every scale, and normals that settle."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from quasistatic_ref.contact.shape_in_world import ShapeInWorld, Witness
from quasistatic_ref.contact.solids import by_coal
from quasistatic_ref.contact.solids.settle import settled
from quasistatic_ref.contact.solids.solid_pair import solid_pair
from quasistatic_ref.errors import ContactError
from quasistatic_ref.shapes.convex_mesh import ConvexMesh, convex_hull
from quasistatic_ref.shapes.placed_shape import Box, Capsule, Cone, Cylinder, Ellipsoid, Shape
from tests.oracles import closest
from tests.tolerances import CURVED_PAIR, DIFFERENCE, EXACT

SOLIDS = closest.solids()
CURVED = {"cylinder", "cone", "ellipsoid"}
PAIRS = [
    names
    for names in closest.pairs()
    if CURVED & set(names) and not {"sphere", "half-space"} & set(names)
]
SCALES = (1e-5, 1e-3, 0.3, 10.0)
HERE = np.eye(3), np.zeros(3)


def enlarged(solid: Shape, scale: float) -> Shape:
    match solid:
        case Box():
            return Box(scale * solid.half_extents)
        case Ellipsoid():
            return Ellipsoid(scale * solid.half_axes)
        case ConvexMesh():
            return convex_hull(scale * solid.vertices)
        case Capsule() | Cylinder() | Cone():
            return type(solid)(scale * solid.radius, scale * solid.half_length)
    raise AssertionError(solid)


@pytest.mark.parametrize("names", PAIRS, ids="-".join)
def test_an_enlarged_pair_has_the_same_normal_and_a_larger_distance(names) -> None:
    a, b = (SOLIDS[name] for name in names)
    answered = 0
    for R, t in closest.poses(6, 23):
        try:
            one = solid_pair("p", ShapeInWorld(a, *HERE), ShapeInWorld(b, R, t))
        except ContactError:
            continue
        answered += 1
        for k in SCALES:
            A, B = enlarged(a, k), enlarged(b, k)
            other = solid_pair("p", ShapeInWorld(A, *HERE), ShapeInWorld(B, R, k * t))
            np.testing.assert_allclose(other.phi / k, one.phi, rtol=EXACT, atol=CURVED_PAIR)
            # Of several normals that are as good, which one is taken may be rounding.
            gap = closest.gap(A, B, R, k * t, other.n[None])[0]
            np.testing.assert_allclose(gap / k, one.phi, rtol=EXACT, atol=CURVED_PAIR)
    assert answered >= 5


@pytest.mark.parametrize("distance", [60.0, 20.0, 10.0, 2.5])
def test_an_ellipsoid_in_a_cylinder_has_one_normal_at_all_scales(distance) -> None:
    R = Rotation.from_euler("xyz", [1, 0.4, 0.2]).as_matrix()
    found = []
    for k in (1.0, 1e-2, 1e-3, 1e-5):
        cylinder = ShapeInWorld(Cylinder(0.04 * k, 0.025 * k), *HERE)
        ellipsoid = Ellipsoid(k * np.array([0.05, 0.03, 0.02]))
        at = ShapeInWorld(
            ellipsoid, R, 1e-3 * k * np.array([distance, 0.2 * distance, 0.1 * distance])
        )
        witness = solid_pair("p", cylinder, at)
        found.append([witness.phi / k, *witness.n])
    np.testing.assert_allclose(found[1:], [found[0]] * 3, rtol=EXACT, atol=CURVED_PAIR)


def test_a_hair_of_penetration_is_not_nothing() -> None:
    # Two ellipsoids tip to tip, 1.6e-10 m deep: along their common axis, whatever their widths.
    a, b = Ellipsoid(np.array([0.1, 0.05, 0.04])), Ellipsoid(np.array([0.2, 0.03, 0.06]))
    phi = -1.6e-10
    found = solid_pair(
        "p", ShapeInWorld(a, *HERE), ShapeInWorld(b, np.eye(3), np.array([0.3 + phi, 0, 0]))
    )
    # Two coordinates of 0.3 m are rounded: that of b, and that of its tip.
    np.testing.assert_allclose(found.phi, 0.3 + phi - 0.3, rtol=EXACT, atol=2 * np.spacing(0.3))
    np.testing.assert_allclose(found.n, [1, 0, 0], rtol=EXACT, atol=CURVED_PAIR)


@pytest.mark.parametrize("names", PAIRS, ids="-".join)
def test_a_normal_that_is_off_by_a_thousandth_settles_where_it_was(names) -> None:
    a, b = (SOLIDS[name] for name in names)
    random, settles = np.random.default_rng(4), 0
    for R, t in closest.poses(6, 29):
        here, there = ShapeInWorld(a, *HERE), ShapeInWorld(b, R, t)
        try:
            phi, alpha, beta, n = solid_pair("p", here, there)
        except ContactError:
            continue
        off = n + 3e-4 * random.normal(size=3)
        start = Witness(phi, alpha, beta, off / np.linalg.norm(off))
        gaps = [by_coal.judged(here, there, *way) for way in settled(here, there, start)]
        settles += any(
            way.defect <= CURVED_PAIR and abs(way.phi - phi) <= CURVED_PAIR for way in gaps
        )
    assert settles >= 5


def settles_at(a: ShapeInWorld, b: ShapeInWorld, start: Witness, *expected: object) -> bool:
    """Whether one of the maxima near an approximate one has this distance, first point, normal."""
    ends = [(way.phi, way.alpha, way.n) for way in settled(a, b, start)]
    return any(
        all(
            np.abs(np.subtract(*both)).max() <= CURVED_PAIR
            for both in zip(end, expected, strict=True)
        )
        for end in ends
    )


@pytest.mark.parametrize("angle", [0.1, 0.35])
def test_a_normal_that_is_off_by_more_than_a_stride_settles_too(angle) -> None:
    # Two ellipsoids with their tips 0.2 m apart, and a normal turned about z.
    a = ShapeInWorld(Ellipsoid(np.array([0.1, 0.05, 0.04])), *HERE)
    b = ShapeInWorld(Ellipsoid(np.array([0.2, 0.03, 0.06])), np.eye(3), np.array([0.5, 0, 0]))
    start = Witness(0.2, a.t, b.t, np.array([np.cos(angle), np.sin(angle), 0]))
    assert settles_at(a, b, start, 0.5 - 0.1 - 0.2, [0.1, 0, 0], [1, 0, 0])


def test_a_cap_above_an_ellipsoid_has_the_normal_of_the_cap() -> None:
    a = ShapeInWorld(Ellipsoid(np.array([0.1, 0.05, 0.04])), *HERE)
    b = ShapeInWorld(Cylinder(0.1, 0.05), np.eye(3), np.array([0.01, 0.02, 0.04 + 0.03 + 0.05]))
    n = np.array([3e-4, -2e-4, 1.0])
    start = Witness(0.03, a.t, b.t, n / np.linalg.norm(n))
    assert settles_at(a, b, start, 0.03, [0, 0, 0.04], [0, 0, 1])


def test_of_two_caps_on_each_other_the_points_of_the_start_are_taken() -> None:
    a = ShapeInWorld(Cylinder(0.3, 0.1), *HERE)
    b = ShapeInWorld(Cylinder(0.3, 0.1), np.eye(3), np.array([0.05, 0, 0.1 + 0.02 + 0.1]))
    on_a, on_b = np.array([0.06, 0.08, 0.1]), np.array([0.06, 0.08, 0.12])
    assert settles_at(a, b, Witness(0.02, on_a, on_b, np.eye(3)[2]), 0.02, on_a, [0, 0, 1])


def test_where_two_caps_overlap_the_point_next_to_the_start_is_taken() -> None:
    # Discs of radius 1, 1.9 apart: what they share begins at 1.9 - 1 on the line of their centres.
    R = Rotation.from_euler("xyz", [0.3, -0.7, 1.1]).as_matrix()
    solid, n = Cylinder(1.0, 0.1), R[:, 2]
    a, b = (
        ShapeInWorld(solid, R, np.zeros(3)),
        ShapeInWorld(solid, R, R @ [1.9, 0, 0.1 + 0.02 + 0.1]),
    )
    start = Witness(0.02, R @ [0.2, 0, 0.1], R @ [0.2, 0, 0.12], n)
    assert settles_at(a, b, start, 0.02, R @ [1.9 - 1, 0, 0.1], n)


@pytest.mark.parametrize("lengths", [(0.5, 0.5), (0.5, 1e-4), (1e-4, 0.5)])
def test_sides_that_are_parallel_but_for_a_hair_meet_where_they_cross(
    lengths,
) -> None:
    # Axes along z and turned about x by 1e-5, 0.3 m apart in x: crossing at z = 0, off the centres.
    turned = Rotation.from_rotvec([1e-5, 0, 0]).as_matrix()
    a = ShapeInWorld(Cylinder(0.1, lengths[0]), np.eye(3), np.array([0, 0, 0.3 * lengths[0]]))
    at = np.array([0.3, 0, 0]) + 0.4 * lengths[1] * turned[:, 2]
    b = ShapeInWorld(Cylinder(0.1, lengths[1]), turned, at)
    n, aside = np.array([1, 3e-4, 0]), 0.2 * min(lengths)
    start = Witness(0.1, np.array([0.1, 0, aside]), np.array([0.2, 0, aside]), n / np.sqrt(n @ n))
    assert settles_at(a, b, start, 0.3 - 0.1 - 0.1, [0.1, 0, 0], [1, 0, 0])


def test_faces_that_meet_in_one_point_of_a_rim_have_their_contact_there() -> None:
    # A lying cylinder's lowest line, z = 0.09 - 0.05, runs along the rim of a cap at z = 0.08.
    cylinder = Cylinder(0.05, 0.08)
    lying = np.array([[0.0, 0, 1], [0, -1, 0], [1, 0, 0]])
    at = ShapeInWorld(cylinder, lying, np.array([-0.01, 0.05, 0.09]))
    found = solid_pair("p", ShapeInWorld(cylinder, *HERE), at)
    np.testing.assert_allclose(found.phi, 0.04 - 0.08, rtol=EXACT, atol=CURVED_PAIR)
    np.testing.assert_allclose(found.n, [0, 0, 1], rtol=EXACT, atol=CURVED_PAIR)
    np.testing.assert_allclose(found.alpha, [0, 0.05, 0.08], rtol=EXACT, atol=CURVED_PAIR)


def test_a_cone_upside_down_next_to_a_cylinder_just_touches_it() -> None:
    # Radii of 0.05 each, axes parallel and 0.1 apart: the base's rim meets the side.
    down = np.array([[0.0, -1, 0], [-1, 0, 0], [0, 0, -1]])
    cone = ShapeInWorld(Cone(0.05, 0.08), down, np.array([0.1, 0, 0]))
    found = solid_pair("p", ShapeInWorld(Cylinder(0.05, 0.08), *HERE), cone)
    np.testing.assert_allclose(found.phi, 0.1 - 0.05 - 0.05, rtol=EXACT, atol=CURVED_PAIR)
    np.testing.assert_allclose(found.n, [1, 0, 0], rtol=EXACT, atol=CURVED_PAIR)


ABOVE = {
    "the cap": (0.03, 0.01, 0.2),
    "the rim": (0.2, 0.05, 0.2),
    "the side": (0.3, 0.05, 0.02),
}


@pytest.mark.parametrize("place", ABOVE.values(), ids=ABOVE)
@pytest.mark.parametrize("other", ["ellipsoid", "cone"])
def test_what_is_below_a_cylinder_is_as_near_as_what_is_above_it(other, place) -> None:
    # Of an upright cylinder and a solid turned about x, mirrored in z: the other way round, and a
    # cone upside down.
    cylinder = ShapeInWorld(Cylinder(0.1, 0.05), *HERE)
    turned = Rotation.from_rotvec([0.4, 0, 0]).as_matrix()
    mirror = np.array([1, 1, -1])
    flipped = turned.T @ (np.eye(3) if other == "ellipsoid" else np.diag([1, -1, -1]))
    above = solid_pair("p", cylinder, ShapeInWorld(SOLIDS[other], turned, np.array(place)))
    below = solid_pair("p", cylinder, ShapeInWorld(SOLIDS[other], flipped, mirror * place))
    np.testing.assert_allclose(below.phi, above.phi, rtol=EXACT, atol=CURVED_PAIR)
    np.testing.assert_allclose(below.n, mirror * above.n, rtol=EXACT, atol=DIFFERENCE)
    np.testing.assert_allclose(below.alpha, mirror * above.alpha, rtol=EXACT, atol=DIFFERENCE)
