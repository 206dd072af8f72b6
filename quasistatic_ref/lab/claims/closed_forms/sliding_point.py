"""A point on the floor, pulled in any direction."""

import numpy as np

from quasistatic_ref.lab.claims.claim import Claim, Evidence, comparison, sum_of_terms
from quasistatic_ref.lab.scenes.contacts import GRAVITY
from quasistatic_ref.lab.scenes.rigid import point_step
from quasistatic_ref.lab.thresholds import exact, grid, thresholds
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.step.data import StepData
from quasistatic_ref.tolerances import CLOSED_FORM

M = 0.3
H = 0.01
STEPS = 15


def point_displacement(fx: float, fy: float, mu: float, phi: float, h: float = H) -> Array:
    """The displacement of one step, shape (3,) [m]."""
    return exact(point_step(M, (fx, fy, -M * GRAVITY), mu, phi, h)).delta_q


def slip(fx: float, fy: float, mu: float, phi: float, h: float = H) -> Array:
    """The closed form (3,) for fx >= fy >= 0: off the floor, stuck, or one or two rows tight."""
    if phi - h**2 * GRAVITY >= mu * h**2 * fx / M:
        return h**2 * np.array([fx / M, fy / M, -GRAVITY])
    load = mu * M * GRAVITY
    one = (h**2 * (fx - load) + M * mu * phi) / (M * (1 + mu**2))
    both = (h**2 * (fx + fy - load) + M * mu * phi) / (M * (2 + mu**2))
    free = h**2 * fy / M
    if one >= free and one > 0:
        return np.array([one, free, mu * one - phi])
    if both > 0:
        return np.array([both, both, mu * both - phi])
    return np.array([0.0, 0.0, -phi])


def pushed_point(share: float, angle: float, mu: float) -> StepData:
    """A point under a share of mu m g, at an angle from d1 [rad]."""
    f1, f2 = share * mu * M * GRAVITY * np.array([np.cos(angle), np.sin(angle)])
    return point_step(M, (f1, f2, -M * GRAVITY), mu, 0.0, H)


def threshold_evidence() -> Evidence:
    """The least force that moves the point, by direction."""
    angles = np.radians(np.linspace(0.0, 90.0, 13))
    sweep = grid(angles, (0.2, 1.0))
    at = sweep[:, 0]
    expected = 1 / (np.cos(at) + np.sin(at))
    measured = thresholds(pushed_point, sweep, expected)
    what = "least force that moves it, over mu_v m g [-]"
    return Evidence.of(comparison(what, measured, expected, CLOSED_FORM))


def slip_evidence() -> Evidence:
    """One step in all regimes; then the sequence of steps along an axis."""
    solved = []
    formula = []
    scale = []
    sweep = grid(
        [0, 0.5, 0.9, 1.1, 2.0], [0, 0.1, 0.45], [0.2, 0.5, 1.0], [-1e-5, 0, 1e-4], [1e-3, H]
    )
    for share, side, mu, phi, h in sweep:
        fx = share * mu * M * GRAVITY
        solved.append(point_displacement(fx, side * fx, mu, phi, h))
        formula.append(slip(fx, side * fx, mu, phi, h))
        scale.append(max(h**2 * GRAVITY * max(1.0, share) * mu, abs(phi)))
    gaps = []
    layers = []
    rest = []
    for mu, share in grid([0.2, 0.5, 1.0], [1.2, 3.0]):
        phi = 0.0
        k = np.arange(STEPS)
        layer = mu * H**2 * (share - 1) * mu * GRAVITY
        for _ in range(STEPS):
            gaps.append(phi)
            phi += float(point_displacement(share * mu * M * GRAVITY, 0.0, mu, phi)[2])
        layers.append(np.full(STEPS, layer))
        rest.append(-layer * (mu**2 / (1 + mu**2)) ** k)
    terms = [np.array(layers).ravel(), np.array(rest).ravel()]
    return Evidence.of(
        comparison("delta_q [m]", solved, formula, CLOSED_FORM, np.array(scale)[:, None]),
        sum_of_terms("phi_k while sliding [m]", gaps, terms, CLOSED_FORM),
    )


THRESHOLD = Claim(
    name="sliding_threshold",
    sentence="The pyramid holds mu_v N along its axes and mu_v N / sqrt 2 between them: (|cos| + "
    "|sin|) F <= mu_v N.",
    where="docs/derivations.md (R7)",
    sweep="13 directions, two mu_v; each threshold by bisection on exact answers",
    reason="CLOSED_FORM, above the 1e-13 at which the bisection stops.",
    measure=threshold_evidence,
)

SLIP = Claim(
    name="sliding_point",
    sentence="A pulled point slides by its closed form, off the floor, stuck, or with one row or "
    "two at their limits, and its gap goes to mu_v times the slip at the rate mu_v^2 / (1 + "
    "mu_v^2).",
    where="docs/derivations.md (R8)",
    sweep="forces, directions, mu_v, gaps and time steps: 270 steps; six sequences of 15 steps",
    reason="CLOSED_FORM, relative to the largest term of the slip.",
    measure=slip_evidence,
)
