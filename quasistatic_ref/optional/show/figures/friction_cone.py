"""The friction that a cone allows without torque."""

import numpy as np
from scipy.spatial import ConvexHull

from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.optional.friction import cone_matrix
from quasistatic_ref.optional.show.figures.looks import ROUND
from quasistatic_ref.step.cones import cone


def rim(name: str) -> Array:
    """Corners of (f_1, f_2) / (mu_v f_n) that a cone allows, where tau_n = 0.

    Parameters
    ----------
    name : str
        Of the cone.

    Returns
    -------
    ndarray, shape (N, 2)
        In order around; no rows without friction.
    """
    if not cone(name).polyhedral:  # the ellipsoid's is a circle
        angle = np.linspace(0, 2 * np.pi, ROUND, endpoint=False)
        return np.column_stack([np.cos(angle), np.sin(angle)])
    # Torques of both signs are alike: what is left without them is what is seen along them.
    corners = cone_matrix(name)[:, 1:3]
    return np.asarray(corners[ConvexHull(corners).vertices] if len(corners) > 2 else corners[:0])
