"""Polytopes near contact, at every scale, however the pair is turned: expected from construction.

A pair is constructed about a contact whose normal is known, made larger or smaller, and moved.
"""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from quasistatic_ref import Box, Capsule, convex_hull
from quasistatic_ref.contact.solids.polytope import polytope
from tests.closeness import assert_within
from tests.contact.still import in_world, solid_pair
from tests.tolerances import CLOSED_FORM, OF_DIFFERENCE

SCALES = [1e-5, 1e3]
X, _, Z = np.eye(3)
HALF = np.array([0.1, 0.3, 0.2])
CORNERS = HALF * [[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
ROOF = np.array([[0, 0, 0], [0.03, 0.01, 0.05], [-0.02, 0.03, 0.06], [0.01, -0.03, 0.07]])
"""A tip at the origin, and what is above it."""


def turned(x, y, z):
    return Rotation.from_euler("xyz", [x, y, z]).as_matrix()


def moved_pair(a, R_a, b, R_b, t_b, seed):
    """The closest points after a motion of both, in the frame before it; a is at the origin."""
    rng = np.random.default_rng(seed)
    S = Rotation.random(rng=rng).as_matrix()
    s = np.abs(t_b).max() * rng.normal(size=3)
    found = solid_pair("p", in_world(a, s, S @ R_a), in_world(b, S @ t_b + s, S @ R_b))
    alpha, beta = ((point - s) @ S for point in (found.alpha, found.beta))
    return found._replace(alpha=alpha, beta=beta, n=found.n @ S)


@pytest.mark.parametrize("scale", SCALES)
@pytest.mark.parametrize("gap", [0.01, -0.01])
@pytest.mark.parametrize("angle", [1.2, 1e-3])
def test_edges_that_cross_are_closest_where_they_cross(angle, gap, scale):
    # Cubes on edge: the upper edge of one is the line z = 0.1 sqrt(2) along x, the lower edge of
    # the other is turned about z. In penetration the way out by a face, (|gap| + 0.1 sin(angle)) /
    # sqrt(2), is longer.
    gap *= angle
    cube = Box(np.full(3, 0.1 * scale))
    on_edge = turned(np.pi / 4, 0, 0)
    top = 0.1 * np.sqrt(2)
    t = scale * np.array([0.02, 0, 2 * top + gap])
    for seed in range(2):
        found = moved_pair(cube, on_edge, cube, turned(0, 0, angle) @ on_edge, t, seed)
        alpha = np.array([0.02, 0, top])
        assert_within(found.phi / scale, gap, CLOSED_FORM)
        assert_within(found.n, Z, CLOSED_FORM)
        for point, expected in ((found.alpha, alpha), (found.beta, alpha + gap * Z)):
            assert_within(point / scale, expected, CLOSED_FORM / angle)


@pytest.mark.parametrize("scale", SCALES)
@pytest.mark.parametrize(
    ("angle", "apart"), [(1.0, 0.1), (-1.0, 1e-7), (1e-3, 1e-7), (1.0, 0.0), (1e-3, 0.0), (1e-9, 0)]
)
def test_capsules_that_cross_have_the_common_normal_of_their_axes(angle, apart, scale):
    # Axes along z, and turned about the common normal x; they cross at z = 0.02.
    one = Capsule(0.03 * scale, 0.1 * scale)
    other = Capsule(0.02 * scale, 0.1 * scale)
    own = turned(0, 0, 0.5)
    across = turned(angle, 0, 0)
    t = scale * (apart * X + 0.02 * Z + 0.03 * across[:, 2])
    for seed in range(2):
        found = moved_pair(one, own, other, across, t, seed)
        assert_within(found.phi / scale, apart - 0.05, CLOSED_FORM)
        along = [found.n @ Z, found.n @ across[:, 2], found.n @ found.n]
        assert_within(along, [0, 0, 1], CLOSED_FORM)
        if apart:
            assert_within(found.n, X, CLOSED_FORM)


NEAR_EDGE = [
    *[(0.6 * off, 0.8 * off) for off in (1e-9, 1e-4, 0.05)],
    *[(beyond, up) for beyond in (1e-6, 3e-8, 1e-9, -1e-9, -1e-6) for up in (1e-5, 0.05)],
]


@pytest.mark.parametrize("scale", SCALES)
@pytest.mark.parametrize(("beyond", "up"), NEAR_EDGE)
def test_a_tip_near_an_edge_leans_away_from_it_only_beyond_it(beyond, up, scale):
    # The tip is above the face z = 0.2, a little past its edge at x = 0.1 or within it. Distances
    # to face and edge may differ by beyond^2 / (2 up), less than float64 has: then the foot's place
    # decides.
    way = np.array([max(beyond, 0.0), 0.0, up])
    off = np.sqrt(way @ way)
    tip = np.array([HALF[0] + beyond, 0.05, HALF[2] + up])
    t = scale * tip
    roof = convex_hull(scale * ROOF)
    for box in (Box(scale * HALF), convex_hull(scale * CORNERS)):
        _, normals = box.signed_distance(t[None])
        for seed in range(4):
            found = moved_pair(box, np.eye(3), roof, np.eye(3), t, seed)
            other = moved_pair(roof, np.eye(3), box, np.eye(3), -t, seed)
            for n in (normals[0], found.n, -other.n):
                assert_within(n, way / off, OF_DIFFERENCE / off)
            for phi in (found.phi, other.phi):
                assert_within(phi / scale, off, CLOSED_FORM)
            assert_within(found.beta / scale, tip, CLOSED_FORM)


@pytest.mark.parametrize("scale", SCALES)
def test_points_above_a_face_of_a_mesh_have_its_normal_on_the_diagonal_too(scale):
    # Two triangles are a face, and rounding puts some points above their common edge in neither.
    R = turned(0.3, -0.7, 1.1)
    hull = convex_hull(scale * CORNERS @ R.T)
    across = np.linspace(-0.9, 0.9, 101)
    for up in (1e-9, 1e-5):
        for sign in (1, -1):
            diagonal = np.column_stack([across, sign * across, np.ones(101)]) * HALF + up * Z
            phi, n = hull.signed_distance(scale * diagonal @ R.T)
            assert_within(phi / scale, up, CLOSED_FORM)
            expected = np.tile(R[:, 2], (101, 1))
            assert_within(n, expected, CLOSED_FORM)


def test_a_polytope_stays_with_its_shape_however_many_there_are():
    boxes = [Box((0.1, 0.1, 0.001 * (1 + i))) for i in range(1000)]
    first = [polytope(box) for box in boxes]
    assert all(polytope(box) is one for box, one in zip(boxes, first, strict=True))
    assert polytope(Box(boxes[-1].half_extents)) is first[-1]
