"""Many bodies: towers of slabs, each on the one below, for problems with many coordinates."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from quasistatic_ref.lab.study.families.made import Made
from quasistatic_ref.lab.study.families.slab import (
    GAP,
    GRAVITY,
    SIZE,
    TILT,
    moving_point,
    slab_inertia,
    tangent,
)
from quasistatic_ref.step.data import Contacts, StepData

EACH = 8
"""Contacts below each slab."""
MASS = 1.0
H = 0.01


def tower_step(rng: np.random.Generator, bodies: int) -> StepData:
    """One step of a tower: 6 coordinates a slab, nothing actuated.

    Parameters
    ----------
    rng : Generator
    bodies : int

    Returns
    -------
    StepData
    """
    n_c, n_v = EACH * bodies, 6 * bodies
    body = np.repeat(np.arange(bodies), EACH)
    n = np.column_stack([TILT * rng.normal(size=(n_c, 2)), np.ones(n_c)])
    n /= np.linalg.norm(n, axis=1, keepdims=True)
    r = np.column_stack([SIZE * rng.uniform(-1, 1, (n_c, 2)), np.full(n_c, -0.1 * SIZE)])
    blocks = np.zeros((n_c, 4, bodies, 6))
    every = np.arange(n_c)
    blocks[every, :, body] = moving_point(r, n)
    above = body > 0
    blocks[every[above], :, body[above] - 1] = -moving_point(r * [1, 1, -1], n)[above]
    d1 = tangent(n)
    weight = np.tile([0.0, 0.0, -GRAVITY * MASS, 0.0, 0.0, 0.0], bodies)
    pull = 0.3 * GRAVITY * MASS * rng.uniform(-1, 1, n_v)
    pull[np.arange(n_v) % 6 > 2] *= SIZE
    return StepData(
        h=H,
        K_q=np.zeros((0, 0)),
        M_u=np.diag(np.tile(slab_inertia(MASS), bodies)),
        tau_a=np.zeros(0),
        tau_u=weight + pull,
        delta_q_bar_a=np.zeros(0),
        contacts=Contacts(
            name=tuple(f"c{j}" for j in range(n_c)),
            phi=np.where(rng.uniform(size=n_c) < 0.3, 0.0, rng.exponential(GAP, n_c)),
            n=n,
            d1=d1,
            d2=np.cross(n, d1),
            J=blocks.reshape(n_c, 4, n_v),
            mu_v=rng.uniform(0.2, 0.9, n_c),
            mu_omega=rng.uniform(0.002, 0.02, n_c),
            rows=np.full(n_c, 4),
        ),
    )


def towers(bodies: list[int], seed: int) -> Iterator[Made]:
    """A tower of each number of bodies."""
    for i, count in enumerate(bodies):
        step = tower_step(np.random.default_rng([seed, i, 77]), count)
        yield Made(f"bodies/{count}/{i}", "bodies", step, 1.0, 0)
