"""How much of what its cone can bear a contact's friction and torsion are, together."""

from functools import cache

import numpy as np

from quasistatic_ref.step.cones import cone
from quasistatic_ref.step.data import Array


def gauge(name: str, wrench: Array, mu_v: Array, mu_omega: Array) -> Array:
    """The normal force that contacts need for their friction and torsion, shape (..., n_c) [N].

    It is the gauge of the cone's base: in the pyramid (|f_1| + |f_2|) / mu_v + |tau| / mu_omega, in
    the ellipsoid the length of these three, in other polyhedral cones the least sum of multipliers.
    Terms whose coefficient is 0 are left out.

    Parameters
    ----------
    name : str
        Of the cone.
    wrench : ndarray, shape (..., n_c, 4)
        (f_d1, f_d2, f_n, tau_n) [N, N m].
    mu_v, mu_omega : ndarray, shape (n_c,)
        [-] and [m].
    """
    mu = np.stack([mu_v, mu_v, mu_omega], axis=-1)
    parts = wrench[..., [0, 1, 3]]
    needs = np.divide(parts, mu, out=np.zeros_like(parts), where=mu > 0)
    if not cone(name).polyhedral:
        return np.asarray(np.linalg.norm(needs, axis=-1))
    return np.asarray((needs @ _facets(name).T).max(axis=-1, initial=0.0))


@cache
def _facets(name: str) -> Array:
    """Of the hull of a cone's directions the facets a, shape (F, 3), where it is a . x <= 1."""
    from scipy.spatial import ConvexHull  # takes as long as a short run

    directions = cone(name).matrix[:, 1:]
    if not directions.any():
        return np.zeros((0, 3))
    equations = ConvexHull(directions).equations
    return np.asarray(equations[:, :3] / -equations[:, 3:])
