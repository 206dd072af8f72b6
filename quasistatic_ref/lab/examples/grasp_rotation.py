"""How far the bunny of Figure 1 turns in the grip, with and without torsional friction."""

from typing import Any

import numpy as np

from quasistatic_ref.lab.examples.shared import Numbers
from quasistatic_ref.lab.figures.grasp import rotation_plot
from quasistatic_ref.lab.grasp import CASES, CLOSED
from quasistatic_ref.lab.runs import grasp, lift
from quasistatic_ref.optional.show.figures import Figure


def main() -> Numbers:
    """The largest rotation during the lift."""
    found: Numbers = {}
    for case in CASES:
        motion, steps = lift(case)
        angle = np.degrees(motion.rotation_since(CLOSED)[steps])
        found[f"rotation {case} [deg]"] = float(angle.max())
    return found


def figure(ax: Any = None, *, since: float = CLOSED) -> Figure:
    """Rotation against time.

    Parameters
    ----------
    ax : Axes or SubFigure, optional
        Where to draw; a figure of its own by default.
    since : float
        From when on [s].
    """
    runs = {case: grasp(case)[1] for case in CASES}
    return rotation_plot(grasp("with torsion")[0], runs, "bunny", since, ax)
