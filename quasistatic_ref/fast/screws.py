"""Sums q (+) delta_q and differences of configurations: pinocchio's, with the screws of bases."""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from quasistatic_ref.fast.library import library
from quasistatic_ref.fast.structure import Structure
from quasistatic_ref.model.coordinates import Joint
from quasistatic_ref.model.system import System
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
    """

    def __init__(self, system: System) -> None:
        found = library()
        self.system = system
        self._positions, self._changes = found.positions, found.changes
        joints = [joint for joint in system.joints if joint.kind in KINDS]
        self._sums = _structure(found, system, joints, system.n_v)
        actuated = [joint for joint in joints if joint.actuated]
        self._differences = _structure(found, system, actuated, system.n_a)
        self._vectors = [_rotation(joint) for joint in joints]
        self._actuated = [_rotation(joint) for joint in actuated]

    def integrate(self, q: Array, delta_q: Array) -> Array:
        """Configuration q (+) delta_q, shape (n_q,)."""
        s, change = self._sums, delta_q.tolist()
        s["q"][:], s["delta_q"][:] = q, delta_q
        s["q_next"][:] = self.system.pinocchio_sum(q, delta_q)
        s["angle"][:] = [math.hypot(*change[where]) for where in self._vectors]
        self._positions(s.address)
        return s["q_next"].copy()

    def actuated_difference(self, q: Array, q_a: Array) -> Array:
        """Change of the actuated coordinates, shape (n_a,), to q_a; ModelError unless (n_q_a,)."""
        s, q_next = self._differences, self.system.with_actuated(q, q_a)
        change = self.system.pinocchio_difference(q, q_next)[: self.system.n_a]
        entries = change.tolist()
        s["q"][:], s["q_next"][:], s["delta_q"][:] = q, q_next, change
        s["angle"][:] = [math.hypot(*entries[where]) for where in self._actuated]
        self._changes(s.address)
        return s["delta_q"].copy()


def _structure(found: Any, system: System, joints: Sequence[Joint], n_v: int) -> Structure:
    """The structure for some joints, whose delta_q has n_v entries."""
    made = Structure(NUMBERS, ARRAYS, found.screws_size)
    made.put(
        {
            "joints": len(joints),
            "kind": np.array([KINDS.index(joint.kind) for joint in joints], np.int64),
            "q_start": np.array([joint.q.start for joint in joints], np.int64),
            "v_start": np.array([joint.v.start for joint in joints], np.int64),
            "angle": np.zeros(len(joints)),
            "q": np.zeros(system.n_q), "q_next": np.zeros(system.n_q), "delta_q": np.zeros(n_v),
        }
    )  # fmt: skip
    return made


def _rotation(joint: Joint) -> slice:
    """Where a joint's rotation vector is in delta_q: of a continuous joint, nowhere."""
    first = {"floating": 3, "planar": 2, "continuous": 1}[joint.kind]
    return slice(joint.v.start + first, joint.v.stop)
