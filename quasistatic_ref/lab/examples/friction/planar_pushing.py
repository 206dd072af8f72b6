"""A slider pushed on the plane: it moves along the normal of its limit surface.

Lynch, Maekawa and Tanie's law says how a slider turns that is pushed off its centre, infinitely
slowly. Under the ellipsoid a step agrees with it while the quasi-dynamic number Pi is small, and
when the slider's radius of gyration rho is c = mu_omega / mu_v, at any speed.
"""

from collections.abc import Sequence
from functools import cache
from typing import Any

import numpy as np

from quasistatic_ref.lab.examples.shared import Numbers
from quasistatic_ref.lab.figures.validation import PICTURES
from quasistatic_ref.lab.scenes.slider import GYRATION, RADII, SPEEDS, H, turns
from quasistatic_ref.optional.show.figures import Figure
from quasistatic_ref.step.data import Array


@cache
def ratios(radii: tuple[float, ...] = RADII) -> dict[float, Array]:
    """Turn over that of Lynch's law at each speed, shape (N,), for `radii` mu_omega / mu_v [m]."""
    return {c: np.array(turns(c)) for c in radii}


def main() -> Numbers:
    """The ratio at the slowest and at the fastest push, and the fastest by (R28)."""
    found: Numbers = {}
    for c, ratio in ratios().items():
        law = (1 + SPEEDS[-1]) / (1 + SPEEDS[-1] * (GYRATION / c) ** 2)
        found[f"turn over Lynch's, c = {1e3 * c:g} mm, Pi = {SPEEDS[0]:g} [-]"] = ratio[0]
        found[f"turn over Lynch's, c = {1e3 * c:g} mm, Pi = {SPEEDS[-1]:g} [-]"] = ratio[-1]
        found[f"(R28), c = {1e3 * c:g} mm, Pi = {SPEEDS[-1]:g} [-]"] = law
    return found


def figure(ax: Any = None, *, radii: Sequence[float] = RADII) -> Figure:
    """Steps as marks, (R28) as lines.

    Parameters
    ----------
    ax : Axes or SubFigure, optional
        Where to draw; a figure of its own by default.
    radii : sequence of float
        Up to four c = mu_omega / mu_v [m].
    """
    picture = {"Pi": SPEEDS, "turns": ratios(tuple(radii)), "rho": GYRATION, "h": H}
    return PICTURES["planar_push"](picture, ax)
