"""The friction cone of a contact in the plane and its dual, with a sliding force and its motion.

A force of the cone does no negative work on a motion of the dual cone. Where the contact slides,
both lie on edges, at a right angle: the contact takes no energy.
"""

import numpy as np
from matplotlib.patches import Polygon

from docs.drawings.labels import label_axes
from docs.drawings.the_program import MU_V, point
from quasistatic_ref import solve_step
from quasistatic_ref.optional.show.figures import Figure, panels
from quasistatic_ref.optional.show.figures.style import scaled

PUSH = 6.0  # N: the block slides
LONG = 12.0  # of the cones' edges [N], [units of MOTION]
MOTION = 10e-6  # m


def main(push: float = PUSH) -> tuple[np.ndarray, np.ndarray]:
    """Force (f_1, f_n) [N] and motion (s_1, u_n) [m] of the pushed block in one step."""
    answer = solve_step(point(push))
    force, motion = answer.wrench[0, [0, 2]], answer.delta_q  # of x and z
    assert abs(force @ motion) < 1e-12  # J
    return force, motion


def figure(*, push: float = PUSH) -> Figure:
    """Left the forces, right the motions, in equal directions."""
    page, (left, right) = panels(6.3, 3.4, columns=2)
    force, motion = main(push)
    blue, orange = "#0072B2", "#D55E00"
    wide = [(0, 0), (-MU_V * LONG, LONG), (MU_V * LONG, LONG)]
    dual = [(0, 0), (-LONG, MU_V * LONG), (-LONG, LONG), (LONG, LONG), (LONG, MU_V * LONG)]
    left.add_patch(Polygon(wide, facecolor=blue, alpha=0.2))
    right.add_patch(Polygon(dual, facecolor=orange, alpha=0.2))
    look = {"arrowstyle": "-|>", "shrinkA": 0, "shrinkB": 0, "linewidth": scaled(2.4)}
    left.annotate("", force, (0, 0), arrowprops=look | {"color": blue})
    right.annotate("", motion / MOTION, (0, 0), arrowprops=look | {"color": orange})
    across = LONG * force / np.linalg.norm(force)
    right.plot([0, across[0]], [0, across[1]], color=blue, linestyle=":", linewidth=scaled(1.6))
    left.text(0, LONG - 1.2, r"$|f_1| \leq \mu_v f_n$", ha="center", va="top")
    right.text(2.5, LONG - 1.2, r"$u_n \geq \mu_v |s_1|$", ha="center", va="top")
    left.text(*(0.55 * force + [-0.6, 0]), "force of\nthe table", ha="right", va="center")
    right.text(1.5, -0.6, "motion of the block", va="top")
    right.text(*(0.62 * across + [-1.3, 0]), "direction of\nthe force", ha="right", va="center")
    for axes in (left, right):
        axes.set(xlim=(-LONG, LONG), ylim=(-3.5, LONG), aspect="equal")
        axes.axhline(0, color="0.5", linewidth=scaled(0.8))
        axes.grid(visible=False)
    label_axes(left, "$f_1$ [N]", "$f_n$ [N]", "friction cone")
    label_axes(right, "slip $s_1$ [10 µm]", "gap $u_n$ [10 µm]", "dual cone")
    return page
