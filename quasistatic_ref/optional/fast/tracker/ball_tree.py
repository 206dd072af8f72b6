"""A tree of balls over a large cloud, built once, flat enough to be walked by whole levels."""

from dataclasses import dataclass

import numpy as np

from quasistatic_ref.step.data import Array, Indices, Mask

LEAF = 32
"""Most points of a leaf, and children of a ball."""
SMALL = 1024
"""A level of at most so many balls, or points, is the top one: it is measured whole."""


@dataclass(frozen=True, eq=False)
class Level:
    """One level: balls, and boxes in them, that hold all points of the cloud.

    Parameters
    ----------
    centre : ndarray, shape (B, 3)
        In the cloud's frame [m].
    radius : ndarray, shape (B,)
        [m].
    half_extents : ndarray, shape (B, 3)
        Of the boxes with the same centres along the axes of the cloud's frame [m].
    far_side : ndarray, shape (B,)
        From the centre to beyond a point that no other ball of the level has: the radius, or
        infinite where all points are copies [m].
    """

    centre: Array
    radius: Array
    half_extents: Array
    far_side: Array


@dataclass(frozen=True, eq=False)
class BallTree:
    """The levels from the top to the points.

    Parameters
    ----------
    levels : tuple of Level
        Ball j has as children the next level's c j .. c j + c - 1, where c is the ratio of their
        numbers. The last level are the points, balls of radius 0, some of them twice.
    index : ndarray of int, shape (B of the last level,)
        Each point's index in the cloud; -1 for one that is there again to fill a leaf.
    box : ndarray, shape (8, 3)
        Corners of the box around the cloud [m]. In a rigid motion no point of the cloud moves
        farther than the corner that moves most, and none less far along a direction than the one
        that moves least: displacements are affine.
    """

    levels: tuple[Level, ...]
    index: Indices
    box: Array


def ball_tree(points: Array) -> BallTree:
    """The tree of a cloud, shape (N, 3) [m]: one level, the points, if they are few.

    Nodes are halved along their longest side, all nodes of a depth at once, until none has more
    than LEAF points.
    """
    N = len(points)
    depth = 0
    while N > SMALL and LEAF << depth < N:
        depth += 1
    leaf = -(-N // (1 << depth))
    order = np.arange(leaf << depth)
    # What fills the last leaf are copies of the last point, whose index is beyond it.
    filled = np.concatenate([points, np.broadcast_to(points[-1], (len(order) - N, 3))])
    for level in range(depth):
        node = filled[order].reshape(1 << level, -1, 3)
        side = np.ptp(node, axis=1).argmax(axis=1)
        key = np.take_along_axis(node, side[:, None, None], axis=2)[..., 0]
        halves = np.argpartition(key, key.shape[1] // 2, axis=1)
        order = np.take_along_axis(order.reshape(key.shape), halves, axis=1).reshape(-1)
    arranged = filled[order]
    real = order < N
    zero = np.zeros(len(order))
    levels = [Level(arranged, zero, np.zeros((len(order), 3)), np.where(real, 0.0, np.inf))]
    count = 1 << depth
    while len(levels[0].centre) > SMALL:
        levels.insert(0, _balls(arranged.reshape(count, -1, 3), real.reshape(count, -1)))
        count //= LEAF
    low = points.min(axis=0)
    high = points.max(axis=0)
    box = np.where((np.arange(8)[:, None] >> np.arange(3)) & 1, high, low)
    return BallTree(tuple(levels), np.where(real, order, -1), box)


def _balls(nodes: Array, real: Mask) -> Level:
    """A ball about each node's points, shape (B, n, 3), of which some are real."""
    low = nodes.min(axis=1)
    high = nodes.max(axis=1)
    centre = (low + high) / 2
    away = nodes - centre[:, None]
    radius = np.sqrt(np.sum(away * away, axis=2).max(axis=1))
    far_side = np.where(real.any(axis=1), radius, np.inf)
    return Level(centre, radius, (high - low) / 2, far_side)
