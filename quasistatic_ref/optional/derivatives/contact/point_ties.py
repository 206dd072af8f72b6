"""Whether another point is as near as the farthest of those that a pair keeps."""

from collections.abc import Sequence

import numpy as np

from quasistatic_ref.contact.cloud import signed_distance
from quasistatic_ref.contact.distance import ClosestPoints, late, nearest_of_solids, with_corners
from quasistatic_ref.contact.placed import Placed
from quasistatic_ref.optional.derivatives.contact.couples import Couple
from quasistatic_ref.optional.fast.tracker.cloud_tracker import cloud_tree
from quasistatic_ref.optional.fast.tracker.tracker_bound import shortlist
from quasistatic_ref.shapes.placed_shape import PointCloud
from quasistatic_ref.step.ordered import rotated
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
    pair, (a, b) = kept[0].pair, kept[0].bodies
    if pair.n_c >= pair.candidates or (pair.n_c == 1 and not pair.has_cloud):
        return [], []  # all of them, or the closest pair of two solids
    if isinstance(b.shape, PointCloud):
        index, phi = _near(a, b, b.shape, points.phi, pair.n_c)
    elif isinstance(a.shape, PointCloud):
        index, phi = _near(b, a, a.shape, points.phi, pair.n_c)
    else:
        every = with_corners(a, b, nearest_of_solids(pair, a, b))
        index, phi = every.point, np.where(late(every, pair.k), np.inf, every.phi)
    chosen = set(points.point.tolist())
    out = [(int(i), p) for i, p in zip(index, phi, strict=True) if int(i) not in chosen]
    worst = points.phi.max()
    left_out = [i for i, p in out if abs(p - worst) <= TIED * kept[0].size]
    if not left_out:
        return [], []
    level = np.abs(points.phi - worst) <= TIED * kept[0].size
    return points.point[level].tolist(), left_out


def _near(
    solid: Placed, body: Placed, cloud: PointCloud, phi: np.ndarray, k: int
) -> tuple[np.ndarray, np.ndarray]:
    """Numbers and distances of at least the k + 1 closest points of a cloud."""
    R, t = solid.R.T @ body.R, solid.R.T @ (body.t - solid.t)
    first = cloud.points[:1]
    n = signed_distance(solid.shape, rotated(R, first) + t)[1][0]
    listed = shortlist(cloud_tree(cloud), solid.shape, R, t, n, np.inf, k + 1, 4 * (k + 1))
    return listed.index, signed_distance(solid.shape, rotated(R, cloud.points[listed.index]) + t)[0]
