"""Sums q (+) delta_q and differences of configurations: in C, if it knows every joint.

Sines that C cannot decide are Python's.
"""

from collections.abc import Sequence

import numpy as np

from quasistatic_ref.model.angles import angle_of, cos_sin
from quasistatic_ref.model.joints.joint import Joint
from quasistatic_ref.model.system import System
from quasistatic_ref.optional.fast.compiled.library import library
from quasistatic_ref.optional.fast.compiled.poses import Poses
from quasistatic_ref.optional.fast.compiled.structure import Structure
from quasistatic_ref.step.data import Array


class Screws:
    """Sums and differences of the configurations of a system.

    Parameters
    ----------
    system : System
    poses : Poses
        Its configuration q is where sums and differences start.

    Attributes
    ----------
    known : bool
        Whether C knows every joint.
    sums, changes : Structure
        ``Screws`` of screws.c, of all joints and of those that are actuated.
    target : ndarray, shape (n_q_a,)
        To which changes lead.
    """

    def __init__(self, system: System, poses: Poses) -> None:
        found = library()
        self.system = system
        self.q = poses.q
        self._half_turns = found.half_turns
        self._turns = found.turns
        self._add = found.sums
        self._subtract = found.changes
        joints = system.joints
        n_a = system.n_a
        self.known = all(joint.in_c is not None for joint in joints)
        self.sums = _structure(poses.q, joints, system.n_v)
        self.changes = _structure(poses.q, [j for j in joints if j.actuated], n_a)
        self.target = self.changes["q_next"][: system.n_q_a]
        self._turning = [(i, j.actuated) for i, j in enumerate(joints) if j.unit]

    def integrate(self, delta_q: Array) -> Array:
        """Configuration q (+) delta_q, shape (n_q,)."""
        if not self.known:
            return self.system.integrate(self.q, delta_q)
        s = self.sums
        s["delta_q"][:] = delta_q
        if not self._half_turns(s.address):
            self.say_sines()
        self._add(s.address)
        return s["q_next"].copy()

    def say_sines(self) -> None:
        """Write the sines and cosines of a sum, some of which C could not decide."""
        s = self.sums
        for i, _ in self._turning:
            s["cosine"][i], s["sine"][i] = cos_sin(float(s["angle"][i]) / 2)

    def actuated_difference(self, q_a: Array) -> Array:
        """Change of the actuated coordinates, shape (n_a,), to q_a; ModelError unless (n_q_a,)."""
        if not self.known:
            return self.system.actuated_difference(self.q, q_a)
        s = self.changes
        if np.shape(q_a) != self.target.shape:
            self.system.with_actuated(self.q, q_a)  # which says so
        self.target[:] = q_a
        if not self._turns(s.address):
            for i, actuated in self._turning:
                if actuated:
                    turn = angle_of(float(s["y"][i]), float(s["x"][i]))
                    s["angle"][i] = turn
                    s["cosine"][i], s["sine"][i] = cos_sin(turn / 2)
        self._subtract(s.address)
        return s["delta_q"].copy()


def _structure(q: Array, joints: Sequence[Joint], n_v: int) -> Structure:
    """The structure for some joints at q, whose delta_q has n_v entries."""
    made = Structure("screws.c", "Screws")
    made.put(
        {
            "joints": len(joints),
            "kind": np.array([-1 if j.in_c is None else j.in_c for j in joints], np.int64),
            "q_start": np.array([joint.q.start for joint in joints], np.int64),
            "v_start": np.array([joint.v.start for joint in joints], np.int64),
            **{name: np.zeros(len(joints)) for name in ("angle", "cosine", "sine", "x", "y")},
            "q": q, "q_next": np.zeros(len(q)), "delta_q": np.zeros(n_v),
        }
    )  # fmt: skip
    return made
