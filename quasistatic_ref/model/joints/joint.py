"""What every kind of joint knows of itself; nothing else asks which kind a joint is."""

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import ClassVar, NamedTuple

from quasistatic_ref.model.screw import Vector
from quasistatic_ref.numbers.angles import Number
from quasistatic_ref.quoting import clipped, counted
from quasistatic_ref.text.plain import Plain

QUATERNION = "quaternion"
COSINE_SINE = "(cos, sin)"


@dataclass(frozen=True)
class Coordinate:
    """One entry of delta_q.

    Parameters
    ----------
    name : str
        ``gripper/width``, or ``gripper/base.x`` .. ``gripper/base.rz``.
    joint : str
        Its joint, e.g. ``gripper/base``.
    unit : str
        ``"m"`` or ``"rad"``.
    actuated : bool
    """

    name: str
    joint: str
    unit: str
    actuated: bool


class Position(NamedTuple):
    """One entry of q.

    Parameters
    ----------
    name : str
        ``arm/elbow``, ``arm/wheel.cos``, ``mug.z``.
    unit : str
        ``"m"``, ``"rad"`` or ``"-"``.
    """

    name: str
    unit: str

    @property
    def heading(self) -> str:
        """The heading of this entry in tables and files: ``arm/elbow [rad]``."""
        return f"{self.name} [{self.unit}]"


@dataclass(frozen=True, eq=False, repr=False)
class Joint(Plain, ABC):
    """One joint with coordinates of its own.

    Parameters
    ----------
    name : str
    actuated : bool
    q, v : slice
        Its entries of q and of delta_q: lengths first.
    limits : tuple of float, optional
        Least and greatest position that its URDF allows [m, rad], which the model ignores. None
        where the URDF gives none or the lower is above the upper one, and for bases and joints
        whose position is no number. Both may be 0, which hold it.
    effort : float
        Largest force that its URDF allows [N, N m], which the model ignores; infinity where the
        URDF gives none or 0.

    Attributes
    ----------
    lengths : int
        How many of its entries of q, and of delta_q, are lengths.
    unit_vector : str or None
        What its other entries of q are called if they are a vector of length one.
    free : bool
        Whether nothing guides the link that it moves.

    Examples
    --------
    >>> joints: list[qr.Joint] = [*qr.load_scenario("two_finger_pinch").system.joints]
    >>> joints[0].name, joints[0].q
    ('near/close_left', slice(0, 1, None))
    """

    name: str
    actuated: bool
    q: slice
    v: slice
    limits: tuple[float, float] | None = None
    effort: float = math.inf

    lengths: ClassVar[int]
    unit_vector: ClassVar[str | None] = None
    free: ClassVar[bool] = False

    def __repr__(self) -> str:
        driven = "actuated, " if self.actuated else ""
        count = counted(self.v.stop - self.v.start, "coordinate")
        return f"<{type(self).__name__} {clipped(self.name)}: {driven}{count}>"

    @property
    @abstractmethod
    def coordinates(self) -> tuple[Coordinate, ...]:
        """The joint's entries of delta_q."""

    @property
    @abstractmethod
    def positions(self) -> tuple[Position, ...]:
        """The joint's entries of q."""

    @property
    def unit_part(self) -> slice:
        """Where in q the entries stand whose length is one."""
        return slice(self.q.start + self.lengths, self.q.stop)

    @classmethod
    @abstractmethod
    def neutral(cls) -> list[float]:
        """The joint's entries of q at position zero [m, rad, -]."""

    @abstractmethod
    def integrated(self, q: Vector, delta_q: Vector) -> list[Number]:
        """The joint's entries of q (+) delta_q, from its entries of both [m, rad, -].

        Entries may be arrays, of many joints of a kind or of many changes: each by itself.
        """

    @abstractmethod
    def change(self, q: Vector, q_next: Vector) -> list[Number]:
        """The joint's entries of q_next (-) q, from its entries of both, as above [m, rad]."""
