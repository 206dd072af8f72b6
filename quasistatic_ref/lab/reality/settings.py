"""What pushes are predicted with."""

from dataclasses import asdict, dataclass
from typing import Any

from quasistatic_ref.lab.made_steps.contacts import GRAVITY
from quasistatic_ref.simulate.law import CONVEX
from quasistatic_ref.step.cones import ELLIPSOID

ADVANCE = 1e-3
"""Of the finger in a step [m]: about 40 steps a push."""


@dataclass(frozen=True)
class Settings:
    """How pushes are predicted; every field has a default.

    Parameters
    ----------
    cone : str
    advance : float
        Of the finger in a step [m].
    m, gyration, mu_v, h, stiffness : float
        Mass [kg] and radius of gyration [m] of the body, friction of the support [-], time step
        [s], of the finger [N/m]. They cancel in the quasi-static limit.
    law : str
        ``"convex"``, or ``"coulomb"`` for steps without a rise.
    """

    cone: str = ELLIPSOID
    advance: float = ADVANCE
    m: float = 1.0
    gyration: float = 0.04
    mu_v: float = 0.3
    h: float = 0.5
    stiffness: float = 1e6
    law: str = CONVEX

    @property
    def quasi_dynamic_number(self) -> float:
        """Pi = v / (mu_v g h) of a body that goes as fast as the finger [-]."""
        return self.advance / (self.mu_v * GRAVITY * self.h**2)

    def record(self) -> dict[str, Any]:
        """The settings as plain data."""
        return asdict(self)
