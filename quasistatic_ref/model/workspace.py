"""Pinocchio's models with their workspaces, in parts: a workspace grows with the cube of n_v.

Bodies move on their own (all of them hang from the world), so what pinocchio says about several
of them at once is what it says about each.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

Array = NDArray[np.float64]

PART = 48
"""Most coordinates of a part, unless one body alone has more: some ten megabytes of workspace."""


class Part(NamedTuple):
    """Some bodies: their own model and workspace, and where their entries are in the whole.

    Parameters
    ----------
    model, data : pinocchio.Model, pinocchio.Data
    frames : list of int
        Of the links of these bodies.
    q, v : slice
    """

    model: Any
    data: Any
    frames: list[int]
    q: slice
    v: slice


class Workspace:
    """All bodies of a world, in pinocchio's order.

    Parameters
    ----------
    models : sequence of pinocchio.Model
        Of groups of bodies, in the order in which the whole model has them.
    frames : sequence of list of int
        Of the links of each group.
    """

    def __init__(self, models: Sequence[Any], frames: Sequence[list[int]]) -> None:
        self.parts: list[Part] = []
        q = v = 0
        for model, links in zip(models, frames, strict=True):
            entries = slice(q, q + model.nq), slice(v, v + model.nv)
            self.parts.append(Part(model, pin.Data(model), links, *entries))
            q, v = q + model.nq, v + model.nv
        self.n_v, self._none = v, np.zeros((6, 0))

    def poses(self, q: Array) -> tuple[list[Array], Array]:
        """Pose of each link, shape (4, 4) each, and the columns of all joints, shape (6, n_x)."""
        poses, columns = [], []
        for part in self.parts:
            model, data = part.model, part.data
            pin.computeJointJacobians(model, data, q[part.q])
            pin.updateFramePlacements(model, data)
            placements = data.oMf
            poses += [placements[frame].homogeneous for frame in part.frames]
            columns.append(data.J.reshape(6, -1))  # a single column comes as a vector
        return poses, columns[0].copy() if len(columns) == 1 else np.hstack([self._none, *columns])

    def mass(self, q: Array) -> Array:
        """Mass matrix, shape (n_v, n_v)."""
        M = np.zeros((self.n_v, self.n_v))
        for part in self.parts:
            # Exactly symmetric: pinocchio's bindings copy the upper triangle to the lower.
            M[part.v, part.v] = pin.crba(part.model, part.data, q[part.q])
        return M

    def set_gravity(self, gravity: Array) -> None:
        """Acceleration of free fall in the world frame, shape (3,) [m/s^2]."""
        for part in self.parts:
            part.model.gravity.linear = gravity

    def gravity_torque(self, q: Array) -> Array:
        """What stands for gravity on the left of M dv + g = tau, shape (n_v,) [N, N m]."""
        torques: list[Array] = [
            pin.computeGeneralizedGravity(part.model, part.data, q[part.q]) for part in self.parts
        ]
        return torques[0] if len(torques) == 1 else np.concatenate([self._none[0], *torques])
