"""Flush faces as files write them: rounding makes many facets of one, whose corners still bear.

A prism of N sides and its mirror image on it. By hand: their places are the N corners of the face
between, each as far off as digits round; the normal is off by two grains over the face's width at
most; and the upper one, which is over all N, rests. Corners are drawn turned and moved somehow.
"""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from quasistatic_ref import Body, Box, ContactPair, HalfSpace, Simulator, System, convex_hull
from quasistatic_ref.contact.all_pairs import closest_points
from quasistatic_ref.contact.outlines import GRAIN, outlines
from quasistatic_ref.contact.solids.polytope import polytope
from tests.cases import cases
from tests.contact.still import found_for, one_by_one, pair, placed_shape, standing_links

GROUND = [(0, 0), (3, 0), (3, 2), (2, 3), (0, 2)]
FOUR = [(-1, -1), (1, -1), (1, 1), (-1, 1)]
SIX = np.column_stack([np.cos(np.arange(6) * np.pi / 3), np.sin(np.arange(6) * np.pi / 3)])
WRITTEN = {
    # Polygon, its size and height [m], unit of the file, digits or None for 32 bits, and points
    # within the face of either body.
    "six digits": (FOUR, 0.05, 0.06, 1.0, 6, 0),
    "eight digits": (GROUND, 0.03, 0.05, 1.0, 8, 0),
    "nine digits, a hole": (SIX, 0.02, 0.03, 1.0, 9, 24),
    "32 bits": (FOUR, 0.1, 0.02, 1.0, None, 0),
    "millimetres of 32 bits": (SIX, 0.015, 0.012, 1e-3, None, 30),
    "millimetres of 6 digits, nodes": (FOUR, 0.04, 0.06, 1e-3, 6, 60),
    "nodes of 7 digits": (GROUND, 0.1, 0.1, 1.0, 7, 40),
    "a millimetre of 7 digits": (FOUR, 5e-4, 1e-3, 1e-3, 7, 9),
    "ten metres of 7 digits": (GROUND, 3.0, 5.0, 1.0, 7, 9),
    "thin, 32 bits": (FOUR, 0.05, 1e-3, 1.0, None, 5),
}


def as_written(points, unit, digits):
    """Points as a file has them, read again [m]."""
    if digits is None:
        return np.float32(points / unit).astype(float) * unit
    return np.array([[float(f"{x:.{digits}g}") for x in row] for row in points / unit]) * unit


def flush(rng, polygon, size, height, unit, digits, nodes):
    """Two meshes on each other, and the corners (N, 3) and normal (3,) of the face between them."""
    polygon = size * np.array(polygon, dtype=float)
    N = len(polygon)
    R = Rotation.random(random_state=rng).as_matrix()
    t = rng.uniform(-2, 2, 3) * size
    side = np.concatenate([polygon, 0.9 * polygon + 0.1 * polygon.mean(axis=0)])
    meshes = []
    for way in (-1, 1):
        inner = rng.dirichlet(np.ones(N), nodes) @ polygon
        on_sides = polygon + rng.uniform(0.2, 0.8) * (np.roll(polygon, -1, axis=0) - polygon)
        within = np.concatenate([inner, on_sides[: N * (nodes > 0)]])
        z = np.repeat([0.0, way * height, 0.0], [N, N, len(within)])
        points = np.column_stack([np.concatenate([side, within]), z])
        meshes.append(convex_hull(as_written(points @ R.T + t, unit, digits)))
    corners = np.column_stack([polygon, np.zeros(N)]) @ R.T + t
    return meshes, corners, R[:, 2]


def spread(polygon):
    """Least width of a convex polygon with these corners (N, 2)."""
    way = np.roll(polygon, -1, axis=0) - polygon
    inward = np.column_stack([-way[:, 1], way[:, 0]]) / np.hypot(*way.T)[:, None]
    return (inward @ polygon.T - (inward * polygon).sum(axis=1)[:, None]).max(axis=1).min()


