"""Whether a step stays as it is where the tangents of a contact turn to another axis of the world.

Where two axes are as far from the normal, tangents jump by a finite angle, and the polyhedral cone
turns with them. A contact that slides is held by other rows then. One that sticks stays, if what it
bears is inside of both cones: its gap, slips and spin are zero in whatever frame. So does one
without load whose motion is inside of both.
"""

from typing import Final

import numpy as np
from scipy.optimize import nnls

from quasistatic_ref.optional.derivatives.step.touching import Touching
from quasistatic_ref.step.data import Array, StepData
from quasistatic_ref.tolerances import TIED

INSIDE: Final = 1e-6
"""A load or a motion that is at least this far inside of a cone, relative to its own size [-],
stays inside when the normal of the cone turns by TIED and float64 rounds."""


def stays(step: StepData, x: Array, touching: Touching, j: int) -> bool:
    """Whether a displacement is optimal with each of the frames that contact j may have.

    Parameters
    ----------
    step : StepData
        Of a polyhedral cone.
    x : ndarray, shape (n_v,)
        Its displacement [m, rad].
    touching : Touching
        Its rows without slack.
    j : int
    """
    contacts = step.contacts
    table = touching.table[step.mask[j]]
    motion = touching.generators[j] @ x
    load = touching.multipliers[j]
    motion[0] += contacts.phi[j]
    strict, idle = (int(np.sum(rows[:, 0] == j)) for rows in (touching.strict, touching.idle))
    turns = _turns(contacts.n[j], contacts.d1[j], contacts.d2[j])
    if strict == len(table):
        return all(_inside(table, turn @ load) for turn in turns)
    if strict or idle:
        return False
    margin = INSIDE * np.abs(motion).max()
    return all(bool((table @ turn @ motion > margin).all()) for turn in turns)


def _turns(n: Array, d1: Array, d2: Array) -> list[Array]:
    """What takes gap, slips and spin, or their multipliers, to the frames of other axes, (4, 4).

    These are the axes of the world that are as far from n as the first.
    """
    size = np.abs(n)
    tied = np.flatnonzero(size - size.min() <= TIED)
    turns = []
    for axis in np.eye(3)[tied[tied != size.argmin()]]:
        across = axis - (axis @ n) * n
        across = across / np.sqrt(across @ across)
        turn = np.eye(4)
        turn[1:3, 1:3] = np.stack([across, np.cross(n, across)]) @ np.stack([d1, d2], axis=1)
        turns.append(turn)
    return turns


def _inside(table: Array, load: Array) -> bool:
    """Whether multipliers are combined from all rows of a table (R, 4), each with a part of it."""
    share = INSIDE * load[0] * table.mean(axis=0)
    _, miss = nnls(table.T, load - share)
    return bool(miss <= INSIDE**2 * load[0])
