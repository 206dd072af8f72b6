"""The forces on a block that is pushed with 3 and with 6 N: weight, push, contact, and its cone."""

import numpy as np
from matplotlib.lines import Line2D
from matplotlib.patches import Polygon, Rectangle

from docs.drawings.labels import label_axes, legend_below
from docs.drawings.the_program import GRAVITY, MASS, MU_V, point
from quasistatic_ref import solve_step
from quasistatic_ref.optional.show.figures import panels
from quasistatic_ref.optional.show.figures.style import scaled

PUSHES = (3.0, 6.0)  # N: one that is held, one that is not
STYLES = {
    "weight": {"color": "0.3", "linewidth": 1.6},
    "push": {"color": "#D55E00", "linewidth": 1.6, "linestyle": (0, (3, 1))},
    "contact": {"color": "#0072B2", "linewidth": 3.0},
    "resultant": {"color": "#CC79A7", "linewidth": 1.6, "linestyle": (0, (1, 1))},
}


def main(pushes=PUSHES):
    """For each push the force of the table, (along the push, up), shape (pushes, 2) [N]."""
    return np.array([solve_step(point(push)).wrench[0, [0, 2]] for push in pushes])


def figure(*, pushes=PUSHES):
    """One panel a push: the block, the forces at one point, the cone and the resultant."""
    made, row = panels(6.3, 3.3, columns=len(pushes), sharey=True)
    for axes, push, force in zip(row, pushes, main(pushes), strict=True):
        axes.add_patch(Rectangle((-5, 0), 10, 8, facecolor="0.93", edgecolor="0.7", zorder=0))
        axes.axhline(0.0, color="0.3", linewidth=scaled(1.2))
        f_n = force[1]
        cone = [(0, 0), (-MU_V * f_n, f_n), (MU_V * f_n, f_n)]
        axes.add_patch(Polygon(cone, facecolor=STYLES["contact"]["color"], alpha=0.2))
        weight, pushed = np.array([0.0, -MASS * GRAVITY]), np.array([push, 0.0])
        forces = {"weight": weight, "push": pushed, "contact": force}
        resultant = weight + pushed + force
        if np.hypot(*resultant) > 1e-9:  # N; zero but for rounding where the block is held
            forces["resultant"] = 5 * resultant
        for name, arrow in forces.items():
            style = STYLES[name] | {"linewidth": scaled(STYLES[name]["linewidth"])}
            look = {"arrowstyle": "-|>", "shrinkA": 0, "shrinkB": 0, **style}
            axes.annotate("", arrow, (0, 0), arrowprops=look)
        axes.set(xlim=(-8, 8), ylim=(-11, 12), aspect="equal")
        axes.grid(visible=False)
        held = "no resultant: it stays" if "resultant" not in forces else "it slides and rises"
        label_axes(axes, "force along the push [N]", "force up [N]", f"{push:g} N, {held}")
        axes.label_outer(remove_inner_ticks=True)
    handles = [
        Line2D([], [], label=name, **style | {"linewidth": scaled(style["linewidth"])})
        for name, style in STYLES.items()
    ]
    handles[-1].set_label("5 x resultant")
    legend_below(row, handles, "shaded: the friction cone at the normal force of the contact")
    return made
