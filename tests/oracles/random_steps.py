"""Random steps that may be anything: what the exact answer and its certificate are tried on."""

from __future__ import annotations

import numpy as np

from quasistatic_ref.lab.scenes.at_random import random_frames, spread_matrix
from quasistatic_ref.lab.scenes.contacts import contacts_of
from quasistatic_ref.lab.scenes.grasps import grasp_step
from quasistatic_ref.step.data import StepData


def any_step(
    rng: np.random.Generator,
    n_a: int,
    n_u: int,
    n_c: int,
    mass_ratio: float = 1.0,
) -> StepData:
    """Anything that a step may be: duplicated contacts, penetration, mu = 0, light on heavy.

    Parameters
    ----------
    rng : numpy.random.Generator
    n_a, n_u, n_c : int
        Coordinates of either kind, and contacts.
    mass_ratio : float
        Largest mass over smallest, and largest stiffness over smallest.

    Returns
    -------
    StepData
        Infeasible in some cases.
    """
    frames = random_frames(rng, n_c).swapaxes(1, 2)
    J = rng.standard_normal((n_c, 4, n_a + n_u))
    J *= rng.random((n_c, 1, n_a + n_u)) < 0.7  # some coordinates do not move a contact
    phi = rng.choice([0.0, 1e-3, -1e-4], n_c) * rng.random(n_c)
    mu_v = rng.choice([0.0, 0.5, 1.0], n_c) * rng.random(n_c)
    mu_omega = rng.choice([0.0, 0.01], n_c)
    same = np.arange(n_c)
    for j in range(1, n_c):
        if rng.random() < 0.3:
            same[j] = same[rng.integers(j)]
    return StepData(
        h=0.01,
        K_q=spread_matrix(rng, n_a, 1e3, mass_ratio),
        M_u=spread_matrix(rng, n_u, 1.0, mass_ratio),
        tau_a=rng.standard_normal(n_a),
        tau_u=rng.choice([0.0, 1.0]) * rng.standard_normal(n_u),
        delta_q_bar_a=1e-3 * rng.standard_normal(n_a),
        contacts=contacts_of(
            phi[same], frames[same], J[same], mu_v[same], mu_omega[same], rng.choice([4, 6], n_c)
        ),
    )


def mixed_step(seed: int) -> StepData:
    """A step of either family: every fifth a grasp, the others of up to 12 coordinates.

    Parameters
    ----------
    seed : int
        Each seed is another step; masses are 1, 1e4 or 1e9 apart.

    Returns
    -------
    StepData
        Infeasible in some cases.
    """
    rng = np.random.default_rng(seed)
    if seed % 5 == 0:
        return grasp_step(rng)
    n_a = int(rng.integers(0, 7))
    n_u = int(rng.integers(0, 7))
    n_u += n_a + n_u == 0
    return any_step(rng, n_a, n_u, int(rng.integers(0, 8)), rng.choice([1.0, 1e4, 1e9]))
