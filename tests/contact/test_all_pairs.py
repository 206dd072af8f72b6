"""Pairs searched at once against the search one by one: the same bits, or the same error.

``pytest tests/contact/test_all_pairs.py --count 2000`` takes a thousand random scenes.
"""

import itertools
from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from quasistatic_ref import (
    Box,
    Capsule,
    Cylinder,
    HalfSpace,
    PointCloud,
    Sphere,
    convex_hull,
)
from quasistatic_ref.contact import all_pairs
from quasistatic_ref.contact.all_pairs import AllPairs
from tests.closeness import assert_within
from tests.contact.still import one_by_one, pair, placed_shape, searched, standing_links
from tests.made import bits

QUARTER = np.pi / 2


def half_space(rng):
    """One that is level, or any."""
    return HalfSpace((0.0, 0.0, 1.0) if rng.random() < 0.5 else rng.normal(size=3), 0.0)


def box(rng):
    """One of few sizes, so that faces and edges are flush with others."""
    return Box(rng.choice([0.02, 0.03, 0.05], size=3))


def mesh(rng):
    """The hull of a few corners, or a box as a mesh."""
    corners = box(rng).corners(np.eye(3)[0])[0]
    return convex_hull(corners if rng.random() < 0.5 else rng.normal(size=(12, 3)) / 30)


def cloud(rng):
    """One of three: a grid, of which many points are as near as each other; a shell; a point."""
    grid = np.stack(np.unravel_index(np.arange(343), (7, 7, 7)), axis=1) / 100 - 0.03
    shell = np.random.default_rng(0).normal(size=(200, 3))
    shell *= 0.05 / np.linalg.norm(shell, axis=1)[:, None]
    return PointCloud([grid, shell, grid[:1]][rng.choice(3, p=[0.5, 0.4, 0.1])])


SOLIDS = {
    "half-space": half_space,
    "box": box,
    "mesh": mesh,
    "capsule": lambda rng: Capsule(0.02, rng.choice([0.03, 0.05])),
    "sphere": lambda rng: Sphere(rng.choice([0.02, 0.03])),
    "cylinder": lambda rng: Cylinder(0.02, 0.03),
    "cloud": cloud,
}
KINDS = [*itertools.combinations_with_replacement(SOLIDS, 2)][1:-1]
"""Of both sides; two half-spaces are no pair, nor are two clouds."""


def turn(rng):
    """None, by quarters, about z, or any."""
    match rng.integers(4):
        case 0:
            return np.eye(3)
        case 1:
            quarters = Rotation.from_euler("xyz", QUARTER * rng.integers(4, size=3))
            return quarters.as_matrix().round()
        case 2:
            return Rotation.from_euler("z", rng.uniform(0, 6)).as_matrix()
        case _:
            return Rotation.random(rng=rng).as_matrix()


def place(rng):
    """On a grid of sizes, so that solids touch, or anywhere: apart, near and in penetration."""
    grid = rng.choice([0.0, 0.01, 0.02, 0.04, 0.05, 0.07], size=3) * rng.choice([-1, 1], size=3)
    return grid if rng.random() < 0.6 else rng.uniform(-0.1, 0.1, size=3)


def scene(seed):
    """Some pairs of one kind, mixed with others, and where their links are."""
    rng = np.random.default_rng(seed)
    kinds = [KINDS[seed % len(KINDS)]] * 5 + [KINDS[i] for i in rng.integers(len(KINDS), size=4)]
    k = int(rng.choice([1, 2, 4, 5, 12, 30]))
    pairs = []
    for i, names in enumerate(kinds):
        sides = [SOLIDS[name](rng) for name in (names if rng.random() < 0.7 else names[::-1])]
        on_links = [
            placed_shape(solid, 2 * i + j + 1, turn(rng), place(rng) * (rng.random() < 0.3))
            for j, solid in enumerate(sides)
        ]
        pairs.append(pair(*on_links, k if rng.random() < 0.8 else 4))
    spread = rng.choice([0.0, 300.0, 1e6], p=[0.8, 0.1, 0.1])
    alone = rng.random() < 0.5  # only beta's links are far away
    poses = [(turn(rng), place(rng) + spread * (i % 2 or not alone)) for i in range(2 * len(kinds))]
    return pairs, standing_links(*poses)


