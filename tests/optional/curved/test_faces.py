"""What a solid has farthest along a direction, and how that changes with the direction."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from quasistatic_ref import Box, Cylinder
from quasistatic_ref.contact.shape_in_world import ShapeInWorld
from quasistatic_ref.optional.curved.faces import curvature, face, kinks
from tests.closeness import assert_relative, assert_within
from tests.oracles import closest
from tests.tolerances import CURVED_PAIR, DIFFERENCE, DIFFERENCE_STEP, ROUNDING

SOLIDS = closest.solids()
HERE = np.eye(3), np.zeros(3)


def directions(count):
    n = np.random.default_rng(3).normal(size=(count, 3))
    return n / np.linalg.norm(n, axis=1)[:, None]


@pytest.mark.parametrize("name", ["capsule", "cylinder", "cone", "ellipsoid", "box"])
def test_the_curvature_is_the_derivative_of_the_farthest_point(name):
    R = Rotation.from_euler("xyz", [0.3, -0.7, 1.1]).as_matrix()
    solid = ShapeInWorld(SOLIDS[name], R, np.array([0.1, 0.2, 0.3]))
    h = DIFFERENCE_STEP
    for n in directions(20):
        T = np.linalg.svd(n[None])[2][1:]
        for way in T:
            ahead, behind = (solid.farthest((n + s * h * way) / np.hypot(1, h)) for s in (1, -1))
            difference = (ahead - behind) / (2 * h)
            expected = curvature(solid, n) @ way
            assert_within(difference, expected, DIFFERENCE)
        # The farthest point is the same for every length of n.
        assert_within(curvature(solid, n) @ n, 0, CURVED_PAIR)


def flat_normals(name):
    of = kinks(SOLIDS[name])
    found = list(of.normals)
    for u, c in zip(of.axes, of.levels, strict=True):
        m = np.linalg.svd(u[None])[2][1]
        found.append(c * u + np.sqrt(1 - c * c) * m)
    return found


@pytest.mark.parametrize("name", ["capsule", "cylinder", "cone", "box", "mesh"])
def test_every_point_of_a_face_is_as_far_as_the_farthest(name):
    R = Rotation.from_euler("xyz", [0.3, -0.7, 1.1]).as_matrix()
    solid = ShapeInWorld(SOLIDS[name], R, np.array([0.1, 0.2, 0.3]))
    wide = 0
    for own in flat_normals(name):
        n = R @ own
        found = face(solid, n)
        height = float(solid.reach(n[None])[0])
        assert_within(found.corners @ n, height, CURVED_PAIR)
        wide += len(found.corners) > 1 or found.radius > 0
        for x in 0.3 * np.random.default_rng(5).normal(size=(20, 3)):
            on = found.nearest(x)
            depth = SOLIDS[name].signed_distance((R.T @ (on - solid.t))[None])[0]
            assert_within(depth, 0, CURVED_PAIR)
            # Nearest: no corner lies further towards x.
            across = x - on - ((x - on) @ n) * n
            assert ((found.corners - on) @ across).max() <= CURVED_PAIR + (
                found.radius * np.linalg.norm(across)
            )
    assert wide


def test_a_normal_that_is_off_by_a_millionth_is_not_that_of_a_face():
    n = np.array([np.sin(1e-6), 0, np.cos(1e-6)])
    cap = face(ShapeInWorld(Cylinder(0.1, 0.25), *HERE), n)
    assert cap.radius == 0
    assert_within(cap.corners, [[0.1, 0, 0.25]], CURVED_PAIR)
    for size in (1e-3, 1.0, 1e3):  # an edge along y, twice as long as the box is wide
        edge = face(ShapeInWorld(Box(size * np.array([1, 2, 3])), *HERE), n).corners
        expected = size * np.array([[1, -2, 3], [1, 2, 3]])
        assert_relative(edge[edge[:, 1].argsort()], expected, ROUNDING)


def test_a_side_ends_at_the_caps_though_the_normal_is_off_by_rounding():
    R = Rotation.from_euler("xyz", [0.3, -0.7, 1.1]).as_matrix()
    x, _, axis = R.T
    at = ShapeInWorld(Cylinder(1.0, 0.5), R, np.zeros(3))
    side = face(at, x + 0.9e-11 * axis).corners
    assert_within(side @ axis, [-0.5, 0.5], CURVED_PAIR)
    assert_within(side @ x, [1, 1], CURVED_PAIR)
    assert_within(side @ R[:, 1], [0, 0], CURVED_PAIR)
