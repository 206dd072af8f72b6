"""The points of a cloud that can be among the k closest for a while, and until when.

docs/distances.md derives the two bounds that keep all other points out.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from quasistatic_ref.optional.fast.tracker.ball_tree import BallTree
from quasistatic_ref.shapes.placed_shape import HalfSpace, Shape
from quasistatic_ref.step.data import Array, Indices
from quasistatic_ref.step.ordered import rotated
from quasistatic_ref.tolerances import UNSEEN

RATIO = 16.0
"""A point is left out by its distance only if its margin is this many times that by height.

Distances change as fast as a cloud moves, the order of heights only as fast as it turns."""

BEAM = 48
"""Balls of a level that are opened, at least."""

CORNERS = 8
"""Of the box around a cloud."""

_SQRT_3 = float(np.nextafter(np.sqrt(3.0), 2.0))


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
        [m], less the room for rounding; infinite if no point is kept out that way.
    n : ndarray, shape (3,)
        Unit vector in the solid's frame.
    corners : ndarray, shape (8, 3)
        Of the box around the cloud, in the solid's frame [m].
    box : ndarray, shape (8, 3)
        The same corners in the cloud's frame [m].
    """

    index: Indices
    by_distance: float
    by_height: float
    n: Array
    corners: Array
    box: Array

    @cached_property
    def bounds(self) -> tuple[Array, Array]:
        """Functions of the pose, slope . [R, t] + offset [m], of which the least is the limit.

        Returns
        -------
        ndarray, shape (48 + 48, 12), and ndarray, shape (48 + 48,)

        Notes
        -----
        A point that moves by u has its height changed by n . u, its distance by |u| at most, and
        what is rounded by UNSEEN |u|. All these are concave in u, and u is affine in the point:
        over the box the least is at a corner. |u| <= sqrt(3) max |u_i| makes them linear: six
        directions at eight corners for either case.
        """
        ways = _SQRT_3 * np.concatenate([np.eye(3), -np.eye(3)])
        here = np.column_stack([self.box, np.ones(CORNERS)])
        of_heights = self.n + UNSEEN * ways
        of_distances = (1 + UNSEEN) * ways
        slopes = []
        offsets = []
        for directions, bound in ((of_heights, self.by_height), (of_distances, self.by_distance)):
            slopes.append(np.einsum("ai,cj->acij", directions, here).reshape(-1, 12))
            offsets.append(bound - (directions @ self.corners.T).ravel())
        return np.concatenate(slopes), np.concatenate(offsets)


def support_height(shape: Shape, n: Array) -> float:
    """How far a solid reaches along a unit vector: the height of the plane that touches it [m].

    A half-space has such a plane along its own normal only.
    """
    if isinstance(shape, HalfSpace):
        return shape.offset
    return float(shape.support_value(n[None])[0])


def solid_extent(shape: Shape) -> float:
    """About how far from its origin a solid's numbers go [m], at least that far."""
    if isinstance(shape, HalfSpace):
        return abs(shape.offset)
    return float(sum(support_height(shape, n) for n in np.concatenate([np.eye(3), -np.eye(3)])))


def shortlist(
    tree: BallTree, solid: Shape, R: Array, t: Array, n: Array, phi_k: float, k: int, width: int
) -> Shortlist:
    """The points that can be among the k closest at this pose, and as many as `width` in all.

    The tree is walked by levels. Balls and points are ordered by a score: what the motion must use
    up before they can matter. Those that matter at this pose are opened, and the next best.

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
        [m], at least the k-th smallest signed distance at this pose; infinite if not known.
    k, width : int

    Returns
    -------
    Shortlist
    """
    corners = rotated(R, tree.box) + t
    slack = UNSEEN * (solid_extent(solid) + np.abs(tree.box).max() + np.abs(corners).max())
    touching = support_height(solid, n)
    by_distance = by_height = np.inf
    n_cloud = np.abs(n[0] * R[0] + n[1] * R[1] + n[2] * R[2])  # n along the axes of the boxes
    nodes = np.arange(len(tree.levels[0].centre))
    for depth, balls in enumerate(tree.levels):
        radius = balls.radius[nodes]
        x = rotated(R, balls.centre[nodes]) + t
        phi = solid.signed_distance(x)[0]
        if len(nodes) >= k:
            far_side = phi + balls.far_side[nodes]
            phi_k = min(phi_k, float(np.partition(far_side, k - 1)[k - 1]))
        extent = balls.half_extents[nodes] * n_cloud
        depth_below = extent[:, 0] + extent[:, 1] + extent[:, 2]
        height = x[:, 0] * n[0] + x[:, 1] * n[1] + x[:, 2] * n[2] - touching - depth_below
        phi = np.maximum(phi - radius, height)
        far = phi - phi_k
        high = RATIO * (height - phi_k)
        score = np.maximum(far, high)
        last = depth + 1 == len(tree.levels)
        matter = int(np.count_nonzero(score <= 2 * RATIO * slack))
        keep = max(width if last else max(BEAM, width // 4), matter)
        if len(nodes) > keep:
            split = np.argpartition(score, keep)
            out = split[keep:]
            nodes = nodes[split[:keep]]
            is_high = high[out] > far[out]
            by_height = min(by_height, float(height[out[is_high]].min(initial=np.inf)))
            by_distance = min(by_distance, float(phi[out[~is_high]].min(initial=np.inf)))
        if not last:
            children = len(tree.levels[depth + 1].centre) // len(balls.centre)
            nodes = (nodes[:, None] * children + np.arange(children)).reshape(-1)
    index = tree.index[nodes]
    kept = np.sort(index[index >= 0])
    return Shortlist(kept, by_distance - slack, by_height - slack, n, corners, tree.box)
