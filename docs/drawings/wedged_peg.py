"""A peg in its hole: it wedges if each contact lies in the friction cone of the other, (R17)."""

import numpy as np
from matplotlib.patches import Polygon, Rectangle

from docs.drawings.labels import label_axes
from quasistatic_ref import solve_step
from quasistatic_ref.lab.claims.jams import pushed_peg
from quasistatic_ref.optional.show.figures import Figure, panels
from quasistatic_ref.optional.show.figures.style import scaled

WIDTH, MU = 0.02, 0.5  # m, -
DEPTHS = (0.006, 0.018)  # m; the limit is MU WIDTH = 0.01
LEFT, RIGHT = "#0072B2", "#E69F00"
LINE = {"arrowstyle": "<|-|>", "shrinkA": 0, "shrinkB": 0}
"""A dimension line."""


def wedged(depth: float) -> bool:
    """Whether a push of 10 N leaves the peg where it is."""
    return not solve_step(pushed_peg(depth, WIDTH, MU, 10.0)).delta_q.any()


def figure() -> Figure:
    """One panel a depth: hole, peg, both friction cones and the line through the contacts."""
    page, row = panels(6.3, 3.3, columns=2, sharey=True)
    d = 1e3 * WIDTH
    for axes, depth in zip(row, DEPTHS, strict=True):
        assert wedged(depth) == (depth < MU * WIDTH)
        depth_mm = 1e3 * depth
        for left in (-30, d / 2):
            axes.add_patch(Rectangle((left, depth_mm / 2 - 40), 30 - d / 2, 40, facecolor="0.75"))
        axes.add_patch(Rectangle((-d / 2, -depth_mm / 2), d, 40, facecolor="0.93", edgecolor="0.3"))
        for side, colour in ((-1, LEFT), (1, RIGHT)):
            tip = np.array([side * d / 2, -side * depth_mm / 2])
            edges = [tip + 1.2 * d * np.array([-side, way * MU]) for way in (-1, 1)]
            axes.add_patch(Polygon([tip, *edges], color=colour, alpha=0.3, linewidth=0))
            axes.plot(*tip, "o", color=colour, markersize=scaled(6))
        line = np.array([[-d / 2, depth_mm / 2], [d / 2, -depth_mm / 2]])
        axes.plot(*line.T, color="black", linestyle="--", linewidth=scaled(1.2))
        axes.annotate(
            "", (0, 18), (0, 27), arrowprops={"arrowstyle": "-|>", "linewidth": scaled(2)}
        )
        axes.text(1, 23, "F")
        axes.annotate("", (-d / 2, -18), (d / 2, -18), arrowprops=LINE)
        axes.text(0, -17, "d", ha="center", va="bottom")
        axes.annotate("", (-d / 2 - 4, depth_mm / 2), (-d / 2 - 4, -depth_mm / 2), arrowprops=LINE)
        axes.text(-d / 2 - 5.5, 0, "l", ha="right", va="center")
        axes.set(xlim=(-26, 26), ylim=(-22, 30), aspect="equal")
        axes.grid(visible=False)
        words = "l < $\\mu$ d: wedged" if wedged(depth) else "l > $\\mu$ d: it goes in, and turns"
        label_axes(axes, "x [mm]", "z [mm]", words)
        axes.label_outer()
    return page
