"""mu_omega of a patch, from point contacts without torsion whose loads are given."""

from collections.abc import Callable

import numpy as np

from quasistatic_ref.lab.claims.claim import Claim, Evidence, comparison
from quasistatic_ref.lab.scenes.contacts import contacts_of
from quasistatic_ref.lab.thresholds import exact, threshold_near
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.step.data import StepData

MU = 0.6
RADIUS = 0.012
LOAD = 8.0
STIFFNESS = 1e4
INERTIA = 1e-5
H = 0.01
RINGS = (4, 8, 16, 32)
PRECISION = 1e-10
"""Where the bisection of a threshold ends, relative [-]."""

CONTINUUM = 1e-3
"""Largest distance of 32 rings from the continuum: the midpoint rule errs by the order of
(pi / 2 / 32)^2 / 3, one over the square of their number."""

PRESSURES: dict[str, tuple[Callable[[Array], Array], float]] = {
    "uniform disk": (np.ones_like, 2 / 3),
    "Hertz": (np.cos, 3 * np.pi / 16),
}
"""Pressure at r = a sin t, and mu_omega / (mu a) of the continuum."""


def rings(pressure: Callable[[Array], Array], count: int) -> tuple[Array, Array]:
    """Radii (k,) [m] and loads (k,) [N] of rings, by the midpoint rule in t, r = a sin t."""
    t = (np.arange(count) + 0.5) * np.pi / 2 / count
    weight = pressure(t) * np.sin(t) * np.cos(t)  # p(r) r dr
    return RADIUS * np.sin(t), LOAD * weight / weight.sum()


def patch(r: Array, N: Array, tau: float) -> StepData:
    """A body turned by tau about an axis, with a pin at each radius r pressed on it by N.

    q_a: how far each pin has come off; q_u: the turn. A pin stands for the whole ring: only
    its speed in the direction of slip, r times the turn, and its load matter.
    """
    n_c = len(r)
    J = np.zeros((n_c, 4, n_c + 1))
    J[np.arange(n_c), 2, np.arange(n_c)] = 1.0  # along n
    J[:, 0, n_c] = r  # along d1, the direction of slip
    return StepData(
        H, STIFFNESS * np.eye(n_c), [[INERTIA]], -N, [tau], np.zeros(n_c),
        contacts_of(0.0, np.tile(np.eye(3), (n_c, 1, 1)), J, MU),
    )  # fmt: skip


def mu_omega(r: Array, N: Array) -> tuple[float, float]:
    """Torque that turns the body, over its load [m]: from exact answers, and as a sum."""
    total = MU * float(r @ N)

    def moves(tau: float) -> bool:
        return bool(exact(patch(r, N, tau)).delta_q[-1])

    return threshold_near(moves, total, precision=PRECISION) / LOAD, total / LOAD


def evidence() -> Evidence:
    """One ring; then more and more rings under two pressures."""
    ring = [mu_omega(np.full(n, RADIUS), np.full(n, LOAD / n))[0] for n in (1, 3, 6)]
    both = {
        name: np.array([mu_omega(*rings(pressure, n)) for n in RINGS]).T
        for name, (pressure, _) in PRESSURES.items()
    }
    unit = MU * RADIUS
    comparisons = [
        comparison("ring: mu_omega / (mu a) [-]", np.array(ring) / unit, 1.0, 2 * PRECISION)
    ]
    for name, (_, limit) in PRESSURES.items():
        measured, sums = both[name]
        ratio = measured / unit
        comparisons += [
            comparison(f"{name}: mu_omega [m]", measured, sums, 2 * PRECISION, sums),
            comparison(f"{name}: mu_omega / (mu a), 32 rings [-]", ratio[-1:], limit, CONTINUUM),
        ]
    return Evidence.of(*comparisons)


CLAIM = Claim(
    name="patch_torsion",
    sentence="Point contacts without torsion, loaded as a patch is, resist a turn like one "
    "contact with mu_omega = mu a (ring), 2/3 mu a (uniform disk), 3 pi/16 mu a (Hertz).",
    where="docs/derivations.md (R15)",
    sweep="one ring of 1, 3, 6 points; 4 to 32 rings under two pressures; thresholds by bisection",
    reason="PRECISION of the bisection; CONTINUUM for a finite number of rings.",
    measure=evidence,
)
