"""Pinocchio's workspaces of a world, in parts: a workspace grows with the cube of n_v.

Pinocchio gets the cosine and the sine of revolute joints, and not their angles: its own sines are
those of the C library.
"""

from collections.abc import Iterator, Sequence
from threading import Lock
from typing import NamedTuple

import numpy as np
import pinocchio as pin

from quasistatic_ref.model.coordinates import Order
from quasistatic_ref.model.joints.joint import Joint
from quasistatic_ref.model.world import World
from quasistatic_ref.numbers.angles import cos_sin
from quasistatic_ref.numbers.arrays import Array, Indices, read_only


class WorkspacePart(NamedTuple):
    """Some bodies: their own model and workspace, and where their entries are in the whole.

    Parameters
    ----------
    model, data : pinocchio.Model, pinocchio.Data
    entries : ndarray of int
        For each entry of the part's own q, the entry of the paper's q that it is, or is made of.
    turns : list of int
        Where in the part's own q the cosines of revolute joints are; their sines follow.
    """

    model: pin.Model
    data: pin.Data
    entries: Indices
    turns: list[int]

    def part_q(self, q: Array) -> Array:
        """The part's own q, from the paper's, shape (n_q,)."""
        q_part = q.take(self.entries)
        for i in self.turns:
            q_part[i], q_part[i + 1] = cos_sin(float(q_part[i]))
        return q_part


class Workspace:
    """The memory in which pinocchio computes poses and Jacobians of all bodies of a world.

    Threads wait for their turn to use it.

    Parameters
    ----------
    world : World
    order : Order
        The paper's, of the q that it is given.
    """

    def __init__(self, world: World, order: Order) -> None:
        self.parts: list[WorkspacePart] = []
        R = [np.eye(3)]
        t = [np.zeros(3)]
        columns = []
        of_paper = np.argsort(order.q)
        joints = iter(world.joints)
        for part in world.parts:
            model = pin.Model(part.model)  # its gravity is written
            data = pin.Data(model)
            placements = [data.oMf[frame] for frame in part.frames]
            R += [p.rotation for p in placements]
            t += [p.translation for p in placements]
            columns.append(data.J.reshape(6, -1))  # a single column comes as a vector
            entries, turns = _sources(model, joints)
            self.parts.append(WorkspacePart(model, data, of_paper[entries], turns))
        # Poses of all links and columns of all joints: views that pinocchio overwrites.
        self._views = [*map(_by_columns, R), *t, *map(_by_columns, columns)]
        self._gravity: tuple[float, ...] | None = None
        self._turn = Lock()

    def q_parts(self, q: Array) -> list[Array]:
        """Each part's own q, shape (n,), from the paper's, shape (n_q,)."""
        return [part.part_q(q) for part in self.parts]

    def move(self, q_parts: Sequence[Array]) -> None:
        """Have pinocchio write the poses and the columns at a q.

        Parameters
        ----------
        q_parts : sequence of ndarray, each of shape (n,)
            As of :meth:`q_parts` [m, rad, -].
        """
        for part, q_part in zip(self.parts, q_parts, strict=True):
            pin.computeJointJacobians(part.model, part.data, q_part)
            pin.updateFramePlacements(part.model, part.data)

    def poses(self, q_parts: Sequence[Array]) -> Array:
        """One array of R' (L, 3, 3) and t (L, 3) of all links, and of columns' (n_x, 6).

        The world is first. They are those of
        :class:`~quasistatic_ref.model.kinematics.Kinematics`, and read-only.

        Parameters
        ----------
        q_parts : sequence of ndarray, each of shape (n,)
            As of :meth:`q_parts` [m, rad, -].
        """
        with self._turn:
            self.move(q_parts)
            return read_only(np.concatenate(self._views))

    def gravity_torque(self, q_parts: Sequence[Array], gravity: tuple[float, ...]) -> Array:
        """The negative force of gravity on all coordinates, shape (n_v,) [N, N m].

        It is in pinocchio's order.

        Parameters
        ----------
        q_parts : sequence of ndarray, each of shape (n,)
            As of :meth:`q_parts` [m, rad, -].
        gravity : tuple of float, length 3
            The acceleration of free fall in the world frame [m/s^2].
        """
        with self._turn:
            if gravity != self._gravity:
                for part in self.parts:
                    part.model.gravity.linear = np.array(gravity)
                self._gravity = gravity
            torques = [
                pin.computeGeneralizedGravity(part.model, part.data, q_part)
                for part, q_part in zip(self.parts, q_parts, strict=True)
            ]
        return torques[0] if len(torques) == 1 else np.concatenate([np.zeros(0), *torques])


def _by_columns(matrix: Array) -> Array:
    """A view of a matrix, (m, n), column after column, (m n,), as pinocchio keeps it [any unit]."""
    return matrix.T.reshape(-1)


def _sources(model: pin.Model, joints: Iterator[Joint]) -> tuple[Indices, list[int]]:
    """Entries of pinocchio's q of all bodies that make a model's q, and its `turns`."""
    entries = np.zeros(model.nq, dtype=np.int64)
    turns = []
    for start, size in zip(model.idx_qs, model.nqs, strict=True):
        if not size:  # the world, or a joint that mimics another
            continue
        q = next(joints).q
        sources = q.start + np.arange(size)
        if size > q.stop - q.start:
            turns.append(start)
            sources[1] = sources[0]
        entries[start : start + size] = sources
    return entries, turns
