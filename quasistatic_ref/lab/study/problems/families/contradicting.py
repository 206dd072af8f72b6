"""Contacts that contradict each other, or do so but for a little."""

import numpy as np

from quasistatic_ref.lab.scenes.at_random import Rng, random_frames, spread_matrix
from quasistatic_ref.lab.scenes.contacts import GRAVITY, Y, Z, frames_about, point_jacobian
from quasistatic_ref.lab.scenes.rigid import free_step
from quasistatic_ref.lab.scenes.slabs import tower_step
from quasistatic_ref.lab.study.problems.families.shaped import base
from quasistatic_ref.lab.study.problems.families.short import (
    OF_J,
    H,
    framed,
    short_step,
    shortened,
    with_axes,
)
from quasistatic_ref.step.data import Array, StepData

MIRROR = np.array([1.0, -1.0, -1.0, -1.0])[:, None]
"""The other side of a wall: its frame is turned about d1, and the spin is about the other n."""
AROUND = 10
"""Contacts of a cage."""
SIZE = 0.04
"""Of the body in a cage [m]."""
TOWERS = (2, 10)
"""Fewest and most slabs of a tower under a ceiling, of 6 coordinates each."""
PRESSED = 4
"""Contacts of the ceiling."""
FAR = 1e-4
"""How far a body moves to leave a wedge, about [m]."""


def between_walls(rng: Rng, clearance: float) -> StepData:
    """The grasped body between two walls with a clearance [m], negative where they overlap."""
    step = base(rng)
    c = step.contacts
    wall = _wall(rng, step)
    phi = shortened(rng.uniform(0, 1e-4), OF_J)
    J = np.concatenate([c.J, wall[None], (MIRROR * wall)[None]])
    # The second gap is clearance - phi, whose float64 sum with phi is what contradicts.
    gaps = np.concatenate([np.abs(c.phi), [phi, clearance - phi]])
    mu_v = np.append(c.mu_v, [0.5, 0.5])
    mu_omega = np.append(c.mu_omega, [0.0, 0.0])
    return step.replace(contacts=framed(J, gaps, mu_v, mu_omega, np.append(c.rows, [4, 4])))


def in_a_cage(rng: Rng, clearance: float) -> StepData:
    """A free body held from all sides, each contact with about that clearance [m]."""
    n = rng.standard_normal((AROUND, 3))
    n -= n.mean(axis=0)
    n /= np.linalg.norm(n, axis=1, keepdims=True)
    J = point_jacobian(-SIZE * n + 0.3 * SIZE * rng.standard_normal((AROUND, 3)), n)
    J[:, :3] = frames_about(n, rng.standard_normal(3)) @ J[:, :3]
    gaps = clearance * (0.5 + rng.uniform(size=AROUND))
    contacts = framed(shortened(J, OF_J), shortened(gaps, OF_J), rng.uniform(0.2, 0.9, AROUND))
    M = np.zeros((6, 6))
    M[:3, :3] = 0.25 * np.eye(3)
    M[3:, 3:] = shortened(spread_matrix(rng, 3, 2e-4), OF_J)
    weight = 0.25 * GRAVITY * rng.uniform(-1, 1, 6) * [1, 1, 1, SIZE, SIZE, SIZE]
    return free_step(M, weight, contacts, H)


def in_a_wedge(rng: Rng, angle: float) -> StepData:
    """The grasped body in a wedge of two walls, which it must leave by a few millimetres.

    Parameters
    ----------
    rng : Generator
    angle : float
        Between the walls [rad]; they reach 1e-4 m times that into the body.
    """
    step = base(rng)
    c = step.contacts
    wall = _wall(rng, step)
    other = MIRROR * wall
    other[2] += angle * wall[0]  # n turned towards d1
    J = np.concatenate([c.J, wall[None], other[None]])
    gaps = np.append(c.phi, np.full(2, -FAR * angle))
    mu_v = np.append(c.mu_v, [0.0, 0.0])
    mu_omega = np.append(c.mu_omega, [0.0, 0.0])
    return step.replace(contacts=framed(J, gaps, mu_v, mu_omega, np.append(c.rows, [4, 4])))


def under_a_ceiling(rng: Rng, clearance: float) -> StepData:
    """A tower whose slabs touch, and a ceiling above it.

    Parameters
    ----------
    rng : Generator
    clearance : float
        Of the ceiling; negative where it reaches into the uppermost slab [m].
    """
    slabs = int(rng.integers(*TOWERS, endpoint=True))
    step = with_axes(rng, short_step(tower_step(rng, slabs)))
    c = step.contacts
    points = SIZE * np.column_stack([rng.uniform(-1, 1, (PRESSED, 2)), np.ones(PRESSED)])
    down = np.tile(-Z, (PRESSED, 1))
    ceiling = np.zeros((PRESSED, 4, step.n_v))
    ceiling[:, :, -6:] = point_jacobian(points, down)
    ceiling[:, :3] = frames_about(down, Y) @ ceiling[:, :3]
    phi = np.concatenate([np.zeros(c.n_c), np.full(PRESSED, clearance)])
    mu_v = np.concatenate([c.mu_v, rng.uniform(0.2, 0.9, PRESSED)])
    J = np.concatenate([c.J, shortened(ceiling, OF_J)])
    return step.replace(contacts=framed(J, phi, mu_v))


def _wall(rng: Rng, step: StepData) -> Array:
    """J of a wall at the body, shape (4, n_v), along its d1, d2, n and spin."""
    frame = random_frames(rng, 1)[0]
    own = point_jacobian(SIZE * rng.uniform(-1, 1, 3), frame[2])
    own[:3] = frame @ own[:3]
    J = np.zeros((4, step.n_v))
    J[:, step.n_a :] = shortened(own, OF_J)
    return J
