"""Walls of many bodies, each on two others: quadratic programs with few entries in many columns."""

import numpy as np

from quasistatic_ref.lab.scenes.at_random import Rng, spread_matrix
from quasistatic_ref.lab.scenes.contacts import GRAVITY, Y, frames_about, point_jacobian
from quasistatic_ref.lab.study.problems.families.short import OF_FRICTION, OF_J, H, shortened
from quasistatic_ref.optional.large.blocks import Blocks
from quasistatic_ref.optional.large.sparse_contacts import SparseContacts
from quasistatic_ref.step.data import Array, Indices, StepData

LAYERS = 5
"""Rows of bricks of a wall."""
EACH = 2
"""Contacts of a pair of bodies, and of a brick with the floor."""
SIDE = 0.05
"""Half of a brick's length [m]."""
TILT = 0.05
"""Standard deviation of normals [rad]."""
GAP = 1e-4
"""Mean of the gaps that are not zero [m]."""


def heap_step(rng: Rng, bodies: float) -> StepData:
    """A wall of bricks, each on two of the layer below, pushed at random.

    Parameters
    ----------
    rng : Generator
    bodies : float
        Rounded; 6 coordinates each [-].
    """
    count = round(bodies)
    upper, lower, at = _pairs(count)
    n = np.column_stack([TILT * rng.standard_normal((len(upper), 2)), np.ones(len(upper))])
    n /= np.linalg.norm(n, axis=1, keepdims=True)
    frames = frames_about(n, Y)
    spread = SIDE * rng.uniform(-0.4, 0.4, (len(upper), 2))
    above = np.column_stack([at + spread[:, 0], spread[:, 1]])
    of_upper = _along(frames, n, np.column_stack([above, np.full(len(n), -0.5 * SIDE)]))
    below = np.column_stack([above[:, 0] - 2 * at, above[:, 1]])
    of_lower = _along(frames, n, np.column_stack([below, np.full(len(n), 0.5 * SIDE)]))
    column, J = _columns(upper, lower, of_upper, of_lower, count)
    touching = rng.uniform(size=len(n)) < 0.5
    phi = np.where(touching, 0.0, rng.exponential(GAP, len(n)))
    own = np.tile(np.eye(3), (len(n), 1, 1))
    contacts = SparseContacts(
        name=tuple(f"c{j}" for j in range(len(n))),
        phi=shortened(phi, OF_J),
        n=own[:, 2],
        d1=own[:, 0],
        d2=own[:, 1],
        blocks=Blocks(column, shortened(J, OF_J), 6 * count),
        mu_v=shortened(rng.uniform(0.2, 0.9, len(n)), OF_FRICTION),
        mu_omega=np.zeros(len(n)),
        rows=np.full(len(n), 4),
    )
    M, load = np.zeros((6 * count, 6 * count)), np.zeros(6 * count)
    for i in range(count):
        mass = shortened(0.5 + rng.uniform(), OF_FRICTION)
        M[6 * i : 6 * i + 3, 6 * i : 6 * i + 3] = mass * np.eye(3)
        M[6 * i + 3 : 6 * i + 6, 6 * i + 3 : 6 * i + 6] = spread_matrix(rng, 3, 5e-4)
        pull = 0.5 * mass * GRAVITY * rng.uniform(-1, 1, 6) * [1, 1, 1, SIDE, SIDE, SIDE]
        load[6 * i : 6 * i + 6] = pull - mass * GRAVITY * np.eye(6)[2]
    none = np.zeros(0)
    return StepData(H, np.zeros((0, 0)), shortened(M, OF_J), none, load, none, contacts)


def _pairs(count: int) -> tuple[Indices, Indices, Array]:
    """Upper and lower body of each contact (-1: the floor), and where along the brick [m]."""
    width = -(-count // LAYERS)
    upper, lower, at = [], [], []
    for i in range(count):
        layer, place = divmod(i, width)
        under = [-1, -1] if layer == 0 else [i - width, i - width + 1 if place + 1 < width else -2]
        for side, one in zip((-0.5, 0.5), under, strict=True):
            if one > -2:
                upper += [i] * EACH
                lower += [one] * EACH
                at += [side * SIDE] * EACH
    return np.array(upper), np.array(lower), np.array(at)


def _along(frames: Array, n: Array, points: Array) -> Array:
    """J of points of one body along d1, d2, n and spin, shape (n_c, 4, 6)."""
    J = point_jacobian(points, n)
    J[:, :3] = frames @ J[:, :3]
    return J


def _columns(
    upper: Indices, lower: Indices, of_upper: Array, of_lower: Array, count: int
) -> tuple[Indices, Array]:
    """Columns of both bodies, ascending, and J there; beyond the last where it is the floor."""
    six = np.arange(6)
    first = np.where(lower[:, None] < 0, 6 * upper[:, None] + six, 6 * lower[:, None] + six)
    second = np.where(lower[:, None] < 0, 6 * count, 6 * upper[:, None] + six)
    floor = (lower < 0)[:, None, None]
    J = np.concatenate(
        [np.where(floor, of_upper, -of_lower), np.where(floor, 0.0, of_upper)], axis=2
    )
    return np.concatenate([first, second], axis=1), J
