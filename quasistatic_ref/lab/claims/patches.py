"""Patches: the torsion that a pressure can bear, and how a flat one spins."""

from collections.abc import Callable

import numpy as np

from quasistatic_ref.lab.claims.claim import Claim, Comparison, comparison
from quasistatic_ref.lab.made_steps.contacts import GRAVITY, Z, contacts_of
from quasistatic_ref.lab.made_steps.rigid import rigid_step
from quasistatic_ref.lab.thresholds import exact, grid, threshold_near
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.step.data import StepData
from quasistatic_ref.tolerances import CLOSED_FORM

# mu_omega of a patch, from point contacts without torsion whose loads are given.

RING_MU = 0.6
RING_RADIUS = 0.012
LOAD = 8.0
STIFFNESS = 1e4
RING_INERTIA = 1e-5
H = 0.01
RING_RINGS = (4, 8, 16, 32)
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
    return RING_RADIUS * np.sin(t), LOAD * weight / weight.sum()


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
        H, STIFFNESS * np.eye(n_c), [[RING_INERTIA]], -N, [tau], np.zeros(n_c),
        contacts_of(0.0, np.tile(np.eye(3), (n_c, 1, 1)), J, RING_MU),
    )  # fmt: skip


def mu_omega(r: Array, N: Array) -> tuple[float, float]:
    """Torque that turns the body, over its load [m]: from exact answers, and as a sum."""
    total = RING_MU * float(r @ N)

    def moves(tau: float) -> bool:
        return bool(exact(patch(r, N, tau)).delta_q[-1])

    return threshold_near(moves, total, precision=PRECISION) / LOAD, total / LOAD


def patch_torsion_evidence() -> list[Comparison]:
    """The torque at which a ring of points turns, then many rings under two pressures."""
    ring = [mu_omega(np.full(n, RING_RADIUS), np.full(n, LOAD / n))[0] for n in (1, 3, 6)]
    both = {
        name: np.array([mu_omega(*rings(pressure, n)) for n in RING_RINGS]).T
        for name, (pressure, _) in PRESSURES.items()
    }
    unit = RING_MU * RING_RADIUS
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
    return [*comparisons]


PATCH_TORSION = Claim(
    name="patch_torsion",
    sentence="Point contacts without torsion, loaded as a patch is, resist a turn like one "
    "contact with mu_omega = mu a (ring), 2/3 mu a (uniform disk), 3 pi/16 mu a (Hertz).",
    where="docs/derivations.md (R15)",
    sweep="one ring of 1, 3, 6 points; 4 to 32 rings under two pressures; thresholds by bisection",
    reason="PRECISION of the bisection; CONTINUUM for a finite number of rings.",
    measure=patch_torsion_evidence,
)

# A rigid flat patch: which of its points bear the load when it turns, and what that costs.
#
# (R16): let a patch slip about the point below its centre of mass. Point j moves across its radius
# r_j, and the nearer of its tangents is at an angle eps_j <= 45 degrees to this motion. The pyramid
# lets it resist with at most mu N_j cos eps_j, so the patch holds at most mu m g max r_j cos eps_j.
# It holds that much if loads on the points of this maximum alone can balance the weight, sum N_j
# r_j = 0, and their friction forces add up to zero, like those of opposite points with equal
# tangents. Other patches hold less, as a linear program over loads and friction says: the points
# (60, 0), (-30, 20), (-30, -20) mm hold 0.0383 m times mu m g, where the bound is 0.0600 m.

M = 0.5
DISK_INERTIA = 2e-4
DISK_MU = 0.5
DISK_RADIUS = 0.03
HEIGHT = 0.02
DISK_RINGS = 4
POINTS = 6


def disk() -> tuple[Array, Array]:
    """Points of equal area on a disk (P, 3) [m], and frames (P, 3, 3): d1 where they would slip."""
    r = DISK_RADIUS * np.sqrt((np.arange(DISK_RINGS) + 1) / DISK_RINGS)
    at = grid(r, 2 * np.pi * (np.arange(POINTS) + 0.25) / POINTS)
    x = at[:, 0] * np.cos(at[:, 1])
    y = at[:, 0] * np.sin(at[:, 1])
    points = np.stack([x, y, np.full(len(x), -HEIGHT)], axis=1)
    along = np.stack([-np.sin(at[:, 1]), np.cos(at[:, 1]), np.zeros(len(x))], axis=1)
    frames = np.stack([along, np.cross(Z, along), np.broadcast_to(Z, along.shape)], axis=1)
    return points, frames


def loaded_patch(tau: float) -> StepData:
    """The patch under its weight and a torque about its middle."""
    points, frames = disk()
    return rigid_step(
        M, DISK_INERTIA, (0, 0, -M * GRAVITY, 0, 0, tau), points, frames, mu_v=DISK_MU, h=H
    )


def flat_patch_evidence() -> list[Comparison]:
    """The torque that turns a flat patch, how far it turns, and which points bear load."""
    points, _ = disk()
    r = np.hypot(points[:, 0], points[:, 1])
    limit = DISK_MU * M * GRAVITY * DISK_RADIUS
    uniform = DISK_MU * M * GRAVITY * r.mean()

    def turns_it(share: float) -> bool:
        return bool(abs(exact(loaded_patch(share * limit)).delta_q[5]) > 1e-14)

    held = threshold_near(turns_it, 1.0, (0.3, 2.0))
    shares = np.array([1.01, 1.5, 4.0])
    answers = [exact(loaded_patch(share * limit)) for share in shares]
    turn_of_limit = H**2 * limit / (DISK_INERTIA + M * (DISK_MU * DISK_RADIUS) ** 2)
    turns = [answer.delta_q[5] for answer in answers]
    load = np.array([answer.wrench[:, 2] for answer in answers])
    inner = load[:, :-POINTS].sum(axis=1) / load.sum(axis=1)
    words = "its torque over that of a uniform load [-]"
    return [
        comparison("torque that turns it, over mu m g a [-]", held, 1.0, CLOSED_FORM),
        comparison("turn [rad]", turns, (shares - 1) * turn_of_limit, CLOSED_FORM,
                   shares * turn_of_limit),
        comparison("share of the load inside the rim [-]", inner, 0.0, 0.0),
        comparison(words, held * limit / uniform, DISK_RADIUS / r.mean(), CLOSED_FORM),
    ]  # fmt: skip


FLAT_PATCH = Claim(
    name="flat_patch",
    sentence="When a rigid disk of points turns, and tangents are along the slip, the rim "
    "bears the whole load: the disk holds mu m g a, where an even load would hold 2/3 "
    "of that.",
    where="docs/derivations.md (R16)",
    sweep="24 points of equal area on a disk; one bisection and three torques beyond the threshold",
    reason="CLOSED_FORM; a torque is held if the turn is below 1e-14 rad, which rounded points "
    "leave.",
    measure=flat_patch_evidence,
)
