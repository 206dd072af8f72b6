"""A joint that turns about its axis as often as it likes: q holds cos and sin of its angle."""

from typing import Any

import pinocchio as pin

from quasistatic_ref.model import screw
from quasistatic_ref.model.joints.axis_joint import AxisJoint
from quasistatic_ref.model.joints.joint import COSINE_SINE, Position
from quasistatic_ref.model.screw import Vector
from quasistatic_ref.numbers.angles import Number, cos_sin
from quasistatic_ref.numbers.arrays import Array


def _wheel(axis: Array) -> Any:
    """Pinocchio's unbounded revolute joint about a unit vector, made of a URDF text."""
    xyz = " ".join(map(repr, axis.tolist()))
    text = (
        '<robot name="r"><link name="a"/><link name="b"/><joint name="j" type="continuous">'
        f'<parent link="a"/><child link="b"/><axis xyz="{xyz}"/></joint></robot>'
    )
    return pin.buildModelFromXML(text).joints[1]


class Continuous(AxisJoint):
    """A joint that turns without limits; q holds the cosine and sine of its angle."""

    pinocchio = (pin.JointModelRUBX, pin.JointModelRUBY, pin.JointModelRUBZ, _wheel)
    unit_vector = COSINE_SINE

    @property
    def positions(self) -> tuple[Position, ...]:
        """The joint's entries of q."""
        return Position(f"{self.name}.cos", "-"), Position(f"{self.name}.sin", "-")

    @classmethod
    def at(cls, position: float) -> list[float]:
        """The joint's entries of q at a position, which is an angle [rad]."""
        return [*cos_sin(position)]

    def integrated(self, q: Vector, delta_q: Vector) -> list[Number]:
        """The joint's entries of q (+) delta_q."""
        return screw.heading(q, delta_q[0])

    def change(self, q: Vector, q_next: Vector) -> list[Number]:
        """The joint's entry of q_next (-) q."""
        return [screw.turn_between(q, q_next)]
