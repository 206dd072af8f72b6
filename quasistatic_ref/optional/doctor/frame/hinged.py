"""Mechanisms with joints that nothing drives, and how their own motion moves contacts."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from quasistatic_ref.numbers.arrays import Array, Indices

if TYPE_CHECKING:
    from quasistatic_ref.model.mechanism import Mechanism
    from quasistatic_ref.simulate.result import StepResult
    from quasistatic_ref.simulate.simulator import Simulator

NONE = -1
"""Label of coordinates and sides of contacts that are of no such mechanism."""


def hinged(system: Mechanism) -> dict[str, Indices]:
    """The un-actuated coordinates of each body that has other ones than those of a free base.

    Drawers, doors and bodies on a planar base are such. Indices in delta_q, shape (k,).
    """
    joints = [joint for joint in system.joints if not joint.actuated]
    bodies = [joint.name.partition("/")[0] for joint in joints]
    moving = {body for body, joint in zip(bodies, joints, strict=True) if not joint.free}
    return {
        body: np.concatenate(
            [np.r_[joint.v] for one, joint in zip(bodies, joints, strict=True) if one == body]
        )
        for body in sorted(moving)
    }


def sides(simulator: Simulator) -> Indices:
    """Which of the mechanisms alpha and beta of each contact are, shape (n_c, 2); or `NONE`.

    Both links of a contact may be of one mechanism: it is then alpha's alone.
    """
    number = {body: i for i, body in enumerate(hinged(simulator.system))}
    links = simulator.system.links
    of_pairs = [
        [number.get(links[shape.link].partition("/")[0], NONE) for shape in (pair.alpha, pair.beta)]
        for pair in simulator.pairs
    ]
    labels = np.array(of_pairs, dtype=int).reshape(-1, 2)
    labels[labels[:, 0] == labels[:, 1], 1] = NONE
    return np.repeat(labels, [pair.n_c for pair in simulator.pairs], axis=0)


def motions(simulator: Simulator, results: Sequence[StepResult], delta_q: Array) -> Array:
    """J delta_q of each contact by the un-actuated coordinates of its sides alone, in the world.

    Shape (steps, n_c, 2, 3) [m]: of alpha's mechanism and of beta's; (steps, 0, 2, 3) where there
    is none. `delta_q` has shape (steps, n_v).
    """
    bodies = hinged(simulator.system)
    if not bodies:
        return np.zeros((len(results), 0, 2, 3))
    contacts = [result.step.contacts for result in results]
    n_v = contacts[0].n_v
    own = np.array([one.own[:, :3] for one in contacts])
    column = np.array([one.column for one in contacts])
    body = np.full(n_v + 1, NONE - 1)  # of no side
    for i, coordinates in enumerate(bodies.values()):
        body[coordinates] = i
    entries = np.zeros((len(results), n_v + 1))
    entries[:, : delta_q.shape[1]] = delta_q
    moved = np.take_along_axis(entries, column.reshape(len(results), -1), axis=1)
    is_own = body[column][:, :, None] == sides(simulator)[:, :, None]
    along = moved.reshape(column.shape)[:, :, None] * is_own
    return np.asarray(np.einsum("scxw,sckw->sckx", own, along))
