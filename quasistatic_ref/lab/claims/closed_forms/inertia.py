"""Inertia and time step are one number: a smaller step is a heavier body."""

import numpy as np

from quasistatic_ref.certify.failures import StepInfeasible
from quasistatic_ref.lab.claims.claim import Claim, Evidence, comparison
from quasistatic_ref.lab.scenes.at_random import random_contacts, random_step
from quasistatic_ref.lab.thresholds import exact
from quasistatic_ref.numbers.arrays import Array

STEPS = 40


def evidence() -> Evidence:
    """Random steps with another inertia, and with another h."""
    rng = np.random.default_rng(45)
    heavier: list[Array] = []
    shorter: list[Array] = []
    forces: list[Array] = []
    expected: list[Array] = []
    while len(heavier) < STEPS:
        step = random_step(rng, 2, 4, random_contacts(rng, 3, 6))
        sigma = 4.0 ** float(rng.integers(-3, 4))  # its root is a power of two: nothing is rounded
        try:
            heavy = exact(step.replace(M_u=sigma * step.M_u))
            short = exact(step.replace(h=step.h / np.sqrt(sigma)))
        except StepInfeasible:
            continue
        heavier.append(heavy.delta_q)
        shorter.append(short.delta_q)
        forces.append(heavy.wrench)
        expected.append(short.wrench)
    return Evidence.of(
        comparison("delta_q with sigma M_u at h [m, rad]", heavier, shorter, 0.0),
        comparison("forces of the contacts [N, N m]", forces, expected, 0.0),
    )


CLAIM = Claim(
    name="inertia_and_time_step",
    sentence="A step with the inertia sigma M_u at h and one with M_u at h / sqrt(sigma) have the "
    "same displacement and forces where targets, loads and contacts are the same: smaller steps "
    "are heavier bodies, and no limit of h to 0 is approached.",
    where="docs/artifacts.md (R45)",
    sweep=f"{STEPS} random steps with a solution, sigma from 1/64 to 64",
    reason="no tolerance: sqrt(sigma) is a power of two, so the bits are the same.",
    measure=evidence,
)
