"""Points that rank first, of clouds on solids and of solids on planes: source/points.c."""

from collections.abc import Callable

import numpy as np

from quasistatic_ref.contact.batches.balls import OnHalfSpaces
from quasistatic_ref.contact.batches.batch import Batch
from quasistatic_ref.contact.batches.clouds import Clouds
from quasistatic_ref.contact.closest_points import ClosestPoints
from quasistatic_ref.contact.normals import FAR_PLACES, UNIQUE_NORMAL
from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.numbers.arrays import Array, Mask, read_only
from quasistatic_ref.optional.compiled.addresses import addresses
from quasistatic_ref.optional.compiled.library import function
from quasistatic_ref.shapes.placed_shape import (
    Box,
    Capsule,
    HalfSpace,
    PlacedShape,
    PointCloud,
    Shape,
)

Contacts = Callable[[Array, Array], tuple[Mask, ClosestPoints]]


def contacts(batch: Clouds) -> Contacts:
    """``Clouds.contacts`` of a batch in C; pairs that it declines are left to NumPy.

    It returns a mask, shape (pairs,), and the points of the pairs.
    """
    none = np.zeros(len(batch.links))
    more = np.column_stack([batch.extent, none, none, none + np.inf])
    flags = np.column_stack([batch.is_plane, batch.has_faces])
    return _of(batch, batch.cloud_is_alpha, flags, batch.sizes, more, batch.points.T)


def on_planes(
    batch: OnHalfSpaces,
) -> Callable[[Array, Array], tuple[Mask, ClosestPoints] | None] | None:
    """``OnHalfSpaces.contacts`` in C, where each contact is at a point of its own.

    Its answer is as above, of P pairs, (P,); it declines pairs that are far away.
    """
    points = batch.points.swapaxes(1, 2)
    count, _, N = points.shape
    if batch.no_corners.any() or not (1 < batch.n_c <= N or batch.n_c == N == 1):
        return None
    more = [np.zeros(count), batch.radius, batch.grain, FAR_PLACES * batch.size]
    planes = np.column_stack([batch.normal[:, 0], batch.offset])
    flags = np.tile([True, False], (count, 1))
    found = _of(batch, batch.turn < 0, flags, planes, np.column_stack(more), points)

    def answer(R: Array, t: Array) -> tuple[Mask, ClosestPoints] | None:
        known, points = found(R, t)
        return (known, points) if known.all() else None  # what is far away is seen from near

    return answer


def _of(
    batch: Batch, cloud_is_alpha: bool, flags: Mask, solids: Array, more: Array, points: Array
) -> Contacts:
    """C's contacts of points, (3, N), or of each pair's own, (P, 3, N) [m], on solids."""
    count = len(batch.links)
    shape = count, batch.n_c
    N = points.shape[-1]
    cloud_last = [1, 0] if cloud_is_alpha else [0, 1]
    fixed = (
        np.array([count, N, batch.n_c, cloud_is_alpha, 3 * N * (points.ndim - 2)]),
        flags.astype(np.int64),
        solids,
        batch.resolution,
        more,
        batch.links[:, cloud_last],
        batch.poses[:, cloud_last],
        points,
    )
    kept = addresses(fixed)
    compiled = function("cloud_contacts")
    unique = read_only(np.full(shape, UNIQUE_NORMAL))

    def answer(R: Array, t: Array) -> tuple[Mask, ClosestPoints]:
        known = np.empty(count, bool)
        index = np.empty(shape, np.int64)
        numbers = np.empty((10, *shape))
        distances = np.empty(N)  # of this call: C runs without Python's lock
        compiled(*kept, *addresses((R, t), (distances, known, numbers, index)))
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


def trials_of_on_planes() -> list[tuple[OnHalfSpaces, tuple[Array, Array]]]:
    """Tilted boxes on half-spaces, and under one. Rotations, (L, 3, 3), and origins, (L, 3)."""
    R, t = trials_of_contacts()[0][1]
    box = Box((0.2, 0.3, 0.1))
    found: list[tuple[OnHalfSpaces, tuple[Array, Array]]] = []
    for turn in (1, -1):
        pairs = []
        for i in range(3):
            sides = [PlacedShape("s", i, R[1], t[1], HalfSpace((0.36, 0.48, 0.8), 0.1))]
            sides.append(PlacedShape("b", 3, R[1], t[2], box))
            alpha, beta = sides[::turn]
            pairs.append(ContactPair(f"p{i}", alpha, beta, 0.5, 0.0, 4, 4))
        found.append((OnHalfSpaces(pairs), (R, t)))
    return found
