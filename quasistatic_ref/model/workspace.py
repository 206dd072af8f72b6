"""Pinocchio's workspaces of a world, in parts: a workspace grows with the cube of n_v.

Bodies move on their own (all of them hang from the world), so what pinocchio says about several
of them at once is what it says about each. It gets the cosine and the sine of revolute joints, and
not their angles: its own sines are those of the C library.
"""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np
import pinocchio as pin

from quasistatic_ref.model.body import Body
from quasistatic_ref.model.coordinates import Order
from quasistatic_ref.model.urdf.urdf import body_frame, urdf_model
from quasistatic_ref.model.world import World, joined
from quasistatic_ref.numbers.angles import cos_sin
from quasistatic_ref.numbers.arrays import Array, Indices

PART = 24
"""Most coordinates of a part, unless one body alone has more: of 48, a workspace takes several
times as long to make."""

WORLD_POSE = np.eye(3), np.zeros(3)


class WorkspacePart(NamedTuple):
    """Some bodies: their own model and workspace, and where their entries are in the whole.

    Parameters
    ----------
    model, data : pinocchio.Model, pinocchio.Data
    R, t : list of ndarray, shapes (3, 3) and (3,)
        Poses of the links of these bodies: views of the workspace, which pinocchio overwrites.
    entries : ndarray of int
        For each entry of the part's own q, the entry of the paper's q that it is, or is made of.
    turns : list of int
        Where in the part's own q the cosines of revolute joints are; their sines follow.
    """

    model: pin.Model
    data: pin.Data
    R: list[Array]
    t: list[Array]
    entries: Indices
    turns: list[int]

    def part_q(self, q: Array) -> Array:
        """The part's own q, from the paper's, shape (n_q,)."""
        q_part = q.take(self.entries)
        for i in self.turns:
            q_part[i], q_part[i + 1] = cos_sin(float(q_part[i]))
        return q_part


class Workspace:
    """All bodies of a world.

    Parameters
    ----------
    world : World
    order : Order
        The paper's, of the q that it is given.
    """

    def __init__(self, world: World, order: Order) -> None:
        self.parts: list[WorkspacePart] = []
        before = 0
        of_paper = np.argsort(order.q)
        for model, links in _part_models(world):
            data = pin.Data(model)
            placements = [data.oMf[body_frame(model, link)] for link in links]
            R = [p.rotation for p in placements]
            t = [p.translation for p in placements]
            entries, turns = _sources(world.model, model, before)
            self.parts.append(WorkspacePart(model, data, R, t, of_paper[entries], turns))
            before += model.njoints - 1
        self._none = np.zeros((6, 0))
        self._gravity: tuple[float, ...] | None = None

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

    def poses(self) -> tuple[Array, Array, Array]:
        """R (L, 3, 3) and t (L, 3) of all links, the world first, and all joints' columns (6, n_x).

        They are those of the last move. Columns are as in
        :class:`~quasistatic_ref.model.kinematics.Kinematics`; all are read-only.
        """
        R = [WORLD_POSE[0]]
        t = [WORLD_POSE[1]]
        columns = []
        for part in self.parts:
            R += part.R
            t += part.t
            columns.append(part.data.J.reshape(6, -1))  # a single column comes as a vector
        all_columns = np.concatenate([self._none, *columns], axis=1)
        arrays = np.array(R), np.array(t), all_columns
        for array in arrays:
            array.setflags(write=False)
        return arrays

    def gravity_torque(self, q_parts: Sequence[Array], gravity: tuple[float, ...]) -> Array:
        """What stands for gravity on the left of M dv + g = tau, shape (n_v,) [N, N m].

        It is in pinocchio's order.

        Parameters
        ----------
        q_parts : sequence of ndarray, each of shape (n,)
            As of :meth:`q_parts` [m, rad, -].
        gravity : tuple of float, length 3
            The acceleration of free fall in the world frame [m/s^2].
        """
        if gravity != self._gravity:
            for part in self.parts:
                part.model.gravity.linear = np.array(gravity)
            self._gravity = gravity
        torques = [
            pin.computeGeneralizedGravity(part.model, part.data, q_part)
            for part, q_part in zip(self.parts, q_parts, strict=True)
        ]
        return torques[0] if len(torques) == 1 else np.concatenate([self._none[0], *torques])


def _part_models(world: World) -> Iterator[tuple[pin.Model, list[str]]]:
    """Models of bodies that follow one another, and the links of each.

    A model has PART coordinates at most, or one body that has more; its revolute joints have
    cosine and sine in place of an angle, as
    :func:`~quasistatic_ref.model.urdf.urdf.urdf_model` says.
    """
    links: dict[str, list[str]] = {}
    for link in world.links[1:]:
        links.setdefault(link.partition("/")[0], []).append(link)
    bodies: list[Body] = []
    models: list[pin.Model] = []
    for body, file in zip(world.bodies, world.files, strict=True):
        model = urdf_model(file, body.base, turns=True)
        if models and sum(m.nv for m in models) + model.nv > PART:
            yield joined(bodies, models), [link for b in bodies for link in links[b.name]]
            bodies, models = [], []
        bodies.append(body)
        models.append(model)
    if models:
        yield joined(bodies, models), [link for b in bodies for link in links[b.name]]


def _sources(all_bodies: pin.Model, model: pin.Model, before: int) -> tuple[Indices, list[int]]:
    """Entries of the model's q of a part after `before` other joints, and its `turns`."""
    entries = np.zeros(model.nq, dtype=np.int64)
    turns = []
    for joint in range(1, model.njoints):
        start = model.idx_qs[joint]
        size = model.nqs[joint]
        sources = all_bodies.idx_qs[joint + before] + np.arange(size)
        if size > all_bodies.nqs[joint + before]:
            turns.append(start)
            sources[1] = sources[0]
        entries[start : start + size] = sources
    return entries, turns
