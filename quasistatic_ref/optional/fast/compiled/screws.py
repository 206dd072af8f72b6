"""Sums q (+) delta_q and differences of configurations: pinocchio's, with the screws of bases."""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from quasistatic_ref.model.coordinates import Joint
from quasistatic_ref.model.system import System
from quasistatic_ref.optional.fast.compiled.library import library
from quasistatic_ref.optional.fast.compiled.poses import Poses
from quasistatic_ref.optional.fast.compiled.structure import Structure
from quasistatic_ref.step.data import Array

KINDS = ("floating", "planar", "continuous")
NUMBERS = ("joints",)
ARRAYS = ("kind", "q_start", "v_start", "angle", "q", "q_next", "delta_q")
"""The fields of ``Screws`` in screws.c."""


class Screws:
    """Sums and differences of the configurations of a system.

    Parameters
    ----------
    system : System
    poses : Poses
        Its configuration q is where sums and differences start.
    """

    def __init__(self, system: System, poses: Poses) -> None:
        found = library()
        self.system, self.q = system, poses.q
        same, bodies = poses.order.same, poses.workspace
        self._sum = bodies.sum if same else system.pinocchio_sum
        self._difference = bodies.difference if same else system.pinocchio_difference
        self._positions, self._changes = found.positions, found.changes
        joints = [joint for joint in system.joints if joint.kind in KINDS]
        self._sums = _structure(found, poses.q, joints, system.n_v)
        actuated = [joint for joint in joints if joint.actuated]
        self._differences = _structure(found, poses.q, actuated, system.n_a)
        self._of_sums, self._of_differences = (
            tuple(s[name] for name in ("q_next", "delta_q", "angle"))
            for s in (self._sums, self._differences)
        )
        self._target = self._of_differences[0][: system.n_q_a]
        self._vectors, self._actuated = _rotations(joints), _rotations(actuated)

    def integrate(self, delta_q: Array) -> Array:
        """Configuration q (+) delta_q, shape (n_q,)."""
        there, change, angle = self._of_sums
        there[:], change[:] = self._sum(self.q, delta_q), delta_q
        moved = delta_q.tolist()
        for i, where in self._vectors:
            angle[i] = math.hypot(*moved[where])
        self._positions(self._sums.address)
        return there.copy()

    def actuated_difference(self, q_a: Array) -> Array:
        """Change of the actuated coordinates, shape (n_a,), to q_a; ModelError unless (n_q_a,)."""
        there, change, angle = self._of_differences
        if np.shape(q_a) != self._target.shape:
            self.system.with_actuated(self.q, q_a)  # which says so
        there[:] = self.q
        self._target[:] = q_a
        change[:] = self._difference(self.q, there)[: len(change)]
        moved = change.tolist()
        for i, where in self._actuated:
            angle[i] = math.hypot(*moved[where])
        self._changes(self._differences.address)
        return change.copy()


def _structure(found: Any, q: Array, joints: Sequence[Joint], n_v: int) -> Structure:
    """The structure for some joints at q, whose delta_q has n_v entries."""
    made = Structure(NUMBERS, ARRAYS, found.screws_size)
    made.put(
        {
            "joints": len(joints),
            "kind": np.array([KINDS.index(joint.kind) for joint in joints], np.int64),
            "q_start": np.array([joint.q.start for joint in joints], np.int64),
            "v_start": np.array([joint.v.start for joint in joints], np.int64),
            "angle": np.zeros(len(joints)),
            "q": q, "q_next": np.zeros(len(q)), "delta_q": np.zeros(n_v),
        }
    )  # fmt: skip
    return made


def _rotations(joints: Sequence[Joint]) -> list[tuple[int, slice]]:
    """Which of the joints are bases, and where the rotation vectors of these are in delta_q."""
    first = {"floating": 3, "planar": 2}
    return [
        (i, slice(joint.v.start + first[joint.kind], joint.v.stop))
        for i, joint in enumerate(joints)
        if joint.kind in first
    ]
