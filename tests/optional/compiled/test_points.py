"""Contacts of clouds in compiled code against NumPy's: the same bits, or left to it."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from quasistatic_ref import Box, Capsule, HalfSpace, PointCloud, Sphere
from quasistatic_ref.contact.batches.clouds import Clouds
from quasistatic_ref.contact.normals import TIED_FACES
from tests.contact.still import pair, placed_shape
from tests.made import bits

pytestmark = pytest.mark.extra("compiled")

SOLIDS = [
    HalfSpace((0.0, 0.0, 1.0), 0.0),
    HalfSpace((1.0, -2.0, 2.0), 0.3),
    Box((0.25, 0.5, 1.0)),
    Box((0.05, 0.05, 0.05)),
    Sphere(0.1),
    Capsule(0.05, 0.1),
]


def cloud(kind, N, rng):
    """Points of which many are equally near to something: a grid, a shell; or random ones."""
    match kind:
        case "grid":  # exact in binary, so that ties are exact
            side = int(np.ceil(N ** (1 / 3)))
            return (np.argwhere(np.ones((side,) * 3))[:N] - side / 2) / 64
        case "shell":
            points = rng.normal(size=(N, 3))
            return 0.1 * points / np.linalg.norm(points, axis=1, keepdims=True)
        case _:
            return rng.uniform(-0.1, 0.1, size=(N, 3))


def same_bits(batch, R, t):
    """The contacts of C of the pairs that it knows, which are NumPy's."""
    with np.errstate(all="ignore"):
        known, points = batch.contacts(R, t)
        by_numpy, expected = Clouds.contacts.__wrapped__(batch, R, t)
    assert not (known & ~by_numpy).any()
    assert bits(points.chosen(known)) == bits(expected.chosen(known))
    return known, by_numpy


@settings(max_examples=60)
@given(
    some=st.lists(st.sampled_from(SOLIDS), min_size=1, max_size=5),
    kind=st.sampled_from(["grid", "shell", "random"]),
    N=st.sampled_from([2, 3, 30, 500]),
    k=st.sampled_from([1, 5, 12]),
    first=st.booleans(),
    seed=st.integers(0, 1000),
)
def test_contacts_of_a_cloud_on_solids_in_any_pose(some, kind, N, k, first, seed):
    rng = np.random.default_rng(seed)
    points = placed_shape(PointCloud(cloud(kind, N, rng)), 1 + len(some))
    pairs = []
    for i, solid in enumerate(some):
        turn = Rotation.random(rng=rng).as_matrix() if i % 2 else np.eye(3)
        side = placed_shape(solid, 1 + i, turn, rng.uniform(-0.1, 0.1, size=3) * (i % 2))
        sides = (points, side) if first else (side, points)
        pairs.append(pair(*sides, k))
    batch = Clouds(pairs)
    for size in (0.0, 0.01, 0.3, 1e5, 1e200):
        turns = 10 * rng.normal(size=(7, 3)) * (size > 0)
        turns[0] = 0.0
        R = Rotation.from_rotvec(turns).as_matrix()
        known, by_numpy = same_bits(batch, R, size * rng.normal(size=(7, 3)))
        assert size > 1 or (known == by_numpy).all()


def test_points_that_touch_two_faces_at_once_are_left_to_numpy():
    """Points about two edges of a box, at multiples of half of what counts as equal."""
    far = np.array([4.0, 0.0, 0.0])  # of the cloud's frame: no place is larger
    half = TIED_FACES * far[0] / 2
    box = placed_shape(Box((0.25, 0.5, 1.0)), 1)
    R, t = np.array([np.eye(3)] * 3), np.array([[0.0, 0.0, 0.0], [0.0, 0.0, 0.0], far])
    left = 0
    for i, j in np.ndindex(8, 8):
        points = (
            np.array([(0.25 + (i - 4) * half, 0.5 + (j - 4) * half, 0.0), (0.1, 0.7, 0.0)]) - far
        )
        batch = Clouds([pair(box, placed_shape(PointCloud(points), 2))])
        known, by_numpy = same_bits(batch, R, t)
        assert (known == by_numpy).all()
        left += not known.all()
    assert 10 < left < 50
