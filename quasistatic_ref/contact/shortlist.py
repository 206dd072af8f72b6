"""The points of a cloud that can be among the k closest for a while, and until when.

docs/distances.md derives the two bounds that keep all other points out.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from quasistatic_ref.contact.ball_tree import BallTree, Indices
from quasistatic_ref.contact.cloud import signed_distance
from quasistatic_ref.contact.poses import rotated
from quasistatic_ref.contact.support import support_value
from quasistatic_ref.model.shapes import HalfSpace, Shape, Sphere
from quasistatic_ref.step.data import Array

RATIO = 16.0
"""How much farther than in height a point must be in distance to be left out: the distance of a
cloud that comes or goes changes as fast as it moves, the order of heights only as fast as it turns."""

BEAM = 48
"""Balls of a level that are opened, at least."""


@dataclass(frozen=True, eq=False)
class Shortlist:
    """Points, and what holds for every other point at the pose where the list was made.

    Every other point's signed distance is at least `by_distance`, or its height above the plane
    with normal n that touches the solid is at least `by_height`.

    Parameters
    ----------
    index : ndarray of int, shape (m,)
        Of the points, ascending.
    by_distance, by_height : float
        [m]; infinite if no point is kept out that way.
    n : ndarray, shape (3,)
        Unit vector in the solid's frame.
    """

    index: Indices
    by_distance: float
    by_height: float
    n: Array


def reach(shape: Shape, n: Array) -> float:
    """How far a solid reaches along a unit vector: the height of the plane that touches it [m].

    A half-space has such a plane along its own normal only.
    """
    match shape:
        case Sphere():
            return shape.radius
        case HalfSpace():
            return shape.offset
        case _:
            return float(support_value(shape, n[None])[0])


def size(shape: Shape) -> float:
    """About how far from its origin a solid's numbers go [m], at least that far."""
    if isinstance(shape, HalfSpace):
        return abs(shape.offset)
    return float(sum(reach(shape, n) for n in np.concatenate([np.eye(3), -np.eye(3)])))


def shortlist(
    tree: BallTree, solid: Shape, R: Array, t: Array, n: Array, phi_k: float, width: int
) -> Shortlist:
    """The `width` points that will be the last to be kept out, or almost.

    The tree is walked by levels. Of each level, the balls that are opened are those whose score is
    least, the score being what the motion must use up before a point of the ball can matter.

    Parameters
    ----------
    tree : BallTree
    solid : any but a cloud
    R, t : ndarray, shapes (3, 3) and (3,)
        From the cloud's frame to the solid's.
    n : ndarray, shape (3,)
        Any unit vector in the solid's frame; good is the normal at the closest point. Of a
        half-space its normal.
    phi_k : float
        About the k-th least signed distance [m]; any number is right, a good one is good.
    width : int

    Returns
    -------
    Shortlist
    """
    touching = reach(solid, n)
    by_distance = by_height = np.inf
    nodes = np.arange(len(tree.levels[0].centre))
    for depth, balls in enumerate(tree.levels):
        x = rotated(R, balls.centre[nodes]) + t
        phi = signed_distance(solid, x)[0] - balls.radius[nodes]
        height = x[:, 0] * n[0] + x[:, 1] * n[1] + x[:, 2] * n[2] - touching - balls.radius[nodes]
        far, high = phi - phi_k, RATIO * (height - phi_k)
        last = depth + 1 == len(tree.levels)
        keep = width if last else max(BEAM, width // 4)
        if len(nodes) > keep:
            split = np.argpartition(np.maximum(far, high), keep)
            out, nodes = split[keep:], nodes[split[:keep]]
            is_high = high[out] > far[out]
            by_height = min(by_height, float(height[out[is_high]].min(initial=np.inf)))
            by_distance = min(by_distance, float(phi[out[~is_high]].min(initial=np.inf)))
        if not last:
            children = len(tree.levels[depth + 1].centre) // len(balls.centre)
            nodes = (nodes[:, None] * children + np.arange(children)).reshape(-1)
    index = tree.index[nodes]
    return Shortlist(np.sort(index[index >= 0]), by_distance, by_height, n)
