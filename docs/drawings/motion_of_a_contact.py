"""The motion at a contact: the gap after the step, the slips along d1 and d2, the spin about n."""

import numpy as np
from matplotlib.patches import Ellipse, Polygon

from quasistatic_ref.optional.show.figures import Figure, panels
from quasistatic_ref.optional.show.figures.style import scaled

ASIDE = np.array([0.45, 0.28])
"""How d2, away from the reader, is drawn on the page."""
MOTIONS = {"$s_1$": np.array([1.5, 0.0]), "$s_2$": 2.1 * ASIDE, "$u_n$": np.array([0.0, 1.7])}


def face(origin: np.ndarray, along: np.ndarray, across: np.ndarray, colour: str) -> Polygon:
    """A parallelogram."""
    corners = [origin, origin + along, origin + along + across, origin + across]
    return Polygon(corners, facecolor=colour, edgecolor="0.4", linewidth=scaled(0.8))


def figure() -> Figure:
    """A block above a table, and the four numbers of its contact."""
    page, (axes,) = panels(5.0, 2.8)
    table = np.array([-3.2, -0.9])
    axes.add_patch(face(table, np.array([6.6, 0.0]), 6 * ASIDE, "0.93"))
    wide, high = np.array([1.6, 0.0]), np.array([0.0, 1.0])
    corner = np.array([-2.6, 0.35])
    for side in ((wide, high), (wide, 2 * ASIDE), (high, 2 * ASIDE)):
        start = corner + (high if side[0] is wide and side[1] is not high else 0)
        start = start + (wide if side[0] is high else 0)
        axes.add_patch(face(start, *side, "#BBD6EA"))
    axes.text(corner[0] + 0.8, corner[1] + 0.4, "second body", ha="center")
    axes.text(-2.9, -0.75, "first body", ha="left")
    foot = np.array([1.1, 0.1])
    look = {"arrowstyle": "-|>", "shrinkA": 0, "shrinkB": 0, "color": "#D55E00"}
    for name, arrow in MOTIONS.items():
        axes.annotate("", foot + arrow, foot, arrowprops=look | {"linewidth": scaled(2.2)})
        axes.text(*(foot + 1.15 * arrow), name, ha="center", va="center")
    blue = {"color": "#0072B2", "linewidth": scaled(2)}
    ring = (foot[0], foot[1] + 1.0)
    axes.add_patch(Ellipse(ring, 0.8, 0.32, fill=False, **blue))
    tip = np.add(ring, (0.12, -0.16))
    axes.annotate("", tip, np.subtract(tip, (0.08, 0.0)), arrowprops=look | blue)
    axes.text(foot[0] - 0.55, foot[1] + 1.05, r"$\omega$", ha="right", va="center")
    axes.plot(*foot, "o", color="black", markersize=scaled(4))
    axes.set(xlim=(-3.4, 5.6), ylim=(-1.1, 2.3), aspect="equal")
    axes.set_axis_off()
    return page
