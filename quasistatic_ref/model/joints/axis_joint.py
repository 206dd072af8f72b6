"""Joints with one axis: along it or about it, by one number."""

from collections.abc import Callable
from typing import Any, ClassVar

import numpy as np
import pinocchio as pin

from quasistatic_ref.model.joints.joint import Coordinate, Joint, Position
from quasistatic_ref.model.screw import Vector
from quasistatic_ref.numbers.angles import Number
from quasistatic_ref.numbers.arrays import Array


class AxisJoint(Joint):
    """A joint with one coordinate, whose position is the sum of its changes.

    Attributes
    ----------
    measure : str
        The unit of its coordinate, ``"m"`` or ``"rad"``.
    pinocchio : tuple of callable
        The joint's classes in pinocchio: along x, y and z, and along any unit vector.
    """

    measure: ClassVar[str] = "rad"
    pinocchio: ClassVar[tuple[Callable[..., Any], ...]] = (
        pin.JointModelRX,
        pin.JointModelRY,
        pin.JointModelRZ,
        pin.JointModelRevoluteUnaligned,
    )
    lengths = 0

    @property
    def coordinates(self) -> tuple[Coordinate, ...]:
        """The joint's one entry of delta_q."""
        return (Coordinate(self.name, self.name, self.measure, self.actuated),)

    @property
    def positions(self) -> tuple[Position, ...]:
        """The joint's one entry of q."""
        return (Position(self.name, self.measure),)

    @classmethod
    def model(cls, axis: Array) -> Any:
        """The joint in pinocchio, about or along a unit vector, shape (3,) [-]."""
        for direction, made in zip(np.eye(3), cls.pinocchio, strict=False):
            if (axis == direction).all():
                return made()
        return cls.pinocchio[-1](axis)

    @classmethod
    def at(cls, position: float) -> list[float]:
        """The joint's entries of q at a position [m, rad]."""
        return [position]

    @classmethod
    def neutral(cls) -> list[float]:
        """The joint's entries of q at position zero."""
        return cls.at(0.0)

    def integrated(self, q: Vector, delta_q: Vector) -> list[Number]:
        """The joint's entries of q (+) delta_q."""
        return [q[0] + delta_q[0]]

    def change(self, q: Vector, q_next: Vector) -> list[Number]:
        """The joint's entry of q_next (-) q."""
        return [q_next[0] - q[0]]


class Revolute(AxisJoint):
    """A joint that turns about its axis, between limits."""


class Prismatic(AxisJoint):
    """A joint that slides along its axis."""

    pinocchio = (
        pin.JointModelPX,
        pin.JointModelPY,
        pin.JointModelPZ,
        pin.JointModelPrismaticUnaligned,
    )
    measure = "m"
    lengths = 1
