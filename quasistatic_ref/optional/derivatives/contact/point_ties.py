"""Whether another point is as near as the farthest of those that a pair keeps."""

from collections.abc import Sequence

import numpy as np

from quasistatic_ref.contact.distance import ClosestPoints
from quasistatic_ref.optional.derivatives.contact.couples import Couple
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
    if pair.n_c >= pair.candidates or (pair.n_c == 1 and not pair.has_cloud):
        return [], []  # all of them, or the closest pair of two solids
    worst = points.phi.max()
    as_near = of.search.number[np.abs(of.search.rank - worst) <= TIED * of.size]
    left_out = as_near[~(as_near[:, None] == points.point).any(axis=1)].tolist()
    if not left_out:
        return [], []
    level = np.abs(points.phi - worst) <= TIED * of.size
    return points.point[level].tolist(), left_out
