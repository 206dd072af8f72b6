"""Whether another point is as near as the farthest of those that a pair keeps."""

from collections.abc import Sequence

import numpy as np

from quasistatic_ref.contact.distance import ClosestPoints
from quasistatic_ref.optional.derivatives.contact.couples import Couple
from quasistatic_ref.tolerances import TIED


def tied_points(kept: Sequence[Couple], points: ClosestPoints) -> list[int]:
    """Numbers of points of one pair that are equally near, of which not all are kept.

    Parameters
    ----------
    kept : sequence of Couple
        The contacts of one pair.
    points : ClosestPoints
        The same.

    Returns
    -------
    list of int
        Those that are kept first; empty if nothing is tied.
    """
    of = kept[0].of
    pair = of.pair
    if pair.n_c >= pair.candidates or (pair.n_c == 1 and not pair.has_cloud):
        return []  # all of them, or the closest pair of two solids
    as_near = np.abs(of.search.rank - points.phi.max()) <= TIED * of.size
    numbers = of.search.number[as_near]
    are_kept = np.isin(numbers, points.point)
    return [] if are_kept.all() else [*numbers[are_kept].tolist(), *numbers[~are_kept].tolist()]
