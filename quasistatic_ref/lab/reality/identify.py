r"""mu_omega / mu_v of a support, from measured loads and the motions that they caused.

In the ellipsoid a slider moves along the normal of its limit surface (R28): its twist (v, omega)
lies along (f, tau / c^2) for the load (f, tau) of the pusher, with c = mu_omega / mu_v. Directions
of twists are compared as unit vectors of (v, rho omega), rho being the radius of gyration of the
outline. If measured directions scatter about the predicted ones as a von Mises-Fisher distribution,
whose concentration kappa does not depend on c, the likelihood is largest where the mean cosine of
the angle between them is (derived in docs/reality.md).

No pushes are read here, nor by anything that this module imports: a test holds that.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.optimize import minimize_scalar

from quasistatic_ref.lab.reality.loads import Loads
from quasistatic_ref.step.cones import ELLIPSOID, cone_matrix
from quasistatic_ref.step.data import Array

SMALLEST, LARGEST = 1e-3, 1.0
"""Between which a ratio is looked for [m]."""

NORMAL = 1.959963984540054
"""Standard deviations of a normal distribution on either side of 95 % of it [-]."""

WIDEST = 1.25
"""Largest upper over lower end of an interval at which a ratio counts as identified [-]: the
ratio, and with it a turn per advance, is then known to about a tenth."""

NONE, UNDECIDED = 1e-12, 20.0
"""Information that is none [-], and the logarithm of the widest interval that is stated [-]."""

FEWEST = 10
"""Loads below which nothing is identified."""

DRAWS = 200
"""Of a bootstrap."""


@dataclass(frozen=True)
class Identified:
    """A ratio, how well data decide it, and what else they say.

    Parameters
    ----------
    ratio : float
        mu_omega / mu_v [m].
    low, high : float
        Ends of its 95 % interval [m]: by Fisher information in the ellipsoid, by the bootstrap in
        other cones.
    drawn_low, drawn_high : float
        Ends of the 95 % interval by the bootstrap [m].
    information : float or None
        Fisher information of the logarithm of the ratio, in the ellipsoid [-].
    reverse : float or None
        The ratio where loads are predicted from motions, in the ellipsoid [m]: errors of measured
        loads make the first ratio too large, those of motions make this one too small.
    misfit : float
        The mean of :func:`lost_share`, at the ratio at which it is smallest [-].
    friction : float
        Median of mu_v times the load on the support [N].
    count : int
        Number of loads.
    """

    ratio: float
    low: float
    high: float
    drawn_low: float
    drawn_high: float
    information: float | None
    reverse: float | None
    misfit: float
    friction: float
    count: int

    @property
    def identifiable(self) -> bool:
        """Whether data decide the ratio."""
        spans = (self.low, self.high), (self.drawn_low, self.drawn_high)
        inside = self.drawn_low > SMALLEST and self.drawn_high < LARGEST
        return inside and all(high <= WIDEST * low for low, high in spans)


def identified_ratio(loads: Loads, rho: float, cone: str = ELLIPSOID) -> Identified | None:
    """mu_omega / mu_v of the loads on one support; None of fewer than ``FEWEST`` loads.

    Parameters
    ----------
    loads : Loads
        About the centre of mass.
    rho : float
        Radius of gyration of the outline, by which turns are compared with displacements [m].
    cone : str
    """
    count = len(loads.wrench)
    if count < FEWEST:
        return None
    gauge, support = limit_surface(cone)

    def lost_shares(subset: Loads, c: float) -> Array:
        return lost_share(subset, c, gauge, support)

    def misses(subset: Loads, c: float) -> Array:
        return 1 - cosines(subset, c, rho)

    losses = misses if cone == ELLIPSOID else lost_shares
    ratio = best_ratio(lambda c: float(losses(loads, c).mean()))
    low, high = np.quantile(drawn_ratios(loads, losses, ratio), [0.025, 0.975]).tolist()
    misfit = min(float(lost_shares(loads, c).mean()) for c in (ratio, *GRID))
    friction = float(np.median(gauge(loads.wrench * [1.0, 1.0, 1 / ratio])))
    if cone != ELLIPSOID:
        return Identified(ratio, low, high, low, high, None, None, misfit, friction, count)
    information = fisher_information(loads, ratio, rho)
    spread = NORMAL / np.sqrt(max(information, NONE))
    factor = float(np.exp(min(spread, UNDECIDED)))
    reverse = best_ratio(lambda c: 1 - float(reverse_cosines(loads, c, rho).mean()))
    return Identified(ratio, ratio / factor, ratio * factor, low, high, information, reverse,
                      misfit, friction, count)  # fmt: skip


def cosines(loads: Loads, c: float, rho: float) -> Array:
    """Of the angle between each measured twist and that predicted from its load, shape (n,).

    Parameters
    ----------
    loads : Loads
    c, rho : float
        mu_omega / mu_v, and the length by which turns are scaled [m].
    """
    predicted = loads.wrench * [1, 1, rho / c**2]
    measured = loads.twist * [1, 1, rho]
    cosine: Array = np.einsum("ij,ij->i", units(predicted), units(measured))
    return cosine


def reverse_cosines(loads: Loads, c: float, rho: float) -> Array:
    """The same of loads (f, tau / rho) with `rho` [m], predicted from twists, shape (n,)."""
    predicted = loads.twist * [1, 1, c**2 / rho]
    measured = loads.wrench * [1, 1, 1 / rho]
    cosine: Array = np.einsum("ij,ij->i", units(predicted), units(measured))
    return cosine


def fisher_information(loads: Loads, c: float, rho: float) -> float:
    """Of log c in a von Mises-Fisher distribution: kappa A(kappa) sum sin^2(2 alpha).

    A number [-]. rho is a length [m], alpha the elevation of a predicted twist, atan(rho tau /
    (c^2 |f|)); A(kappa) = coth kappa - 1 / kappa is the mean cosine.
    """
    mean = float(cosines(loads, c, rho).mean())
    f = np.linalg.norm(loads.wrench[:, :2], axis=1)
    alpha = np.arctan2(rho * loads.wrench[:, 2] / c**2, f)
    return concentration(mean) * mean * float((np.sin(2 * alpha) ** 2).sum())


def concentration(mean: float) -> float:
    """The kappa [-] of a von Mises-Fisher distribution of a `mean` cosine coth k - 1 / k [-]."""
    low = 0.0
    high = 1e9
    for _ in range(200):
        k = (low + high) / 2
        low, high = (k, high) if 1 / np.tanh(k) - 1 / k < mean else (low, k)
    return (low + high) / 2


def limit_surface(cone: str) -> tuple[Callable[[Array], Array], Callable[[Array], Array]]:
    """Gauge and support function of a cone's limit surface at f_n = 1, in units of mu_v, mu_omega.

    The first is of forces, the second of twists; each takes rows, shape (n, 3), and returns one
    number for each, shape (n,). The gauge is 1
    on the surface, and their product is at least w . v, equal where v is normal to the surface.
    """
    if cone == ELLIPSOID:
        return _length, _length
    from scipy.spatial import ConvexHull

    corners = cone_matrix(cone)[:, 1:]
    faces = ConvexHull(corners).equations
    normals = faces[:, :3] / -faces[:, 3:]
    return (lambda w: (w @ normals.T).max(-1)), (lambda v: (v @ corners.T).max(-1))


def _length(rows: Array) -> Array:
    """Euclidean lengths, shape (n,): gauge and support of the ball are the same."""
    return np.asarray(np.linalg.norm(rows, axis=-1))


def lost_share(
    loads: Loads, c: float, gauge: Callable[[Array], Array], support: Callable[[Array], Array]
) -> Array:
    """1 - w . v / (gauge(w) support(v)), shape (n,) [-]: 0 where v is normal to the surface at w.

    Parameters
    ----------
    loads : Loads
    c : float
        mu_omega / mu_v [m].
    gauge, support : callable
        Of a limit surface.
    """
    w = loads.wrench * [1, 1, 1 / c]
    v = loads.twist * [1, 1, c]
    share: Array = 1 - np.einsum("ij,ij->i", w, v) / (gauge(w) * support(v))
    return share


def units(x: Array) -> Array:
    """Rows as unit vectors, shape (n, 3)."""
    unit: Array = x / np.linalg.norm(x, axis=1, keepdims=True)
    return unit


GRID = np.geomspace(SMALLEST, LARGEST, 241)
"""Ratios between which minima are looked for [m]: 3 % apart."""


def best_ratio(loss: Callable[[float], float]) -> float:
    """The ratio [m] of the smallest loss: the best of the grid, then between its neighbours."""
    k = int(np.argmin([loss(c) for c in GRID]))
    ends = np.log([GRID[max(k - 1, 0)], GRID[min(k + 1, len(GRID) - 1)]])
    least = minimize_scalar(lambda x: loss(float(np.exp(x))), bounds=tuple(ends), method="bounded",
                            options={"xatol": 1e-9})  # fmt: skip
    return float(np.exp(least.x))


def drawn_ratios(loads: Loads, losses: Callable[[Loads, float], Array], ratio: float) -> Array:
    """Best ratios of loads drawn with replacement, shape (DRAWS,) [m], around `ratio` [m]."""
    fine = np.concatenate([GRID[::8], ratio * np.geomspace(0.5, 2.0, 401)])
    table = np.array([losses(loads, c) for c in fine])
    count = table.shape[1]
    rng = np.random.default_rng(0)
    rows = rng.integers(count, size=(DRAWS, count))
    weights = np.array([np.bincount(row, minlength=count) for row in rows])
    best: Array = fine[(table @ weights.T).argmin(axis=0)]
    return best
