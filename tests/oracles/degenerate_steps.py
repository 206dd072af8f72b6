"""Steps that are degenerate by construction: most slacks and coordinates are zero, or tie."""

import numpy as np

from quasistatic_ref.lab.scenes.contacts import GRAVITY, X, Y, Z, contacts_of, point_jacobian
from quasistatic_ref.lab.scenes.contacts import repeated as some_of
from quasistatic_ref.lab.scenes.rigid import free_step

CONES = ("pyramid", "product", "facets-6", "facets-8", "frictionless")
CORNERS = np.array([(1, 1), (1, -1), (-1, 1), (-1, -1)], dtype=np.float64)
UP, RIGHT, LEFT = (X, Y, Z), (Y, Z, X), (Z, Y, -X)
"""Frames (d1, d2, n) of a floor, and of walls to the left and to the right of a box."""


def degenerate_step(seed):
    """A stack of one to three boxes, pushed along an axis or not at all; the seed decides.

    Gaps are equal everywhere, some contacts occur twice, and some forces are zero.

    Parameters
    ----------
    seed : int
    """
    rng = np.random.default_rng([seed, 3])
    boxes = int(rng.choice([1, 1, 2, 3]))
    sides = rng.choice([0.04, 0.05, 0.0625], 3) if rng.random() < 0.5 else np.full(3, 0.04)
    mass = float(rng.choice([0.2, 0.5, 1.0]))
    inertia = mass / 12 * (np.sum(sides**2) - sides**2)
    gap = float(rng.choice([0.0, 0.0, 1e-4, 2.0**-13, -1e-5]))
    phi, frames, J = [], [], []
    for box in range(boxes):
        for corner in CORNERS:
            of_upper = np.array([*corner, -1.0]) * sides / 2
            own = np.zeros((4, 6 * boxes))
            own[:, 6 * box : 6 * box + 6] = point_jacobian(of_upper, Z)
            if box:
                of_lower = of_upper + sides * Z
                own[:, 6 * box - 6 : 6 * box] = -point_jacobian(of_lower, Z)
            phi.append(gap)
            frames.append(UP)
            J.append(own)
    for side, frame in ((-1.0, RIGHT), (1.0, LEFT)) if rng.random() < 0.3 else ():
        for corner in CORNERS:
            own = np.zeros((4, 6 * boxes))
            own[:, :6] = point_jacobian(np.array([side, *corner]) * sides / 2, frame[2])
            phi.append(gap if gap > 0 else 0.0)  # pushed out by both walls there is no step
            frames.append(frame)
            J.append(own)
    contacts = contacts_of(
        phi, frames, J, rng.choice([0.0, 0.3, 0.5]), rng.choice([0.0, 0.01]), rng.choice([4, 6])
    )
    twice = np.flatnonzero(rng.random(len(phi)) < rng.choice([0.0, 0.2]))
    contacts = some_of(contacts, [*range(len(phi)), *twice])
    weight = mass * GRAVITY * float(rng.choice([0.0, 1.0, 1.0]))
    force = np.tile([0.0, 0.0, -weight, 0.0, 0.0, 0.0], boxes)
    axis = int(rng.integers(6))
    size = weight * (1.0 if axis < 3 else 0.01)
    force[axis] += size * float(rng.choice([0.0, 0.2, 0.5, 2.0])) * rng.choice([-1.0, 1.0])
    M = np.diag(np.tile([mass, mass, mass, *inertia], boxes))
    h = float(rng.choice([0.01, 2.0**-6]))
    return free_step(M, force, contacts, h).replace(cone=str(rng.choice(CONES)))
