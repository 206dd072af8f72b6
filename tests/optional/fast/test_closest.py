"""Contacts in compiled code (source/clouds.c) against the core: the same bits."""

import itertools

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from quasistatic_ref import (
    Box,
    ContactError,
    ContactPair,
    HalfSpace,
    PointCloud,
)
from quasistatic_ref.contact.normals import OF_CLOUD, TIED_FACES
from quasistatic_ref.formats.plain import bits
from tests.contact.solids_of_tests import SHAPES
from tests.contact.still import one_by_one, pair, placed_shape, standing_links
from tests.oracles.posed_pairs import PosedPairs

pytestmark = pytest.mark.extra("fast")


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
        case _:
            return rng.uniform(-0.1, 0.1, size=(N, 3))


def same_bits(posed, pairs, *poses):
    """The contacts of C, which are those of the core, with links 1.. at poses (R, t)."""
    links = standing_links(*poses)
    try:
        expected = one_by_one(pairs, links)
    except ContactError:  # a normal that is not defined
        with pytest.raises(ContactError):
            posed.closest_points(links)
        return None
    written = posed.closest_points(links)
    assert bits(written) == bits(expected)
    return written


def at(*t):
    """Links at places t, none turned."""
    return [(np.eye(3), np.array(place)) for place in t]


@settings(max_examples=25)
@given(
    names=st.lists(st.sampled_from(sorted(SHAPES)), min_size=1, max_size=4),
    kind=st.sampled_from(["grid", "copies", "shell", "random"]),
    N=st.sampled_from([1, 3, 30, 500]),
    k=st.sampled_from([1, 5, 12]),
    seed=st.integers(0, 1000),
)
def test_contacts_of_clouds_on_solids_in_any_pose(names, kind, N, k, seed):
    """Pairs that C knows and others, either side first, apart and inside each other."""
    rng = np.random.default_rng(seed)
    pairs = []
    for i, name in enumerate(names):
        turn = Rotation.random(rng=rng).as_matrix() if i % 2 else np.eye(3)
        solid = placed_shape(SHAPES[name], 1 + i, turn, rng.uniform(-0.1, 0.1, size=3) * (i % 2))
        points = placed_shape(PointCloud(cloud(kind, N, rng)), 1 + len(names))
        sides = (solid, points) if i % 3 else (points, solid)
        pairs.append(ContactPair(f"p{i}", *sides, 0.5, 0.0, 4, k))
    posed = PosedPairs(pairs, 2 + len(names))
    for size in (0.0, 0.01, 0.3):
        turns = [Rotation.from_rotvec(10 * size * v).as_matrix() for v in rng.normal(size=(9, 3))]
        places = size * rng.normal(size=(9, 3))
        same_bits(posed, pairs, *list(zip(turns, places, strict=True))[: 1 + len(names)])


@pytest.mark.parametrize("cloud_first", [False, True])
def test_zero_is_positive(cloud_first):
    """Half a turn about z whose zeros are -0.0, and a height that is -0.0."""
    turned = -np.eye(3)
    turned[2, 2] = 1.0
    points = placed_shape(PointCloud([[1.0, 1.0, 0.0]]), 1)
    pairs = []
    for z in (1.0, -1.0):
        solid = placed_shape(HalfSpace((0.0, 0.0, z), 0.0), R=turned)
        pairs.append(pair(points, solid) if cloud_first else pair(solid, points))
    written = same_bits(PosedPairs(pairs, 2), pairs, *at((0, 0, 0)))
    assert not np.signbit(written.phi).any()
    assert not np.signbit(written.n[:, :2]).any()


def test_points_that_touch_two_faces_at_once_have_the_normal_of_the_core():
    """Points about two edges of a box, at multiples of half of what counts as equal."""
    far = np.array([4.0, 0.0, 0.0])  # of the cloud's frame: no place is larger
    half = TIED_FACES * far[0] / 2
    x, y, z = 0.25, 0.5, 1.0
    box = placed_shape(Box((x, y, z)), 1)
    pairs = []
    for i, j, side in itertools.product(range(-4, 4), range(-4, 4), (1, -1)):
        # The other point makes the whole cloud farthest out along y.
        points = side * np.array([(x + i * half, y + j * half, 0.0), (x / 2, 1.5 * y, 0.0)]) - far
        cloud = placed_shape(PointCloud(points), 2)
        pairs.append(ContactPair(f"{i} {j} {side}", box, cloud, 0.5, 0.0, 4, 1))
    written = same_bits(PosedPairs(pairs, 3), pairs, *at((0, 0, 0), far))
    assert np.count_nonzero(written.tie == OF_CLOUD) > 20
