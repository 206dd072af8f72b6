"""The friction that a cone leaves beside a torque."""

from itertools import combinations

import numpy as np
from scipy.spatial import ConvexHull

from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.optional.friction import cone_matrix
from quasistatic_ref.optional.show.figures.looks import ROUND
from quasistatic_ref.step.cones import cone


def limit_at(name: str, share: float) -> Array:
    """Corners of (f_1, f_2) / (mu_v f_n) that a cone allows where |tau_n| = share mu_omega f_n.

    Parameters
    ----------
    name : str
        Of the cone.
    share : float
        From 0 to 1 [-].

    Returns
    -------
    ndarray, shape (N, 2)
        In order around; no rows where no more than a point is left.
    """
    if not cone(name).polyhedral:  # the ellipsoid's is a circle
        angle = np.linspace(0, 2 * np.pi, ROUND, endpoint=False)
        circle = np.column_stack([np.cos(angle), np.sin(angle)])
        return np.asarray(np.sqrt(1 - share**2) * circle)
    corners = cone_matrix(name)[:, 1:]
    section = [corner[:2] for corner in corners if corner[2] == share]
    for one, other in combinations(corners, 2):
        if (one[2] - share) * (other[2] - share) < 0:
            way = (share - one[2]) / (other[2] - one[2])
            section.append((1 - way) * one[:2] + way * other[:2])
    points = np.array(section)
    if len(points) < 3 or not np.ptp(points, axis=0).all():
        return np.zeros((0, 2))
    return np.asarray(points[ConvexHull(points).vertices])
