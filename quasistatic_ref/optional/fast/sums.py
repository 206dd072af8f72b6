"""Sums q (+) delta_q in C, if it knows every joint. Sines that C cannot decide are Python's."""

import numpy as np

from quasistatic_ref.model.angles import cos_sin
from quasistatic_ref.model.system import System
from quasistatic_ref.optional.fast.library import Structure, library
from quasistatic_ref.optional.fast.poses import Poses
from quasistatic_ref.step.data import Array


class Sums:
    """Sums of the configurations of a system.

    Parameters
    ----------
    system : System
    poses : Poses
        Its configuration q is where sums start.
    """

    def __init__(self, system: System, poses: Poses) -> None:
        joints = system.joints
        self._system = system
        self._q = poses.q
        self._known = all(joint.in_c is not None for joint in joints)
        self._turning = [i for i, joint in enumerate(joints) if joint.unit]
        self._delta_q = np.zeros(system.n_v)
        self._q_next = np.zeros(system.n_q)
        kinds = [-1 if joint.in_c is None else joint.in_c for joint in joints]
        self.structure = Structure(
            "Sums",
            {
                "joints": len(joints),
                "kind": np.array(kinds, np.int64),
                "q_start": np.array([joint.q.start for joint in joints], np.int64),
                "v_start": np.array([joint.v.start for joint in joints], np.int64),
                **{name: np.zeros(len(joints)) for name in ("angle", "cosine", "sine")},
                "q": poses.q,
                "delta_q": self._delta_q,
                "q_next": self._q_next,
            },
        )

    def integrate(self, delta_q: Array) -> Array:
        """Configuration q (+) delta_q, shape (n_q,)."""
        if not self._known:
            return self._system.integrate(self._q, delta_q)
        compiled = library()
        s = self.structure
        self._delta_q[:] = delta_q
        if not compiled.half_turns(s.pointer):
            for i in self._turning:
                s["cosine"][i], s["sine"][i] = cos_sin(float(s["angle"][i]) / 2)
        compiled.sums(s.pointer)
        return self._q_next.copy()
