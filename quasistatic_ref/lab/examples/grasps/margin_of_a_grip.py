"""Rotation of the bunny against what its closed grip had to spare, for every grasp with torsion.

The margin of a grip is mu_omega over the one that holds the weight by (R14), which takes squeeze
and lever of the closed grip: 1 is the border. It is known before the lift.
"""

from typing import Any

import numpy as np

from quasistatic_ref.lab.clouds.rows import is_held, margin, rotations, rows, with_torsion
from quasistatic_ref.lab.clouds.study import NONE
from quasistatic_ref.lab.examples.shared import Numbers
from quasistatic_ref.lab.figures.labels import label_axes
from quasistatic_ref.optional.show.figures import Figure, panels, scaled

LEAST, WEAKEST = 0.01, 0.1
"""Smaller rotations [deg] and margins [-] are drawn there."""
CLEAR = 1.25
"""A margin above this, or below one over this, is clear."""


def main() -> Numbers:
    """Clear margins, and those of them whose grasp went otherwise; least of the held, and so on."""
    own = [row for row in rows() if with_torsion(row)]
    margins = np.array([margin(row) for row in own])
    kept = np.array([is_held(row) for row in own])
    strong = margins > CLEAR
    weak = margins < 1 / CLEAR
    return {
        f"grips with a margin above {CLEAR:g} [-]": float(strong.sum()),
        "of these not held [-]": float((strong & ~kept).sum()),
        f"grips with a margin below 1 / {CLEAR:g} [-]": float(weak.sum()),
        "of these held [-]": float((weak & kept).sum()),
        "grips between [-]": float((~strong & ~weak).sum()),
        "of these foretold [-]": float(((margins >= 1) == kept)[~strong & ~weak].sum()),
    }


def figure(ax: Any = None, *, clear: float = CLEAR) -> Figure:
    """Rotation against the margin.

    Parameters
    ----------
    ax : Axes or SubFigure, optional
        Where to draw; a figure of its own by default.
    clear : float
        The margin beyond which the shaded band ends [-].
    """
    page, (axes,) = panels(4.6, 2.8, within=ax)
    for label, mark, changed in (("the scene, any cloud", "o", False), ("changed", "+", True)):
        own = [row for row in rows() if with_torsion(row) and changed == (row["change"] != NONE)]
        margins = np.maximum([margin(row) for row in own], WEAKEST)
        axes.plot(margins, np.maximum(rotations(own), LEAST), mark, color="black",
                  markerfacecolor="none", markersize=scaled(3), label=label)  # fmt: skip
    axes.axvspan(1 / clear, clear, color="0.85", zorder=0)
    axes.axvline(1.0, color="black", linewidth=scaled(1))
    axes.set(xscale="log", yscale="log")
    label_axes(axes, r"margin: $\mu_\omega$ / needed by (R14) [-]", "rotation [deg]")
    return page
