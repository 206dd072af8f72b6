"""Whether another point is as near as the farthest of those that a pair keeps."""

from collections.abc import Sequence

import numpy as np

from quasistatic_ref.contact.distance import ClosestPoints, ranked_last, relative_pose
from quasistatic_ref.contact.shape_in_world import ShapeInWorld, moved
from quasistatic_ref.optional.derivatives.contact.couples import Couple
from quasistatic_ref.shapes.placed_shape import PointCloud
from quasistatic_ref.step.data import Array
from quasistatic_ref.tolerances import TIED


def tied_points(kept: Sequence[Couple], points: ClosestPoints) -> tuple[list[int], list[int]]:
    """Numbers of the kept points of one pair, and of those left out, that are equally near.

    Parameters
    ----------
    kept : sequence of Couple
        The contacts of one pair.
    points : ClosestPoints
        The same.

    Returns
    -------
    kept, left_out : list of int
        Both empty if nothing is tied.
    """
    of = kept[0].of
    pair = of.pair
    a, b = of.bodies
    if pair.n_c >= pair.candidates or (pair.n_c == 1 and not pair.has_cloud):
        return [], []  # all of them, or the closest pair of two solids
    number = np.arange(pair.candidates)
    if pair.has_cloud:
        solid, cloud = (a, b) if isinstance(b.shape, PointCloud) else (b, a)
        phi = _cloud_distances(solid, cloud)
    else:
        every = of.candidates
        phi = np.where(ranked_last(every, pair.k), np.inf, every.phi)
        number = every.point
    worst = points.phi.max()
    as_near = number[np.abs(phi - worst) <= TIED * of.size]
    left_out = as_near[~(as_near[:, None] == points.point).any(axis=1)].tolist()
    if not left_out:
        return [], []
    level = np.abs(points.phi - worst) <= TIED * of.size
    return points.point[level].tolist(), left_out


def _cloud_distances(solid: ShapeInWorld, cloud: ShapeInWorld) -> Array:
    """Signed distances of all points of a cloud, shape (N,) [m]."""
    assert isinstance(cloud.shape, PointCloud)
    x = moved(relative_pose(solid, cloud), cloud.shape.points)
    return solid.shape.signed_distance(x)[0]
