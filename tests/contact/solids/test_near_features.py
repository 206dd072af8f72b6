"""Of fine meshes and clouds few faces, edges, corners and points are looked at, with equal bits.

``pytest tests/contact/solids/test_near_features.py --count 2000`` takes as many pairs.
"""

import itertools
from functools import cache

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from quasistatic_ref import (
    Box,
    Capsule,
    PointCloud,
    convex_hull,
)
from quasistatic_ref.contact import crossings, distance, ranks
from quasistatic_ref.contact.ranks import closest, near_points, rounded_gaps
from quasistatic_ref.contact.shape_in_world import Pose
from quasistatic_ref.contact.solids import near_features, polytope_pair
from quasistatic_ref.contact.solids.polytope import polytope
from quasistatic_ref.shapes.facets import Facets
from tests.contact.still import in_world, one_by_one, pair, placed_shape, searched, standing_links
from tests.made import bits

KINDS = ("apart", "far", "touching", "flush", "crossing", "deep", "nearly aligned")
UP = np.array([0.0, 0.0, 1.0])


@cache
def solids_without_vertices():
    """One of each kind but a mesh."""
    from tests.oracles.closest import solids

    return [solid for solid in solids().values() if not hasattr(solid, "vertices")]


def random_mesh(rng):
    """A smooth one, a prism with flush faces, or a cut block; up to some 80 corners."""
    count = int(rng.integers(5, 80))
    kind = rng.integers(3)
    if kind == 0:
        points = rng.normal(size=(count, 3))
        points *= rng.uniform(0.5, 1.5, 3) / np.linalg.norm(points, axis=1, keepdims=True)
    elif kind == 1:
        turn = 2 * np.pi * np.arange(count // 2 + 3) / (count // 2 + 3)
        ring = np.column_stack([np.cos(turn), np.sin(turn)])
        ends = [np.column_stack([ring, np.full(len(ring), z)]) for z in (-0.7, 0.7)]
        points = np.concatenate(ends)
    else:
        points = np.round(rng.uniform(-1, 1, (count, 3)) * 4) / 4
        points = np.concatenate([points, np.eye(3), -np.eye(3)])
    return convex_hull(0.05 * 10.0 ** rng.uniform(-2, 2) * points)


def resized(mesh, size):
    return convex_hull(mesh.vertices * (size / mesh.extent))


def random_pair(seed):
    """Two solids in the world, at least one a mesh."""
    rng = np.random.default_rng(seed)
    kind = KINDS[seed % len(KINDS)]
    one = random_mesh(rng)
    size = one.extent
    other = random_mesh(rng)
    other = resized(other, size * rng.uniform(0.3, 2.0))
    if seed % 5 == 0:
        other = Box(half_extents=size * rng.uniform(0.2, 1.0, 3))
    if seed % 11 == 0:
        other = Capsule(radius=0.3 * size, half_length=0.5 * size)
    R_a, R_b = Rotation.random(2, rng=rng).as_matrix()
    if kind in ("flush", "nearly aligned"):  # faces and edges of both in one direction
        R_b = R_a
    if kind == "nearly aligned":
        R_b = R_b @ Rotation.from_rotvec(10.0 ** rng.uniform(-15, -3, 3)).as_matrix()
    n = one.normals[rng.integers(len(one.normals))] if kind == "flush" else rng.normal(size=3)
    n = R_a @ n / np.linalg.norm(n)
    reach = one.support_value((R_a.T @ n)[None])[0] + other.support_value(-(R_b.T @ n)[None])[0]
    gap = {"apart": 0.1, "far": 40.0, "crossing": -0.01, "deep": -0.5 * rng.uniform()}.get(kind, 0)
    t = rng.normal(size=3) * size * 10.0 ** rng.uniform(-1, 3)
    a, b = in_world(one, t, R_a), in_world(other, t + (reach + gap * size) * n, R_b)
    return (b, a) if seed % 2 else (a, b)


def contacts(a, b, k):
    """Some contacts of a pair, or the sentence that refuses it."""
    sides = (placed_shape(solid.shape, i) for i, solid in enumerate((a, b), 1))
    links = standing_links((a.R, a.t), (b.R, b.t))
    return bits(searched(one_by_one, [pair(*sides, k)], links))


def look_at_all(patch):
    """Leave out no faces, edges, triangles, corners, crossings or points."""

    def all_of_them(self, points):
        yield np.arange(len(points)), np.arange(len(self.normals))[None]

    patch.setattr(polytope_pair, "are_fine", lambda *_: False)
    patch.setattr(Facets, "near", all_of_them)
    patch.setattr(ranks, "cannot_be_excluded", lambda solid, bound, *_: np.arange(len(bound)))
    patch.setattr(ranks, "points_of_groups", lambda solid, cloud, *_: np.arange(len(cloud.points)))
    patch.setattr(
        crossings, "overlapping", lambda a, b, n: np.indices((len(a), len(b))).reshape(2, -1)
    )
    patch.setattr(distance, "least_distances", lambda shape, x, *_: np.full(len(x), -np.inf))


def nearly_parallel(seed):
    """Two meshes 10 to 1e4 sizes apart, each edge of one nearly along an edge of the other."""
    rng = np.random.default_rng([7, seed])
    one = random_mesh(rng)
    size = one.extent
    other = random_mesh(rng) if rng.random() < 0.5 else one
    other = resized(other, size * rng.choice([0.5, 1.0, 1.3]))
    R_a = np.eye(3) if rng.random() < 0.5 else Rotation.random(rng=rng).as_matrix()
    axis = np.eye(3)[rng.integers(3)] if rng.random() < 0.6 else rng.normal(size=3)
    R_b = R_a @ Rotation.from_rotvec(axis * 10.0 ** rng.uniform(-16, -5)).as_matrix()
    ways = np.concatenate([np.eye(3), rng.choice(one.normals, 1), rng.normal(size=(1, 3))])
    n = R_a @ ways[rng.integers(len(ways))]
    aside = rng.choice([0.0, 0.3, 1.0]) * np.cross(n, rng.normal(size=3))
    t = size * (10.0 ** rng.uniform(1, 4) * n / np.linalg.norm(n) + aside)
    return in_world(one, np.zeros(3), R_a), in_world(other, t, R_b)


def grid(side):
    """Points of which many are as near as each other."""
    return np.indices((side,) * 3).reshape(3, -1).T / side - 0.5


def cloud_and_solid(seed):
    """A solid, and a cloud about, beside or far from it; one cloud in six is large."""
    rng = np.random.default_rng([9, seed])
    others = solids_without_vertices()
    solid = random_mesh(rng) if seed % 2 else others[seed // 2 % len(others)]
    size = solid.extent if seed % 2 else 0.03
    points = grid(17 if seed % 12 < 2 else int(rng.integers(2, 8)))
    shape = rng.integers(4)
    if shape == 1:
        points /= np.maximum(np.linalg.norm(points, axis=1, keepdims=True), 0.1)
    if shape == 2:
        points = rng.uniform(-0.5, 0.5, points.shape) * [1.0, 1.0, 0.0]
    R_a, R_b = Rotation.random(2, rng=rng).as_matrix()
    t = size * rng.normal(size=3) * rng.choice([0.0, 1.0, 2.0, 1e4])
    cloud = PointCloud(size * rng.choice([0.3, 2.0]) * points)
    return in_world(solid, np.zeros(3), R_a), in_world(cloud, t, R_b if rng.random() < 0.5 else R_a)


@pytest.mark.parametrize("random", [random_pair, nearly_parallel, cloud_and_solid])
def test_random_pairs_have_the_bits_of_a_search_of_all(monkeypatch, count, random):
    for seed in range(2 * count if count < 2000 else count):
        a, b = random(seed)
        k = (1, 2, 4, 70)[seed // len(KINDS) % 4]
        with monkeypatch.context() as patch:
            look_at_all(patch)
            whole = contacts(a, b, k)
        with monkeypatch.context() as patch:
            patch.setattr(polytope_pair, "are_fine", lambda *_: True)
            assert contacts(a, b, k) == whole, seed


def test_a_fine_pair_is_looked_at_near_its_contact_alone(monkeypatch):
    rng = np.random.default_rng(0)
    points = rng.normal(size=(500, 3))
    ball = convex_hull(0.05 * points / np.linalg.norm(points, axis=1, keepdims=True))
    P = polytope(ball).stack_of_one
    settled = []
    whole = distance.corner_surface

    def counted(shape, x, *others):
        settled.append(len(x))
        return whole(shape, x, *others)

    monkeypatch.setattr(distance, "corner_surface", counted)
    for place in (0.099, 0.101, 2.0):
        Q = P.in_frame(np.eye(3)[None], place * UP[None])
        near = near_features.near_features(P, Q, 1e-12)
        assert max(map(len, near)) < 200
        assert len(near[0]) + len(near[1]) > 0
        one, other = in_world(ball, np.zeros(3)), in_world(ball, place * UP)
        settled.clear()
        few = contacts(one, other, 4)
        assert 0 < sum(settled) < 100
        with monkeypatch.context() as patch:
            look_at_all(patch)
            assert contacts(one, other, 4) == few


def test_points_that_are_left_out_are_most_and_rank_after_the_first():
    rng = np.random.default_rng(0)
    points = rng.normal(size=(600, 3))
    points /= np.linalg.norm(points, axis=1, keepdims=True)
    mesh = convex_hull(points[:100] * [0.01, 0.02, 0.03])
    clouds = [0.03 * points[100:], *(0.06 * grid(side) for side in (7, 17))]
    for solid, cloud in itertools.product((*solids_without_vertices(), mesh), clouds):
        left = []
        for t, resolution in itertools.product((0.0, 0.04), (0.0, 1e-11, 1e-3)):
            pose = Pose(Rotation.from_rotvec((0.0, 0.1, t)).as_matrix(), np.array([t, 0.001, 0.0]))
            number, x = near_points(solid, PointCloud(cloud), pose, 5, resolution)
            some, every = (solid.signed_distance(each)[0] for each in (x, pose.points(cloud)))
            first = closest(rounded_gaps(every, resolution), 5).tolist()
            assert number[closest(rounded_gaps(some, resolution), 5)].tolist() == first
            left.append(len(number) / len(cloud))
        if solid is mesh or len(cloud) > 4096:
            assert np.median(left) < (0.1 if solid is mesh else 0.5)
    for cloud in clouds:
        tried = sum(near.size for _, near in mesh.facets.near(cloud))
        assert tried < 0.1 * len(cloud) * len(mesh.triangles)