@pytest.mark.parametrize("seed", range(4))
@cases("polygon, size, height, unit, digits, nodes", WRITTEN)
def test_flush_faces_bear_at_the_corners_of_the_face(
    polygon, size, height, unit, digits, nodes, seed
):
    rng = np.random.default_rng(seed)
    (low, high), corners, n = flush(rng, polygon, size, height, unit, digits, nodes)
    k = len(corners)
    kinematics = standing_links((np.eye(3), np.zeros(3)))
    every = pair(placed_shape(low), placed_shape(high, 1), k)
    grain = GRAIN * (low.extent + high.extent)
    found = closest_points([every], kinematics)
    away = np.linalg.norm(found.beta[:, None] - corners, axis=2)
    assert away.min(axis=0).max() <= grain
    assert np.abs(found.phi).max() <= grain
    width = spread(size * np.array(polygon))
    assert np.abs(found.n - n).max() <= 2 * grain / width

    centre = high.vertices.mean(axis=0)
    half = 0.7 * size
    system = System([Body.of_shape("upper", Box((half, half, half)), 1.0, xyz=centre)])
    upper = placed_shape(high, system.link("upper/solid"), t=-centre)
    contact = ContactPair("c", placed_shape(low), upper, 0.5, 0.0, 4, k)
    simulator = Simulator(system, [contact], h=0.01, gravity=-9.81 * n, backend="none")
    q = system.q_start
    for _ in range(3):
        q = simulator.step(q).q
    assert np.abs(q - system.q_start)[:3].max() <= grain


@pytest.mark.parametrize("normal", [(0.0, 0.0, 1.0), (2.0, 1.0, 2.0)])
def test_corners_within_a_face_do_not_bear_on_a_half_space(normal):
    n = np.array(normal) / np.linalg.norm(normal)
    rng = np.random.default_rng(1)
    (_, high), corners, up = flush(rng, FOUR, 0.05, 0.06, 1.0, 8, 30)
    turn, _ = Rotation.align_vectors([n], [up])
    floor = HalfSpace(tuple(n.tolist()), 0.0)
    middle = corners.mean(axis=0)
    kinematics = standing_links((turn.as_matrix(), -turn.apply(middle)))
    pairs = [pair(placed_shape(floor), placed_shape(high, 1), 4)]
    for points in (closest_points(pairs, kinematics), one_by_one(pairs, kinematics)):
        away = np.linalg.norm(points.beta[:, None] - turn.apply(corners - middle), axis=2)
        assert away.min(axis=0).max() <= GRAIN * high.extent


@pytest.mark.parametrize("tilt", [1e-3, 1e-4, 1e-5, 1e-6])
def test_faces_tilted_by_little_keep_their_corners_and_gaps(tilt):
    """A face turned about one of its sides has gaps of 0 and of its width times the tilt."""
    corners = np.array([[x, y, z] for x in (0, 0.1) for y in (0, 0.1) for z in (0, 0.1)])
    brick = convex_hull(corners)
    R = Rotation.from_rotvec([-tilt, 0.0, 0.0]).as_matrix().T
    under = placed_shape(Box((0.2, 0.2, 0.05)), t=(0, 0, -0.05))
    points = found_for(under, placed_shape(brick, 1), standing_links((R, np.zeros(3))), 4)
    heights = np.sort(points.phi)
    assert np.abs(heights - 0.1 * np.sin(tilt) * np.array([0, 0, 1, 1])).max() <= 1e-12


def test_a_ridge_above_two_grains_is_a_feature_and_one_below_half_a_grain_is_none():
    base = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 0)], dtype=float)
    for height, count in ((5 * GRAIN * 2, 10), (GRAIN / 2, 8)):
        ridge = np.array([[-1, 0, height], [1, 0, height]])
        assert outlines(convex_hull(np.vstack([base, ridge]))).corners.sum() == count


def test_meshes_without_facets_within_a_grain_keep_all_corners_and_edges():
    rng = np.random.default_rng(0)
    cube = [[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
    for points in (np.array(cube, dtype=float), *rng.normal(size=(20, 30, 3))):
        mesh = convex_hull(points)
        faces = outlines(mesh)
        assert faces.flat is polytope(mesh)
        assert faces.corners.all()
        heights = mesh.vertices @ faces.flat.normals.T - faces.flat.offsets
        assert (faces.width > 0).all()
        assert heights.max() < 1e-12
