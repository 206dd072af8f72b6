"""The points of a cloud that rank first on solids with a closed form: source/points.c."""

from collections.abc import Callable

import numpy as np

from quasistatic_ref.contact.batches.clouds import Clouds
from quasistatic_ref.contact.distance import ClosestPoints
from quasistatic_ref.contact.normals import UNIQUE_NORMAL
from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.numbers.arrays import Array, Mask, read_only
from quasistatic_ref.optional.compiled.library import addresses, function
from quasistatic_ref.shapes.placed_shape import (
    Box,
    Capsule,
    HalfSpace,
    PlacedShape,
    PointCloud,
    Shape,
)


def contacts(batch: Clouds) -> Callable[[Array, Array], tuple[Mask, ClosestPoints]]:
    """``Clouds.contacts`` of a batch in C; pairs that it declines are left to NumPy.

    It returns a mask, shape (pairs,), and the points of the pairs.
    """
    count = len(batch.links)
    shape = count, batch.n_c
    cloud_last = [1, 0] if batch.cloud_is_alpha else [0, 1]
    fixed = (
        np.array([count, len(batch.points), batch.n_c, batch.cloud_is_alpha]),
        np.column_stack([batch.is_plane, batch.has_faces]).astype(np.int64),
        batch.sizes,
        batch.resolution,
        batch.extent,
        batch.links[:, cloud_last],
        batch.poses[:, cloud_last],
        batch.points.T,
        np.empty(len(batch.points)),  # distances
    )
    kept = addresses(fixed)
    compiled = function("cloud_contacts")
    unique = read_only(np.full(shape, UNIQUE_NORMAL))

    def answer(R: Array, t: Array) -> tuple[Mask, ClosestPoints]:
        known = np.empty(count, bool)
        index = np.empty(shape, np.int64)
        numbers = np.empty((10, *shape))
        compiled(*kept, *addresses((R, t), (known, numbers, index)))
        alpha, beta, n = numbers[1:].reshape(3, *shape, 3)
        return known, ClosestPoints(numbers[0], alpha, beta, n, index, unique)

    return answer


def trials_of_contacts() -> list[tuple[Clouds, tuple[Array, Array]]]:
    """A cloud on either side of three kinds of solids, near, far and through them.

    Rotations, shape (L, 3, 3), and origins, (L, 3).
    """
    grid = np.indices((5, 5, 5)).reshape(3, -1).T
    cloud = PointCloud(grid * [0.11, 0.07, 0.13] - 0.2)
    turn = np.array([[0.6, -0.8, 0.0], [0.8, 0.6, 0.0], [0.0, 0.0, 1.0]])
    R = np.array([np.eye(3), turn, turn @ turn, turn.T])
    t = np.array([[0.0, 0.0, 0.0], [0.2, -0.1, 0.3], [-0.3, 0.05, 0.0], [5.0, 0.7, -0.4]])
    solids: list[Shape] = [HalfSpace((0.36, 0.48, 0.8), 0.1), Box((0.2, 0.3, 0.1))]
    solids.append(Capsule(0.2, 0.3))
    found: list[tuple[Clouds, tuple[Array, Array]]] = []
    for cloud_first in (False, True):
        pairs = []
        for i, solid in enumerate(solids * 2):
            alpha = PlacedShape("s", i % 3, turn, t[1], solid)
            beta = PlacedShape("c", 3, turn, t[2], cloud)
            if cloud_first:
                alpha, beta = beta, alpha
            pairs.append(ContactPair(f"p{i}", alpha, beta, 0.5, 0.0, 4, 7))
        found.append((Clouds(pairs), (R, t)))
    return found
