"""A sphere on the floor under a constant torque about the normal."""

import numpy as np

from quasistatic_ref.lab.claims.claim import Claim, Evidence, comparison, sum_of_terms
from quasistatic_ref.lab.scenes.contacts import GRAVITY
from quasistatic_ref.lab.scenes.rigid import sphere_step
from quasistatic_ref.lab.thresholds import exact, grid
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.tolerances import CLOSED_FORM

M = 0.3
INERTIA = 3e-4
RADIUS = 0.05
STEPS = 20
STARTS = (-1e-6, 0.0, 1e-6, 2e-4)
"""Gaps to start from [m]: so little penetration that the sphere turns in the first step already."""


def one_step(tau: float, phi: float, h: float, mu_omega: float) -> tuple[float, float]:
    """(delta_z, delta_theta) as solved."""
    wrench = (0, 0, -M * GRAVITY, 0, 0, tau)
    delta_q = exact(
        sphere_step(M, INERTIA, RADIUS, wrench, mu_v=0.5, mu_omega=mu_omega, phi=phi, h=h)
    ).delta_q
    return float(delta_q[2]), float(delta_q[5])


def step_evidence() -> Evidence:
    """Stuck, turning in contact, and turning above the floor."""
    limits = [0.0, 0.5, 0.999, 1.001, 1.5, 5.0]
    sweep = grid(limits, [-1e-4, 0.0, 1e-5, 3e-3], [1e-3, 1e-2, 0.05], [0.002, 0.02])
    share, phi, h, mu = sweep.T
    tau = share * mu * M * GRAVITY
    solved = np.array([one_step(*x) for x in zip(tau, phi, h, mu, strict=True)])
    # The sum of three terms over I + m mu^2, held between standing still and turning freely.
    terms = np.array([h**2 * tau, -(h**2) * mu * M * GRAVITY, M * mu * phi]) / (INERTIA + M * mu**2)
    theta = np.clip(terms.sum(0), 0.0, h**2 * tau / INERTIA)
    rise = np.maximum(mu * theta - phi, -(h**2) * GRAVITY)
    largest = np.abs(terms).max(0)
    return Evidence.of(
        comparison("delta_theta [rad]", solved[:, 1], theta, CLOSED_FORM, largest),
        comparison(
            "delta_z [m]", solved[:, 0], rise, CLOSED_FORM, np.maximum(mu * largest, abs(phi))
        ),
    )


def sequence(tau: float, phi: float, h: float, mu: float) -> Array:
    """Gap before each of some steps, shape (k,) [m]."""
    gaps = []
    for _ in range(STEPS):
        gaps.append(phi)
        phi += one_step(tau, phi, h, mu)[0]
    return np.array(gaps)


def recurrence_evidence() -> Evidence:
    """Gaps, step after step, from several gaps."""
    gaps = []
    fixed = []
    left = []
    for start, share, h, mu in grid(STARTS, [1.2, 3.0], [1e-3, 1e-2], [0.01, 0.05]):
        if start > h**2 * GRAVITY:  # it would fall first
            continue
        limit = mu * M * GRAVITY
        ratio = M * mu**2 / (INERTIA + M * mu**2)
        layer = mu * h**2 * (share - 1) * limit / INERTIA
        k = np.arange(STEPS)
        gaps.append(sequence(share * limit, start, h, mu))
        fixed.append(np.full(STEPS, layer))
        left.append((start - layer) * ratio**k)
    return Evidence.of(sum_of_terms("phi_k [m]", gaps, [fixed, left], CLOSED_FORM))


STEP = Claim(
    name="spinning_sphere_step",
    sentence="A torque about the normal turns a sphere only beyond mu_omega N, and then lifts it "
    "by mu_omega times the turn.",
    where="docs/derivations.md (R5)",
    sweep="six torques, four gaps, three time steps, two mu_omega",
    reason="CLOSED_FORM, relative to the largest of the three terms of the turn.",
    measure=step_evidence,
)

RECURRENCE = Claim(
    name="spinning_sphere_recurrence",
    sentence="The gap of a spun sphere goes to mu_omega h^2 (tau - mu_omega m g) / I, "
    "geometrically, at the rate m mu_omega^2 / (I + m mu_omega^2), from any gap at which it turns "
    "in contact.",
    where="docs/derivations.md (R6)",
    sweep="gaps, torques, time steps and mu_omega, 20 steps each",
    reason="CLOSED_FORM, relative to the larger of layer and what is left of the start.",
    measure=recurrence_evidence,
)
