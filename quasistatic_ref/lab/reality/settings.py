"""What pushes are predicted with."""

from dataclasses import asdict, dataclass
from typing import Any, Final

import numpy as np

from quasistatic_ref.errors import InputError
from quasistatic_ref.lab.reality.cloud import support_points
from quasistatic_ref.lab.reality.pairs import Pair
from quasistatic_ref.lab.reality.push import PATCH, Pushed
from quasistatic_ref.simulate.law import CONVEX
from quasistatic_ref.step.cones import ELLIPSOID, cone

ADVANCE: Final = 1e-3
"""Of the finger in a step [m]: about 40 steps a push."""

SLOWEST: Final = 0.05
"""Largest quasi-dynamic number [-]: the model's own drag is then 5 % of friction at most."""

NO_TORSION: Final = 1e-3
"""Ratio that stands for a support without torsional friction [m]: one of zero would leave how far
a body turns on a push through its centre to its inertia."""


@dataclass(frozen=True)
class Settings:
    """How pushes are predicted; every field is shown not to matter, or is an ablation.

    Parameters
    ----------
    cone : str
    torsion : float
        Times the identified mu_omega / mu_v [-]; with 0 it is ``NO_TORSION``.
    points : int
        Contacts of the support: 1, a patch with torsion; more, points without.
    axes : float
        Angle of d1 of the support from the world's x [deg].
    finger : str
        Friction of the finger: ``"used"``, ``"fitted"``, or a number.
    advance : float
        Of the finger in a step [m].
    nudge : tuple of float
        As of :class:`~quasistatic_ref.lab.reality.push.Pushed` [-].
    law : str
        As there.
    rise : float
        As there [-].
    m, gyration, mu_v, h, stiffness : float
        As there [kg], [m], [-], [s], [N/m]. They cancel in the quasi-static limit.
    """

    cone: str = ELLIPSOID
    torsion: float = 1.0
    points: int = 1
    axes: float = 0.0
    finger: str = "used"
    advance: float = ADVANCE
    nudge: tuple[float, float, float] = (0.0, 0.0, 0.0)
    m: float = 1.0
    gyration: float = 0.04
    mu_v: float = 0.3
    h: float = 0.5
    stiffness: float = 1e6
    rise: float = 1.0
    law: str = CONVEX

    def record(self) -> dict[str, Any]:
        """The same as plain data."""
        return asdict(self) | {"nudge": list(self.nudge)}

    def pushed(self, pair: Pair, ratio: float) -> Pushed:
        """The scene of a pair with an identified `ratio` mu_omega / mu_v [m].

        Raises
        ------
        InputError
            If there is no such cone, the pair has no such friction of the finger, or the
            quasi-dynamic number is too large.
        """
        cone(self.cone)
        radians = float(np.radians(self.axes))
        one = self.points == 1
        pushed = Pushed(
            pair.outline, pair.outline.centre, pair.radius, self.friction(pair),
            (ratio * self.torsion or NO_TORSION) if one else 0.0, self.cone,
            PATCH if one else support_points(pair.outline, self.points),
            self.advance, radians, self.nudge, self.m, self.gyration, self.mu_v, self.h,
            self.stiffness, self.rise, self.law,
        )  # fmt: skip
        if not pushed.quasi_dynamic_number <= SLOWEST:
            problem = f"makes the quasi-dynamic number more than {SLOWEST:g}; take a longer step"
            raise InputError(problem, field="h", value=self.h)
        return pushed

    def friction(self, pair: Pair) -> float:
        """Of the finger on the object [-].

        Raises
        ------
        InputError
            If it is to be the fitted one, and the pair has none.
        """
        if self.finger == "used":
            return pair.mu_finger
        if self.finger == "fitted":
            if pair.mu_fitted is None:
                raise InputError("has no mu_pusher_fitted", field=pair.name)
            return pair.mu_fitted
        return float(self.finger)
