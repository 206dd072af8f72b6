"""q (+) delta_q and q_a (-) q in C, if it knows every joint.

Sines and angles that C cannot decide are Python's.
"""

import numpy as np
from numpy.typing import ArrayLike

from quasistatic_ref.errors import ModelError
from quasistatic_ref.model.joints.axis_joint import Prismatic, Revolute
from quasistatic_ref.model.joints.continuous import Continuous
from quasistatic_ref.model.joints.floating import Floating
from quasistatic_ref.model.joints.planar import Planar
from quasistatic_ref.model.system import System
from quasistatic_ref.numbers.angles import cos_sin
from quasistatic_ref.numbers.arrays import Array, with_shape
from quasistatic_ref.optional.compiled.library import Structure, library
from quasistatic_ref.optional.fast.poses import Poses

KINDS: dict[type, int] = {Floating: 0, Planar: 1, Continuous: 2, Revolute: 3, Prismatic: 3}
"""Numbers of joints in screws.c."""


class Sums:
    """Sums and differences of the configurations of a system.

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
        self._known = all(type(joint) in KINDS for joint in joints)
        kinds = [KINDS.get(type(joint), -1) for joint in joints]
        self.structure = Structure(
            "Sums",
            {
                "joints": len(joints),
                "kind": np.array(kinds, np.int64),
                "q_start": np.array([joint.q.start for joint in joints], np.int64),
                "v_start": np.array([joint.v.start for joint in joints], np.int64),
                **{name: np.zeros(len(joints)) for name in ("angle", "cosine", "sine")},
                "q": poses.q,
                "delta_q": np.zeros(system.n_v),
                "q_next": np.zeros(system.n_q),
                "actuated": sum(joint.actuated for joint in joints),
                "here": np.zeros(system.n_q),
                "target": np.zeros(system.n_q_a),
                "delta_q_bar_a": np.zeros(system.n_a),
            },
        )

    def integrate(self, delta_q: Array) -> Array:
        """Configuration q (+) delta_q, shape (n_q,)."""
        if not self._known:
            return self._system.integrate(self._q, delta_q)
        compiled = library()
        s = self.structure
        s["delta_q"][:] = delta_q
        if not compiled.half_turns(s.pointer):
            for i in np.flatnonzero(np.isnan(s["cosine"])).tolist():
                s["cosine"][i], s["sine"][i] = cos_sin(float(s["angle"][i]) / 2)
        compiled.sums(s.pointer)
        return s["q_next"].copy()

    def actuated_difference(self, q: ArrayLike, q_a: ArrayLike) -> Array:
        """Change q_a (-) q of the actuated coordinates, shape (n_a,); errors as of the system's."""
        if self._known:
            s = self.structure
            s["here"][:] = with_shape(q, "q", s["here"].shape, ModelError)
            s["target"][:] = with_shape(q_a, "q_a", s["target"].shape, ModelError)
            if library().differences(s.pointer):
                return s["delta_q_bar_a"] + 0.0
        return self._system.actuated_difference(q, q_a) + 0.0
