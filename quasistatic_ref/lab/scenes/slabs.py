"""Slabs on the floor and on each other: steps that can be scaled, without a robotics stack.

All numbers come from one generator, so that a seed gives the same step everywhere. Gaps are never
negative: standing still is allowed, and every step has a solution.
"""

import numpy as np

from quasistatic_ref.lab.scenes.at_random import Rng
from quasistatic_ref.lab.scenes.contacts import (
    GRAVITY,
    X,
    Y,
    Z,
    contacts_of,
    frames_about,
    point_jacobian,
)
from quasistatic_ref.lab.scenes.rigid import free_step
from quasistatic_ref.step.data import Array, Contacts, StepData

LIGHT = 0.1
"""Mass of the slab below a block [kg]; one of a tower has 1 kg."""
SIZE = 0.1
"""Half the edge of a slab, and half the edge of a block [m]."""
STIFFNESS = 1000.0
"""Of the pusher [N/m]."""
TILT = 0.05
"""Standard deviation of normals from the vertical, as in a cloud of points [rad]."""
GAP = 1e-4
"""Mean of the gaps that are not zero [m]."""
EACH = 8
"""Contacts below each slab of a tower."""
H = 0.01
"""Time step of a tower [s]."""
UP = 0.1 * SIZE * Z
"""From the middle of a slab to its upper side [m]."""


def slab_step(rng: Rng, contacts: int, ratio: float, h: float) -> StepData:
    """A block on a slab on the floor: 3 coordinates of a pusher, 6 of the slab, 6 of the block.

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
    """
    masses = LIGHT * np.array([1.0, ratio])
    return StepData(
        h=h,
        K_q=STIFFNESS * np.eye(3),
        M_u=_inertia(masses),
        tau_a=np.zeros(3),
        tau_u=_loads(rng, masses),
        delta_q_bar_a=0.1 * h * X + 0.02 * h * rng.uniform(-1, 1, 3),
        contacts=_slab_contacts(rng, contacts),
    )


def tower_step(rng: Rng, bodies: int) -> StepData:
    """A tower of slabs: 6 coordinates a slab, nothing actuated.

    Parameters
    ----------
    rng : Generator
    bodies : int
    """
    body = np.repeat(np.arange(bodies), EACH)
    masses = np.ones(bodies)
    n, r = _places(rng, EACH * bodies)
    J = np.zeros((len(n), 4, bodies, 6))
    every = np.arange(len(n))
    above = np.flatnonzero(body)
    J[every, :, body] = point_jacobian(r - UP, n)
    J[above, :, body[above] - 1] = -point_jacobian(r + UP, n)[above]
    loads = _loads(rng, masses)
    contacts = _resting(rng, n, J.reshape(len(n), 4, -1), 0.0)
    return free_step(_inertia(masses), loads, contacts, H)


def _slab_contacts(rng: Rng, n_c: int) -> Contacts:
    """Contacts of the three kinds: pusher on slab, slab on floor, block on slab."""
    n, r = _places(rng, n_c)
    J = np.zeros((n_c, 4, 15))
    low, high = slice(0, None, 2), slice(1, None, 2)  # below the slab, between slab and block
    J[low, :, 3:9] = point_jacobian(r - UP, n)[low]
    J[high, :, 3:9] = -point_jacobian(r + UP, n)[high]
    J[high, :, 9:15] = point_jacobian(r - SIZE * Z, n)[high]
    if n_c > 1:  # the pusher's tip at the slab's side
        n[0] = X
        J[0] = 0.0
        J[0, :, 3:9] = point_jacobian([-SIZE, 0.2 * SIZE * rng.uniform(-1, 1), 0.0], X)
        J[0, :3, 0:3] = -np.eye(3)
    return _resting(rng, n, J, 0.5)


def _places(rng: Rng, n_c: int) -> tuple[Array, Array]:
    """Normals near the vertical, and points of a slab's middle, shapes (n_c, 3)."""
    n = np.column_stack([TILT * rng.normal(size=(n_c, 2)), np.ones(n_c)])
    n /= np.linalg.norm(n, axis=1, keepdims=True)
    return n, np.column_stack([SIZE * rng.uniform(-1, 1, (n_c, 2)), np.zeros(n_c)])


def _resting(rng: Rng, n: Array, J: Array, torsional: float) -> Contacts:
    """Contacts with gaps and friction at random, a share of them with six rows."""
    n_c = len(n)
    touching = rng.uniform(size=n_c) < 0.3
    return contacts_of(
        phi=np.where(touching, 0.0, rng.exponential(GAP, n_c)),
        frames=frames_about(n, Y),
        J=J,
        mu_v=rng.uniform(0.2, 0.9, n_c),
        mu_omega=rng.uniform(0.002, 0.02, n_c),
        rows=np.where(rng.uniform(size=n_c) < torsional, 6, 4),
    )


def _inertia(masses: Array) -> Array:
    """M_u of bodies with the moments of a cube."""
    return np.diag(np.outer(masses, [1.0, 1.0, 1.0, *[2 / 3 * SIZE**2] * 3]).ravel())


def _loads(rng: Rng, masses: Array) -> Array:
    """Weights, and random wrenches of up to 0.3 of them [N, N m]."""
    weight = np.outer(masses, [0.0, 0.0, -GRAVITY, 0.0, 0.0, 0.0]).ravel()
    pull = 0.3 * GRAVITY * np.repeat(masses, 6) * rng.uniform(-1, 1, 6 * len(masses))
    return np.asarray(weight + pull * np.tile([1.0, 1.0, 1.0, SIZE, SIZE, SIZE], len(masses)))
