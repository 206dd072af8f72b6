"""How far the bunny of Figure 1 turns, for 480 clouds of the same bunny.

What is drawn is the committed study of clouds: four ways of drawing points, four numbers of them,
30 clouds each. Without torsional friction the angle depends on the cloud; with it, it does not,
if mu_omega is what the closed grip needs by (R14).
"""

from typing import Any

import numpy as np

from quasistatic_ref.lab.clouds.rows import (
    is_held,
    margin,
    rotations,
    rows,
    rows_with,
    with_torsion,
)
from quasistatic_ref.lab.clouds.study import NONE, grid
from quasistatic_ref.lab.examples.shared import Numbers
from quasistatic_ref.lab.figures.labels import label_axes, legend_below
from quasistatic_ref.optional.show.figures import Figure, panels, scaled

LEAST = 0.01
"""Smaller rotations are drawn there [deg]."""
MARKS = {"with torsion": ("o", "black"), "without torsion": ("x", "0.5")}


def main() -> Numbers:
    """Who was held, and whether the closed grip foretold it."""
    found: Numbers = {}
    scene = [row for row in rows() if row["change"] == NONE]
    for case in MARKS:
        own = [row for row in scene if with_torsion(row) == (case == "with torsion")]
        found[f"clouds held {case} [-]"] = float(sum(map(is_held, own)))
        found[f"clouds {case} [-]"] = float(len(own))
    right = sum(is_held(row) == (margin(row) >= 1.0) for row in rows())
    found["grasps foretold [-]"] = float(right)
    return found | {"grasps [-]": float(len(rows()))}


def figure(ax: Any = None, *, seed: int = 0) -> Figure:
    """Rotation against the number of points, one panel for each way of drawing them.

    Parameters
    ----------
    ax : Axes or SubFigure, optional
        Where to draw; a figure of its own by default.
    seed : int
        Of the sideways shifts that keep marks apart.
    """
    density = grid()["density"]
    page, grid_of_axes = panels(6.3, 2.6, len(density["samplings"]), within=ax, narrow=0,
                                sharey=True)  # fmt: skip
    rng = np.random.default_rng(seed)
    for axes, sampling in zip(grid_of_axes, density["samplings"], strict=True):
        for case, (mark, colour) in MARKS.items():
            for place, count in enumerate(density["counts"]):
                own = [
                    row for row in rows_with(sampling=sampling, count=count, change=NONE)
                    if with_torsion(row) == (case == "with torsion")
                ]  # fmt: skip
                x = place + (0.15 if mark == "x" else -0.15) + rng.uniform(-0.1, 0.1, len(own))
                axes.plot(x, np.maximum(rotations(own), LEAST), mark, color=colour,
                          markersize=scaled(2.5), label=None if place else case)  # fmt: skip
        axes.set_yscale("log")
        axes.set_xticks(range(4), [f"{count:,}" for count in density["counts"]], rotation=60)
        label_axes(
            axes, "points [-]", "" if axes is not grid_of_axes[0] else "rotation [deg]", key=False
        )
        axes.set_title(sampling)
    legend_below(grid_of_axes, grid_of_axes[0].get_legend_handles_labels()[0])
    return page
