"""A joint that turns about a point, about any axis: q holds a quaternion [x y z w]."""

import pinocchio as pin

from quasistatic_ref.model import screw
from quasistatic_ref.model.joints.joint import QUATERNION
from quasistatic_ref.model.joints.twist_joint import TwistJoint
from quasistatic_ref.model.rotation import quaternion
from quasistatic_ref.model.screw import Vector
from quasistatic_ref.numbers.angles import Number
from quasistatic_ref.numbers.arrays import Array


class Ball(TwistJoint):
    """A ball joint: delta_q is a rotation vector in the frame of the link that it moves."""

    twist = (3, 4, 5)
    entries = ("qx", "qy", "qz", "qw")
    pinocchio = pin.JointModelSpherical
    lengths = 0
    unit_vector = QUATERNION

    @classmethod
    def at(cls, xyz: Array, rpy: Array) -> list[float]:
        """The joint's entries of q at a pose."""
        return [*quaternion(rpy).tolist()]

    def integrated(self, q: Vector, delta_q: Vector) -> list[Number]:
        """The joint's entries of q (+) delta_q."""
        return screw.turned(q, delta_q, screw.half_turn(delta_q))

    def change(self, q: Vector, q_next: Vector) -> list[Number]:
        """The joint's entries of q_next (-) q."""
        return screw.rotation_between(q, q_next)[0]
