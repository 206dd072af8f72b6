"""A rigid flat patch: which of its points bear the load when it turns, and what that costs.

(R16): let a patch slip about the point below its centre of mass. Point j moves across its radius
r_j, and the nearer of its tangents is at an angle eps_j <= 45 degrees to this motion. The pyramid
lets it resist with at most mu N_j cos eps_j, so the patch holds at most mu m g max r_j cos eps_j.
It holds that much if loads on the points of this maximum alone can balance the weight, sum N_j
r_j = 0, and their friction forces add up to zero, like those of opposite points with equal
tangents. Other patches hold less, as a linear program over loads and friction says: the points
(60, 0), (-30, 20), (-30, -20) mm hold 0.0383 m times mu m g, where the bound is 0.0600 m.
"""

import numpy as np

from quasistatic_ref.lab.claims.claim import Claim, Evidence, comparison
from quasistatic_ref.lab.scenes.contacts import GRAVITY, Z
from quasistatic_ref.lab.scenes.rigid import rigid_step
from quasistatic_ref.lab.thresholds import exact, grid, threshold_near
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.step.data import StepData
from quasistatic_ref.tolerances import CLOSED_FORM

M = 0.5
INERTIA = 2e-4
MU = 0.5
RADIUS = 0.03
HEIGHT = 0.02
H = 0.01
RINGS = 4
POINTS = 6


def disk() -> tuple[Array, Array]:
    """Points of equal area on a disk (P, 3) [m], and frames (P, 3, 3): d1 where they would slip."""
    r = RADIUS * np.sqrt((np.arange(RINGS) + 1) / RINGS)
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
    return rigid_step(M, INERTIA, (0, 0, -M * GRAVITY, 0, 0, tau), points, frames, mu_v=MU, h=H)


def evidence() -> Evidence:
    """The torque that turns it, its turn, and who bears the load."""
    points, _ = disk()
    r = np.hypot(points[:, 0], points[:, 1])
    limit = MU * M * GRAVITY * RADIUS
    uniform = MU * M * GRAVITY * r.mean()

    def turns_it(share: float) -> bool:
        return bool(abs(exact(loaded_patch(share * limit)).delta_q[5]) > 1e-14)

    held = threshold_near(turns_it, 1.0, (0.3, 2.0))
    turns = []
    forms = []
    scales = []
    inner = []
    for share in (1.01, 1.5, 4.0):
        answer = exact(loaded_patch(share * limit))
        mass = INERTIA + M * (MU * RADIUS) ** 2
        turns.append(answer.delta_q[5])
        forms.append(H**2 * (share - 1) * limit / mass)
        scales.append(H**2 * share * limit / mass)
        load = answer.wrench[:, 2].reshape(RINGS, POINTS).sum(1)
        inner.append(load[:-1].sum() / load.sum())
    words = "its torque over that of a uniform load [-]"
    return Evidence.of(
        comparison("torque that turns it, over mu m g a [-]", held, 1.0, CLOSED_FORM),
        comparison("turn [rad]", turns, forms, CLOSED_FORM, scales),
        comparison("share of the load inside the rim [-]", inner, 0.0, 0.0),
        comparison(words, held * limit / uniform, RADIUS / r.mean(), CLOSED_FORM),
    )


CLAIM = Claim(
    name="flat_patch",
    sentence="When a rigid disk of points turns, with tangents along the slip, its whole load goes "
    "to the rim: it holds mu m g a, where a uniform load would hold 2/3 of that.",
    where="docs/derivations.md (R16)",
    sweep="24 points of equal area on a disk; one bisection and three torques beyond the threshold",
    reason="CLOSED_FORM; a torque is held if the turn is below 1e-14 rad, which rounded points "
    "leave.",
    measure=evidence,
)
