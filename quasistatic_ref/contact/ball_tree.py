"""A tree of balls over a large cloud, built once, flat enough to be walked by whole levels."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from quasistatic_ref.step.data import Array

Indices = NDArray[np.int64]
LEAF = 32
"""Most points of a leaf, and children of a ball."""
SMALL = 1024
"""A level of at most so many balls, or points, is the top one: it is measured whole."""


@dataclass(frozen=True, eq=False)
class Balls:
    """One level: balls that hold all points of the cloud.

    Parameters
    ----------
    centre : ndarray, shape (B, 3)
        In the cloud's frame [m].
    radius : ndarray, shape (B,)
        [m].
    """

    centre: Array
    radius: Array


@dataclass(frozen=True, eq=False)
class BallTree:
    """The levels from the top to the points.

    Parameters
    ----------
    levels : tuple of Balls
        Ball j has as children the next level's c j .. c j + c - 1, where c is the ratio of their
        numbers. The last level are the points, balls of radius 0, some of them twice.
    index : ndarray of int, shape (B of the last level,)
        Each point's index in the cloud; -1 for one that is there again to fill a leaf.
    """

    levels: tuple[Balls, ...]
    index: Indices


def ball_tree(points: Array) -> BallTree:
    """The tree of a cloud, shape (N, 3) [m]: one level, the points, if they are few.

    Nodes are halved along their longest side, all nodes of a depth at once, until none has more
    than LEAF points.
    """
    N, depth = len(points), 0
    while N > SMALL and N > LEAF << depth:
        depth += 1
    leaf = -(-N // (1 << depth))
    order = np.arange(leaf << depth)
    # What fills the last leaf are copies of the last point, told by an index beyond it.
    filled = np.concatenate([points, np.broadcast_to(points[-1], (len(order) - N, 3))])
    for level in range(depth):
        node = filled[order].reshape(1 << level, -1, 3)
        side = np.ptp(node, axis=1).argmax(axis=1)
        key = np.take_along_axis(node, side[:, None, None], axis=2)[..., 0]
        halves = np.argpartition(key, key.shape[1] // 2, axis=1)
        order = np.take_along_axis(order.reshape(key.shape), halves, axis=1).reshape(-1)
    arranged = filled[order]
    levels = [Balls(arranged, np.zeros(len(order)))]
    count = 1 << depth
    while len(levels[0].centre) > SMALL:
        levels.insert(0, _balls(arranged.reshape(count, -1, 3)))
        count //= LEAF
    return BallTree(tuple(levels), np.where(order < N, order, -1))


def _balls(nodes: Array) -> Balls:
    """A ball about each node's points, shape (B, n, 3)."""
    centre = (nodes.min(axis=1) + nodes.max(axis=1)) / 2
    away = nodes - centre[:, None]
    return Balls(centre, np.sqrt(np.sum(away * away, axis=2).max(axis=1)))
