"""Contacts followed from step to step against the brute force: the same bits, whatever happens."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from quasistatic_ref.contact import ball_tree, cloud_tracker
from quasistatic_ref.contact.distance import closest_points
from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.contact.tracker import ContactTracker
from quasistatic_ref.errors import ContactError
from quasistatic_ref.model.convex_mesh import convex_hull
from quasistatic_ref.model.shapes import (
    Box,
    Capsule,
    Cone,
    Cylinder,
    Ellipsoid,
    HalfSpace,
    PlacedShape,
    PointCloud,
    Sphere,
)
from quasistatic_ref.model.system import Kinematics
from tests.tolerances import EXACT

WEDGE = np.array([[0, 0, 0], [0.2, 0, 0], [0, 0.2, 0], [0, 0, 0.2], [0.2, 0.2, 0.1]])
SHAPES = {
    "sphere": Sphere(0.1),
    "box": Box(np.array([0.05, 0.125, 0.25])),
    "capsule": Capsule(0.05, 0.1),
    "cylinder": Cylinder(0.1, 0.05),
    "cone": Cone(0.1, 0.1),
    "ellipsoid": Ellipsoid(np.array([0.05, 0.1, 0.2])),
    "half-space": HalfSpace(np.array([0.0, 0.0, 1.0]), -0.0625),
    "tilted half-space": HalfSpace(np.array([1.0, 2.0, 2.0]), 0.1),
    "hull": convex_hull(WEDGE),
}
FIELDS = ("phi", "alpha", "beta", "n", "point")


def cloud(kind, N, rng):
    """Points of which many are equally near to something: a grid, one point N times, a shell."""
    match kind:
        case "grid":  # exact in binary, so that ties are exact
            side = int(np.ceil(N ** (1 / 3)))
            return (np.stack(np.unravel_index(np.arange(N), (side,) * 3), axis=1) - side / 2) / 64
        case "copies":
            return np.repeat(rng.normal(size=(max(1, N // 8), 3)) / 16, 8, axis=0)[:N]
        case "shell":
            points = rng.normal(size=(N, 3))
            return 0.1 * points / np.linalg.norm(points, axis=1, keepdims=True)
        case "one place":
            return np.tile([[0.03, 0.0, -0.03]], (N, 1))
        case _:
            return rng.uniform(-0.1, 0.1, size=(N, 3))


CLOUDS = ["grid", "copies", "shell", "one place", "random"]
MOVES = ["stay", "creep", "slide", "turn", "come and go", "run", "jump", "inside"]


def moved(R, t, move, rng):
    """The next pose of a body."""
    small = {"creep": 1e-5, "turn": 1e-3, "run": 1e-2}.get(move, 0.0)
    turn = Rotation.from_rotvec(small * rng.normal(size=3)).as_matrix()
    match move:
        case "stay":
            return R, t
        case "slide":
            return R, t + [1e-3, 0.0, 0.0]
        case "come and go":
            return R, t + [0.0, 0.0, rng.choice([-2e-3, 2e-3])]
        case "jump":
            return Rotation.random(rng=rng).as_matrix(), rng.uniform(-0.5, 0.5, size=3)
        case "inside":
            return R, rng.uniform(-0.01, 0.01, size=3)
        case _:
            return R @ turn, t + small * rng.normal(size=3)


def scene(names, kinds, rng, N, k):
    """One cloud on each solid; the solids on links 1.., the clouds on the links after them."""
    pairs = []
    for i, (name, kind) in enumerate(zip(names, kinds, strict=True)):
        R = Rotation.random(rng=rng).as_matrix() if i % 2 else np.eye(3)
        solid = PlacedShape(name, 1 + i, R, rng.uniform(-0.1, 0.1, size=3) * (i % 2), SHAPES[name])
        points = PointCloud(cloud(kind, N, rng))
        some = PlacedShape(kind, 1 + len(names) + i, np.eye(3), np.zeros(3), points)
        sides = (solid, some) if i % 3 else (some, solid)
        pairs.append(ContactPair(f"p{i}", *sides, 0.5, 0.0, 4, k))
    return pairs


def same_bits(tracker, pairs, R, t):
    expected = closest_points(pairs, Kinematics(R, t, np.zeros((len(R), 6, 0))))
    found = tracker.closest_points(R, t)
    for field in FIELDS:
        np.testing.assert_allclose(
            getattr(found, field), getattr(expected, field), rtol=EXACT, atol=EXACT, err_msg=field
        )


@settings(max_examples=60)
@given(
    names=st.lists(st.sampled_from(sorted(SHAPES)), min_size=1, max_size=4),
    kinds=st.lists(st.sampled_from(CLOUDS), min_size=4, max_size=4),
    moves=st.lists(st.sampled_from(MOVES), min_size=1, max_size=10),
    N=st.sampled_from([1, 3, 30, 100, 500]),
    k=st.sampled_from([1, 5, 12]),
    levels=st.booleans(),
    seed=st.integers(0, 1000),
)
def test_followed_contacts_are_those_of_brute_force(names, kinds, moves, N, k, levels, seed):
    rng = np.random.default_rng(seed)
    with pytest.MonkeyPatch.context() as patch:
        if levels:  # trees of several levels already for these few points
            patch.setattr(ball_tree, "SMALL", 16)
            patch.setattr(ball_tree, "LEAF", 4)
        patch.setattr(cloud_tracker, "WIDTH", 16)
        patch.setattr(cloud_tracker, "WIDE", 40)
        pairs = scene(names, kinds[: len(names)], rng, N, k)
        tracker = ContactTracker(pairs)
        L = 1 + 2 * len(names)
        R, t = np.tile(np.eye(3), (L, 1, 1)), np.zeros((L, 3))
        t[1 + len(names) :] = rng.uniform(-0.3, 0.3, size=(len(names), 3))
        for move in moves:
            for link in range(1, L):
                R[link], t[link] = moved(R[link], t[link], move, rng)
            same_bits(tracker, pairs, R, t)
