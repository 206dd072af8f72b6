"""q (+) delta_q and q_next (-) q of all joints, those of one kind at once where there are many."""

from collections import defaultdict
from collections.abc import Sequence
from typing import Final

import numpy as np

from quasistatic_ref.model.joints.joint import Joint
from quasistatic_ref.numbers.arrays import Array, Indices
from quasistatic_ref.numbers.compiled import compiled

MANY_JOINTS: Final = 12
"""Joints of one kind from which arrays are quicker than numbers."""


class Sums:
    """q (+) delta_q and q_next (-) q of some joints, whose entries stand first in q.

    Parameters
    ----------
    joints : sequence of Joint
        In the order of q.

    Attributes
    ----------
    joints : sequence of Joint
    n_q, n_v : int
        Numbers of their entries.
    many : list of (Joint, ndarray of int, ndarray of int)
        Of each kind with many joints one of them, and the entries of q and of delta_q of all.
    few : list of Joint
        All others.
    """

    def __init__(self, joints: Sequence[Joint]) -> None:
        self.joints = joints
        kinds: dict[type[Joint], list[Joint]] = defaultdict(list)
        for joint in joints:
            kinds[type(joint)].append(joint)
        self.many = [
            (some[0], _entries([one.q for one in some]), _entries([one.v for one in some]))
            for some in kinds.values()
            if len(some) >= MANY_JOINTS
        ]
        at_once = {type(joint) for joint, _, _ in self.many}
        self.few = [joint for joint in joints if type(joint) not in at_once]
        self.n_q: int = joints[-1].q.stop if joints else 0
        self.n_v: int = joints[-1].v.stop if joints else 0

    @compiled
    def plus(self, q: Array, delta_q: Array) -> Array:
        """Entries of q (+) delta_q, from those of both; shapes (n_q,) and (n_v,) [m, rad, -]."""
        there = np.empty(len(q))
        for joint, at, v in self.many:
            with np.errstate(all="ignore"):  # as plain arithmetic
                there[at] = joint.integrated([*q[at]], [*delta_q[v]])
        here = q.tolist()
        change = delta_q.tolist()
        for joint in self.few:
            there[joint.q] = joint.integrated(here[joint.q], change[joint.v])
        return there

    def change(self, q: Array, q_next: Array) -> Array:
        """Entries of q_next (-) q, shape (n,) [m, rad], from those of both [m, rad, -]."""
        change = np.empty(self.n_v)
        for joint, at, v in self.many:
            with np.errstate(all="ignore"):
                change[v] = joint.change([*q[at]], [*q_next[at]])
        here = q.tolist()
        there = q_next.tolist()
        for joint in self.few:
            change[joint.v] = joint.change(here[joint.q], there[joint.q])
        return change

    def plus_each(self, q: Array, delta_q: Array) -> Array:
        """Entries of q (+) each of N changes, (N, n_v): shape (N, n_q) [m, rad, -]."""
        there = np.empty((len(delta_q), len(q)))
        for joint in self.joints:
            with np.errstate(all="ignore"):  # as plain arithmetic
                moved = joint.integrated(q[joint.q].tolist(), [*delta_q[:, joint.v].T.copy()])
            there[:, joint.q] = np.stack(moved, axis=1)
        return there

    def changes(self, q: Array, q_next: Array) -> Array:
        """Entries of q_next (-) q, of each of N q_next (N, n): shape (N, n_v) [m, rad]."""
        change = np.empty((len(q_next), self.n_v))
        for joint in self.joints:
            with np.errstate(all="ignore"):
                apart = joint.change(q[joint.q].tolist(), [*q_next[:, joint.q].T.copy()])
            change[:, joint.v] = np.stack(apart, axis=1)
        return change


def _entries(slices: Sequence[slice]) -> Indices:
    """Numbers of the entries of alike slices, shape (entries, joints)."""
    return np.array([range(one.start, one.stop) for one in slices]).T
