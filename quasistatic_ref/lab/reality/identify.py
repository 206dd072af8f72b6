r"""mu_omega / mu_v of a support, from measured loads and the motions that they caused.

In the ellipsoid a slider moves along the normal of its limit surface (R28): its twist (v, omega)
lies along (f, tau / chi^2) for the load (f, tau) of the pusher, with chi = mu_omega / mu_v.
Directions of twists are compared as unit vectors of (v, rho omega), rho being the radius of
gyration of the outline. If measured directions scatter about the predicted ones as a von
Mises-Fisher distribution, whose concentration does not depend on chi, the likelihood is largest
where the mean cosine of the angle between them is.
"""

import numpy as np
from scipy.optimize import minimize_scalar

from quasistatic_ref.lab.reality.measurements import Loads
from quasistatic_ref.numbers.arrays import Array

GRID = np.geomspace(1e-3, 1.0, 241)
"""Ratios between which the best is looked for [m]: 3 % apart."""


def identified_ratio(loads: Loads, rho: float) -> float:
    """mu_omega / mu_v of the loads on one support [m]: the best of GRID, then between neighbours.

    Parameters
    ----------
    loads : Loads
        About the centre of mass.
    rho : float
        Radius of gyration of the outline, by which turns are compared with displacements [m].
    """

    def loss(chi: float) -> float:
        return float((1 - cosines(loads, chi, rho)).mean())

    k = int(np.argmin([loss(chi) for chi in GRID]))
    ends = np.log([GRID[max(k - 1, 0)], GRID[min(k + 1, len(GRID) - 1)]])
    least = minimize_scalar(lambda x: loss(float(np.exp(x))), bounds=tuple(ends), method="bounded",
                            options={"xatol": 1e-9})  # fmt: skip
    return float(np.exp(least.x))


def cosines(loads: Loads, chi: float, rho: float) -> Array:
    """Cosines of the angles between measured twists and those predicted by loads, (n,).

    Parameters
    ----------
    loads : Loads
    chi, rho : float
        mu_omega / mu_v, and the length by which turns are scaled [m].
    """
    predicted = loads.wrench * [1, 1, rho / chi**2]
    measured = loads.twist * [1, 1, rho]
    cosine: Array = np.einsum("ij,ij->i", units(predicted), units(measured))
    return cosine


def units(x: Array) -> Array:
    """Rows as unit vectors, shape (n, 3)."""
    unit: Array = x / np.linalg.norm(x, axis=1, keepdims=True)
    return unit
