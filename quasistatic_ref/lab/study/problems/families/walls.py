"""Walls of bricks, each on two others: many bodies, and rows with entries in few columns."""

import numpy as np

from quasistatic_ref.lab.scenes.at_random import Rng, spread_matrix
from quasistatic_ref.lab.scenes.contacts import GRAVITY, Y, frames_about, point_jacobian
from quasistatic_ref.lab.scenes.rigid import free_step
from quasistatic_ref.lab.study.problems.families.short import (
    OF_FRICTION,
    OF_J,
    H,
    framed,
    shortened,
)
from quasistatic_ref.step.data import Array, Indices, StepData

LAYERS = 5
"""Rows of bricks of a wall."""
EACH = 2
"""Contacts of a pair of bodies, and of a brick with the floor."""
SIDE = 0.05
"""Half of a brick's length, and its height [m]."""
TILT = 0.05
"""Standard deviation of normals [rad]."""
GAP = 1e-4
"""Mean of the gaps that are not zero [m]."""
FLOOR = -1
"""In place of the lower body of a contact."""


def brick_wall(rng: Rng, bodies: float) -> StepData:
    """A wall of bricks, each on two of the layer below, pushed at random.

    Parameters
    ----------
    rng : Generator
    bodies : float
        Rounded; 6 coordinates each [-].
    """
    count = round(bodies)
    upper, lower, at = _pairs(count)
    J = _jacobian(rng, upper, lower, at, count)
    touching = rng.uniform(size=len(J)) < 0.5
    phi = np.where(touching, 0.0, rng.exponential(GAP, len(J)))
    contacts = framed(shortened(J, OF_J), shortened(phi, OF_J), rng.uniform(0.2, 0.9, len(J)))
    M = np.zeros((6 * count, 6 * count))
    load = np.zeros(6 * count)
    for i in range(count):
        mass = shortened(0.5 + rng.uniform(), OF_FRICTION)
        own = _columns(i)
        M[own, own][:3, :3] = mass * np.eye(3)
        M[own, own][3:, 3:] = spread_matrix(rng, 3, 5e-4)
        pull = 0.5 * mass * GRAVITY * rng.uniform(-1, 1, 6) * [1, 1, 1, SIDE, SIDE, SIDE]
        load[own] = pull - mass * GRAVITY * np.eye(6)[2]
    return free_step(shortened(M, OF_J), load, contacts, H)


def _pairs(count: int) -> tuple[Indices, Indices, Array]:
    """Upper and lower body of each contact, and where it is along the upper brick [m]."""
    width = -(-count // LAYERS)
    upper = []
    lower = []
    at = []
    for i in range(count):
        layer, place = divmod(i, width)
        below = [i - width, i - width + 1] if place + 1 < width else [i - width]
        for side, one in zip((-0.5, 0.5), [FLOOR] * 2 if layer == 0 else below, strict=False):
            upper += [i] * EACH
            lower += [one] * EACH
            at += [side * SIDE] * EACH
    return np.array(upper), np.array(lower), np.array(at)


def _jacobian(rng: Rng, upper: Indices, lower: Indices, at: Array, count: int) -> Array:
    """J of the contacts of bricks with the layer below, normals upwards but for a tilt."""
    n = np.column_stack([TILT * rng.standard_normal((len(upper), 2)), np.ones(len(upper))])
    n /= np.linalg.norm(n, axis=1, keepdims=True)
    along, across = (SIDE * rng.uniform(-0.4, 0.4, (len(upper), 2))).T
    height = np.full(len(n), 0.5 * SIDE)
    of_upper = _along(n, np.column_stack([along + at, across, -height]))
    of_lower = _along(n, np.column_stack([along - at, across, height]))
    J = np.zeros((len(n), 4, 6 * count))
    for j in range(len(n)):
        J[j, :, _columns(upper[j])] = of_upper[j]
        if lower[j] != FLOOR:
            J[j, :, _columns(lower[j])] = -of_lower[j]
    return J


def _along(n: Array, points: Array) -> Array:
    """J of points of one body along d1, d2, n and spin, shape (n_c, 4, 6)."""
    J = point_jacobian(points, n)
    J[:, :3] = frames_about(n, Y) @ J[:, :3]
    return J


def _columns(body: int) -> slice:
    """The coordinates of a body."""
    return slice(6 * body, 6 * body + 6)
