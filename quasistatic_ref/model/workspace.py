"""Pinocchio's models with their workspaces, in parts: a workspace grows with the cube of n_v.

Bodies move on their own (all of them hang from the world), so what pinocchio says about several
of them at once is what it says about each.
"""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
import pinocchio as pin

from quasistatic_ref.step.arrays import Array

PART = 48
"""Most coordinates of a part, unless one body alone has more: some ten megabytes of workspace."""

WORLD = np.eye(3)
ORIGIN = np.zeros(3)


class Part(NamedTuple):
    """Some bodies: their own model and workspace, and where their entries are in the whole.

    Parameters
    ----------
    model, data : pinocchio.Model, pinocchio.Data
    R, t : list of ndarray, shapes (3, 3) and (3,)
        Poses of the links of these bodies: views of the workspace, which pinocchio overwrites.
    q, v : slice
    """

    model: Any
    data: Any
    R: list[Array]
    t: list[Array]
    q: slice
    v: slice


class Workspace:
    """All bodies of a world, in pinocchio's order.

    Parameters
    ----------
    models : sequence of pinocchio.Model
        Of groups of bodies, in the order in which the whole model has them; they are copied.
    frames : sequence of list of int
        Of the links of each group.
    """

    def __init__(self, models: Sequence[Any], frames: Sequence[list[int]]) -> None:
        self.parts: list[Part] = []
        q = v = 0
        for model, links in zip(models, frames, strict=True):
            entries = slice(q, q + model.nq), slice(v, v + model.nv)
            model = model.copy()  # its gravity is this workspace's own
            data = pin.Data(model)
            placements = [data.oMf[link] for link in links]
            R, t = [p.rotation for p in placements], [p.translation for p in placements]
            self.parts.append(Part(model, data, R, t, *entries))
            q, v = q + model.nq, v + model.nv
        self._none = np.zeros((6, 0))
        self._gravity: tuple[float, ...] | None = None

    def move(self, q: Array) -> None:
        """Have pinocchio write the poses and the columns at q, shape (n_q,), into the parts."""
        for part in self.parts:
            pin.computeJointJacobians(part.model, part.data, q[part.q])
            pin.updateFramePlacements(part.model, part.data)

    def poses(self, q: Array) -> tuple[Array, Array, Array]:
        """R (L, 3, 3) and t (L, 3) of all links, the world first, and all joints' columns (6, n_x).

        Columns are as in :class:`~quasistatic_ref.model.kinematics.Kinematics`; all are read-only.
        """
        self.move(q)
        R, t, columns = [WORLD], [ORIGIN], []
        for part in self.parts:
            R += part.R
            t += part.t
            columns.append(part.data.J.reshape(6, -1))  # a single column comes as a vector
        all_columns = columns[0].copy() if len(columns) == 1 else np.hstack([self._none, *columns])
        found = np.array(R), np.array(t), all_columns
        for array in found:
            array.setflags(write=False)
        return found

    def sum(self, q: Array, delta_q: Array) -> Array:
        """Configuration q (+) delta_q, shape (n_q,), whose bases lack digits of their places."""
        sums = [pin.integrate(part.model, q[part.q], delta_q[part.v]) for part in self.parts]
        return sums[0] if len(sums) == 1 else np.concatenate(sums)

    def difference(self, q: Array, q_next: Array) -> Array:
        """Change q_next (-) q, shape (n_v,), of which only rotations of floating bases count."""
        parts = [pin.difference(part.model, q[part.q], q_next[part.q]) for part in self.parts]
        return parts[0] if len(parts) == 1 else np.concatenate(parts)

    def gravity_torque(self, q: Array, gravity: tuple[float, ...]) -> Array:
        """What stands for gravity on the left of M dv + g = tau, shape (n_v,) [N, N m].

        Gravity is the acceleration of free fall in the world frame, three numbers [m/s^2].
        """
        if gravity != self._gravity:
            for part in self.parts:
                part.model.gravity.linear = np.array(gravity)
            self._gravity = gravity
        torques: list[Array] = [
            pin.computeGeneralizedGravity(part.model, part.data, q[part.q]) for part in self.parts
        ]
        return torques[0] if len(torques) == 1 else np.concatenate([self._none[0], *torques])
