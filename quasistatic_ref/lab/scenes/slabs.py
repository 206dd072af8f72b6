"""A heavy block on a light slab on the floor, pushed by a spring: a scene that can be scaled.

All numbers come from one generator, so that a seed and a name give the same step everywhere. Gaps
are never negative: standing still is allowed, and every step has a solution.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from quasistatic_ref.lab.study.families.made import Made
from quasistatic_ref.step.data import Array, Contacts, StepData

LIGHT = 0.1
"""Mass of the slab [kg]."""
SIZE = 0.1
"""Half the edge of the slab, and half the edge of the block [m]."""
STIFFNESS = 1000.0
"""Of the pusher [N/m]."""
GRAVITY = 9.81
TILT = 0.05
"""Standard deviation of normals from the vertical, as in a cloud of points [rad]."""
GAP = 1e-4
"""Mean of the gaps that are not zero [m]."""
COMMON = {"contacts": 12, "ratio": 10.0, "h": 0.01}


def slab_step(rng: np.random.Generator, contacts: int, ratio: float, h: float) -> StepData:
    """One step: 3 coordinates of the pusher, 6 of the slab, 6 of the block.

    Parameters
    ----------
    rng : Generator
    contacts : int
        One is the pusher's, where there are two or more; the others lie below the slab and
        between slab and block in turn.
    ratio : float
        Mass of the block over mass of the slab [-].
    h : float
        Time step [s].

    Returns
    -------
    StepData
    """
    masses = LIGHT * np.array([1.0, ratio])
    M_u = np.diag(np.concatenate([slab_inertia(m) for m in masses]))
    weight = np.zeros(12)
    weight[[2, 8]] = -GRAVITY * masses
    pull = 0.3 * GRAVITY * np.repeat(masses, 6) * rng.uniform(-1, 1, 12)
    pull[[3, 4, 5, 9, 10, 11]] *= SIZE  # torques
    return StepData(
        h=h,
        K_q=STIFFNESS * np.eye(3),
        M_u=M_u,
        tau_a=np.zeros(3),
        tau_u=weight + pull,
        delta_q_bar_a=np.array([0.1 * h, 0.0, 0.0]) + 0.02 * h * rng.uniform(-1, 1, 3),
        contacts=_contacts(rng, contacts),
    )


def slab_inertia(mass: float) -> Array:
    """Diagonal of a slab's mass matrix [kg, kg m^2], shape (6,)."""
    return mass * np.array([1.0, 1.0, 1.0, *[2 / 3 * SIZE**2] * 3])


def _contacts(rng: np.random.Generator, n_c: int) -> Contacts:
    """Contacts of the three kinds: pusher on slab, slab on floor, block on slab."""
    kind = np.arange(n_c) % 2  # 0: floor below the slab, 1: slab below the block
    n = np.column_stack([TILT * rng.normal(size=(n_c, 2)), np.ones(n_c)])
    r = np.column_stack([SIZE * rng.uniform(-1, 1, (n_c, 2)), np.zeros(n_c)])
    up = np.array([0.0, 0.0, SIZE])
    r_below, r_above, r_floor = r + 0.1 * up, r - up, r - 0.1 * up
    J = np.zeros((n_c, 4, 15))
    J[:, :, 3:9] = np.where(
        kind[:, None, None] == 0, moving_point(r_floor, n), -moving_point(r_below, n)
    )
    J[:, :, 9:15] = np.where(kind[:, None, None] == 0, 0.0, moving_point(r_above, n))
    if n_c > 1:  # the pusher's tip at the slab's side
        n[0], r[0] = [1.0, 0.0, 0.0], [-SIZE, 0.2 * SIZE * rng.uniform(-1, 1), 0.0]
        J[0] = 0.0
        J[0, :, 3:9] = moving_point(r[:1], n[:1])[0]
        J[0, :3, 0:3] = -np.eye(3)
    n /= np.linalg.norm(n, axis=1, keepdims=True)
    d1 = tangent(n)
    touching = rng.uniform(size=n_c) < 0.3
    return Contacts(
        name=tuple(f"c{j}" for j in range(n_c)),
        phi=np.where(touching, 0.0, rng.exponential(GAP, n_c)),
        n=n,
        d1=d1,
        d2=np.cross(n, d1),
        J=J,
        mu_v=rng.uniform(0.2, 0.9, n_c),
        mu_omega=rng.uniform(0.002, 0.02, n_c),
        rows=np.where(rng.uniform(size=n_c) < 0.5, 6, 4),
    )


def tangent(n: Array) -> Array:
    """A unit vector across each n, none of which is along y; shape (n_c, 3)."""
    d1 = np.cross(np.broadcast_to([0.0, 1.0, 0.0], n.shape), n)
    return np.asarray(d1 / np.linalg.norm(d1, axis=1, keepdims=True))


def moving_point(r: Array, n: Array) -> Array:
    """Velocity of a body's points at r, and its spin about n, per unit of its twist, (n, 4, 6)."""
    n = n / np.linalg.norm(n, axis=1, keepdims=True)
    J = np.zeros((len(r), 4, 6))
    J[:, :3, :3] = np.eye(3)
    x, y, z = r.T
    J[:, 0, 4], J[:, 0, 5] = z, -y  # omega x r
    J[:, 1, 3], J[:, 1, 5] = -z, x
    J[:, 2, 3], J[:, 2, 4] = y, -x
    J[:, 3, 3:] = n
    return J


def scaled(family: str, field: str, values: Array, seed: int) -> Iterator[Made]:
    """A family in which one number is scaled.

    Parameters
    ----------
    family : str
    field : str
        ``contacts``, ``ratio`` or ``h``.
    values : ndarray, shape (n,)
        One step for each; of contacts and ratio [-], of h [s].
    seed : int
    """
    for i, value in enumerate(values):
        numbers = COMMON | {field: float(value)}
        rng = np.random.default_rng([seed, i, len(field)])
        step = slab_step(rng, int(numbers["contacts"]), numbers["ratio"], numbers["h"])
        yield Made(f"{family}/{value:.6g}/{i}", family, step, numbers["ratio"], 0)
