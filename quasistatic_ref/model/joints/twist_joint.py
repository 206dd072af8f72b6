"""Joints with several coordinates: entries of the twist of the link that they move."""

from abc import abstractmethod
from typing import Any, ClassVar

import numpy as np

from quasistatic_ref.model.joints.joint import Coordinate, Joint, Position
from quasistatic_ref.numbers.arrays import Array

TWIST = (("x", "m"), ("y", "m"), ("z", "m"), ("rx", "rad"), ("ry", "rad"), ("rz", "rad"))
"""Entries of a twist, and their units."""


class TwistJoint(Joint):
    """A joint whose entries of delta_q are some of a twist in the moved link's own frame.

    Attributes
    ----------
    twist : tuple of int
        Which entries, in ascending order: 0-2 linear, 3-5 angular.
    entries : tuple of str
        What its entries of q are called.
    pinocchio : type
        The joint's class in pinocchio.
    """

    twist: ClassVar[tuple[int, ...]]
    entries: ClassVar[tuple[str, ...]]
    pinocchio: ClassVar[type]

    @classmethod
    def model(cls, axis: Array) -> Any:
        """The joint in pinocchio, for which an axis says nothing."""
        return cls.pinocchio()

    @property
    def coordinates(self) -> tuple[Coordinate, ...]:
        """The joint's entries of delta_q."""
        return tuple(
            Coordinate(f"{self.name}.{axis}", self.name, unit, self.actuated)
            for axis, unit in (TWIST[i] for i in self.twist)
        )

    @property
    def positions(self) -> tuple[Position, ...]:
        """The joint's entries of q, lengths before angles."""
        owner = self.name.removesuffix("/base")
        units = ["m"] * self.lengths + ["-"] * (len(self.entries) - self.lengths)
        named = zip(self.entries, units, strict=True)
        return tuple(Position(f"{owner}.{entry}", unit) for entry, unit in named)

    @classmethod
    @abstractmethod
    def at(cls, xyz: Array, rpy: Array) -> list[float]:
        """The joint's entries of q at an origin [m] and roll, pitch, yaw [rad], shapes (3,)."""

    @classmethod
    def neutral(cls) -> list[float]:
        """The joint's entries of q at the origin, without a turn."""
        return cls.at(np.zeros(3), np.zeros(3))

    @classmethod
    def obstacle(cls, xyz: Array, rpy: Array, start: Array) -> str | None:
        """Why the joint cannot reach a pose from the origin `start` (3,) [m]; None if it can."""
        way = [*(xyz - start), *rpy]
        if all(i in cls.twist or part == 0 for i, part in enumerate(way)):
            return None
        held = ", ".join(axis for i, (axis, _) in enumerate(TWIST) if i not in cls.twist)
        return (
            f"moves or turns by {held}, which this joint cannot; place shapes so in the URDF, or "
            'take base = "floating"'
        )
