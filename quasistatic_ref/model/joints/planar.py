"""A body that stays upright at its height: q holds x, y, cos and sin of its angle."""

import pinocchio as pin

from quasistatic_ref.model import screw
from quasistatic_ref.model.joints.joint import COSINE_SINE
from quasistatic_ref.model.joints.twist_joint import TwistJoint
from quasistatic_ref.model.screw import Vector
from quasistatic_ref.numbers.angles import Number, cos_sin
from quasistatic_ref.numbers.arrays import Array


class Planar(TwistJoint):
    """A planar base: delta_q is x and y along the body's own axes, and the angle."""

    twist = (0, 1, 5)
    entries = ("x", "y", "cos", "sin")
    pinocchio = pin.JointModelPlanar
    lengths = 2
    unit_vector = COSINE_SINE

    @classmethod
    def at(cls, xyz: Array, rpy: Array) -> list[float]:
        """The joint's entries of q at a pose."""
        return [*xyz[:2].tolist(), *cos_sin(float(rpy[2]))]

    def integrated(self, q: Vector, delta_q: Vector) -> list[Number]:
        """The joint's entries of q (+) delta_q."""
        x, y, angle = delta_q
        w = [0.0, 0.0, angle]
        t = screw.translation([x, y, 0.0], w, screw.half_turn(w))
        return [*screw.carried([*q[:2], 0.0], _rows(q), t)[:2], *screw.heading(q[2:], angle)]

    def change(self, q: Vector, q_next: Vector) -> list[Number]:
        """The joint's entries of q_next (-) q."""
        apart = screw.along(_rows(q), [q_next[0] - q[0], q_next[1] - q[1], 0.0])
        angle = screw.turn_between(q[2:], q_next[2:])
        return [*screw.linear_part(apart, [0.0, 0.0, angle])[:2], angle]


def _rows(q: Vector) -> list[list[Number]]:
    """Rows of its rotation matrix."""
    c, s = q[2:]
    return [[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]]
