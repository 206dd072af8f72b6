"""How links move with the coordinates: what of it is the same at every configuration."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from quasistatic_ref.model.coordinates import Joint, Order, joint_key
from quasistatic_ref.step.arrays import Array

CROSS = np.cross(np.eye(3)[:, None], np.eye(3)).transpose(0, 2, 1).reshape(3, 9)
"""[x], [y] and [z] of the axes, each row by row."""


def cross_matrix(r: Array) -> Array:
    """[r x], so that [r x] w = r x w.

    Parameters
    ----------
    r : ndarray, shape (..., 3)

    Returns
    -------
    ndarray, shape (..., 3, 3)
        Its entries are those of r, exactly: each is a sum with two zeros.
    """
    entries: Array = r @ CROSS
    return entries.reshape(*r.shape, 3)


class Motion:
    """Which columns of pinocchio's Jacobian ``data.J`` move a link, and with which coordinate.

    A link is moved by the joints between it and the world. A mimic joint has columns, but no
    coordinate: it moves with that of another.

    Parameters
    ----------
    model : pinocchio.Model
    frames : sequence of int
        The frame of each link but the world.
    order : Order
    """

    def __init__(self, model: Any, frames: Sequence[int], order: Order) -> None:
        columns = [
            slice(start, start + size)
            for start, size in zip(model.idx_vExtendeds, model.nvExtendeds, strict=True)
        ]
        self.moves = np.zeros((1 + len(frames), 1, model.nvExtended))
        for link, frame in enumerate(frames, start=1):
            for joint in model.supports[model.frames[frame].parentJoint]:
                self.moves[link, 0, columns[joint]] = 1.0
        coordinates = np.zeros((model.nvExtended, model.nv))
        for at, v in zip(columns, model.idx_vs, strict=True):
            coordinates[at, v : v + at.stop - at.start] = np.eye(at.stop - at.start)
        self.order, self.coordinates = order, order.paper_v(coordinates)
        self.mimics = model.nvExtended > model.nv

    def of_coordinates(self, columns: Array) -> Array:
        """Per unit of delta_q, shape (..., n_v), from `columns` [m, rad]."""
        # Without mimics it is a permutation, which costs less for many coordinates.
        if not self.mimics:
            return self.order.paper_v(columns)
        flat: Array = columns.reshape(-1, columns.shape[-1]).dot(self.coordinates)
        return flat.reshape(*columns.shape[:-1], flat.shape[1])


def constant_mass(model: Any, joints: Sequence[Joint]) -> bool:
    """Whether M_u is the same at every q: every un-actuated joint is a rigid body's, alone.

    In its own frame a free body's mass matrix is constant, unless a joint hangs from it.
    """
    free = [joint for joint in joints if not joint.actuated]
    if any(joint.kind != "floating" for joint in free):
        return False
    parents = list(model.parents)
    return not any(model.getJointId(joint_key(joint.name)) in parents for joint in free)