@pytest.mark.parametrize("upside_down", [False, True])
def test_a_box_far_away_is_searched_as_one_at_the_origin(monkeypatch, upside_down):
    """No pair singly, and to the last bit of what its place leaves."""
    monkeypatch.setattr(all_pairs, "pair_closest_points", None)
    n = (0.0, 0.0, -1.0 if upside_down else 1.0)
    far = [[0.0, 0.0, 0.0], [2.0**10, 0.0, 0.0], [-(2.0**17), 2.0**15, 0.0]]
    R = Rotation.from_euler("z", 0.3).as_matrix()
    sides = placed_shape(HalfSpace(n, 0.0)), Box((0.04, 0.04, 0.04))
    links = standing_links(*((R, np.add(t, [0.0, 0.0, 0.02])) for t in far))
    pairs = [pair(sides[0], placed_shape(sides[1], i + 1), 4) for i in range(3)]
    points = AllPairs(pairs).closest_points(links)
    for i, t in enumerate(far):
        assert bits(points.phi[4 * i :][:4]) == bits(points.phi[:4])
        assert bits(points.point[4 * i :][:4]) == bits(points.point[:4])
        assert_within(points.beta[4 * i :][:4] - t, points.beta[:4], 2.0**-35)


CLOSED = [kind for kind in KINDS if not {"half-space", "cylinder", "cloud"} & {*kind}]
"""Pairs of solids with closed forms, all about as large as each other."""


@pytest.mark.parametrize("away", [pytest.param(2.0**10, marks=pytest.mark.long), 2.0**17])
@pytest.mark.parametrize("kind", CLOSED, ids="-".join)
def test_two_solids_far_away_are_searched_as_at_the_origin(kind, away, count):
    """Places are whole multiples of 2^-20 m, so that both are the same scene.

    Where an edge ends on another, rounding decides whether they cross: that is rare.
    """
    there = away * np.array([1.0, -1.0, 0.5])
    other = 0
    scenes = range(max(20, count // 10))
    for seed in scenes:
        rng = np.random.default_rng(seed)
        shapes = [placed_shape(SOLIDS[name](rng), i + 1) for i, name in enumerate(kind)]
        one = pair(*shapes, int(rng.choice([1, 2, 4, 12])))
        poses = [(turn(rng), np.round(place(rng) * 2.0**20) / 2.0**20) for _ in shapes]
        near, far = (standing_links(*((R, t + way) for R, t in poses)) for way in (0.0, there))
        here, seen = (searched(AllPairs([one]).closest_points, links) for links in (near, far))
        if isinstance(here, str):
            continue
        if bits((here.point, here.tie)) != bits((seen.point, seen.tie)):
            other += 1
            continue
        assert_within(here.phi, seen.phi, 1e-15)
        assert_within(here.n, seen.n, 1e-11)
        assert_within(here.beta + there, seen.beta, 2.0**-53 * 4 * away)
    assert other <= 0.1 * len(scenes)


FEW = len(KINDS)


@pytest.mark.parametrize("first", range(FEW))
def test_pairs_at_once_are_those_one_by_one(first, count):
    """Pairs whose normal is not defined are left out, so that all others are compared, too."""
    for seed in range(first, max(FEW, count // 2), FEW):
        pairs, links = scene(seed)
        at_once = searched(AllPairs(pairs).closest_points, links)
        assert bits(at_once) == bits(searched(one_by_one, pairs, links)), seed
        every = [searched(one_by_one, [one], links) for one in pairs]
        sound = [one for one, each in zip(pairs, every, strict=True) if not isinstance(each, str)]
        written = AllPairs(sound).closest_points(links)
        assert bits(written) == bits(one_by_one(sound, links)), seed


def test_rounded_solids_in_any_pose_are_searched_at_once(monkeypatch):
    """No pair of boxes, capsules, spheres and half-spaces singly, with few contacts or many."""
    rng = np.random.default_rng(0)
    names = ["half-space", "box", "capsule", "sphere"]
    kinds = [*itertools.product(names, names)][1:]
    monkeypatch.setattr(all_pairs, "pair_closest_points", None)
    for k in (1, 2, 4, 12):
        sides = [[placed_shape(SOLIDS[name](rng), 0) for name in kind] for kind in kinds]
        pairs = [
            pair(*(replace(side, link=2 * i + j + 1) for j, side in enumerate(both)), k)
            for i, both in enumerate(sides)
        ]
        poses = [
            (Rotation.random(rng=rng).as_matrix(), np.array([0.0, 0.0, 0.1 * (i % 2)]))
            for i in range(2 * len(pairs))
        ]
        assert len(AllPairs(pairs).closest_points(standing_links(*poses)).phi)
