"""A body that moves freely: q holds x, y, z and a quaternion [x y z w], delta_q a twist."""

import pinocchio as pin

from quasistatic_ref.model import screw
from quasistatic_ref.model.joints.joint import QUATERNION
from quasistatic_ref.model.joints.twist_joint import TwistJoint
from quasistatic_ref.model.rotation import quaternion
from quasistatic_ref.model.screw import Vector
from quasistatic_ref.numbers.angles import Number
from quasistatic_ref.numbers.arrays import Array


class Floating(TwistJoint):
    """A floating base: q (+) delta_q = q exp6(delta_q)."""

    twist = (0, 1, 2, 3, 4, 5)
    entries = ("x", "y", "z", "qx", "qy", "qz", "qw")
    pinocchio = pin.JointModelFreeFlyer
    lengths = 3
    unit_vector = QUATERNION
    free = True

    @classmethod
    def at(cls, xyz: Array, rpy: Array) -> list[float]:
        """The joint's entries of q at a pose."""
        return [*xyz.tolist(), *quaternion(rpy).tolist()]

    def integrated(self, q: Vector, delta_q: Vector) -> list[Number]:
        """The joint's entries of q (+) delta_q."""
        v, w = delta_q[:3], delta_q[3:]
        half = screw.half_turn(w)
        t = screw.translation(v, w, half)
        return [*screw.carried(q[:3], screw.rows(q[3:]), t), *screw.turned(q[3:], w, half)]

    def change(self, q: Vector, q_next: Vector) -> list[Number]:
        """The joint's entries of q_next (-) q."""
        apart = [b - a for a, b in zip(q[:3], q_next[:3], strict=True)]
        w, a, c2 = screw.rotation_between(q[3:], q_next[3:])
        return [*screw.combined(screw.along(screw.rows(q[3:]), apart), w, a, -0.5, c2), *w]
