"""Coulomb's law as pictures: Signorini's corner, and the friction that takes most from a slip."""

import numpy as np
from matplotlib.patches import Polygon

from docs.drawings.labels import label_axes
from quasistatic_ref.optional.show.figures import Figure, panels
from quasistatic_ref.optional.show.figures.style import scaled

ANGLE = np.radians(25)
"""Of the slip from d1."""


def strongest(slip: np.ndarray) -> np.ndarray:
    """The corner of the diamond |f_1| + |f_2| <= 1 that does the most negative work on a slip."""
    corners = np.array([[1, 0], [0, 1], [-1, 0], [0, -1]])
    return corners[np.argmin(corners @ slip)]


def figure() -> Figure:
    """Left, the gaps and forces that Signorini allows. Right, the friction for one slip."""
    page, (signorini, diamond) = panels(6.3, 3.1, columns=2)
    pen = {"color": "#0072B2", "linewidth": scaled(4), "solid_capstyle": "butt"}
    signorini.plot([0, 0, 1], [1, 0, 0], **pen)
    signorini.text(0.06, 0.75, "it presses,\nthe gap is zero")
    signorini.text(0.3, 0.07, "a gap, and no force")
    signorini.set(xlim=(-0.1, 1), ylim=(-0.1, 1), xticks=[0], yticks=[0])
    label_axes(signorini, "gap after the step $u_n$", "normal force $f_n$")

    diamond.add_patch(Polygon([[1, 0], [0, 1], [-1, 0], [0, -1]], color="#0072B2", alpha=0.15))
    slip = np.array([np.cos(ANGLE), np.sin(ANGLE)])
    corner = strongest(slip)
    along = np.array([-slip[1], slip[0]])
    level = np.array([corner - 0.75 * along, corner + 0.75 * along])
    diamond.plot(*level.T, color="0.4", linestyle="--", linewidth=scaled(1))
    look = {"arrowstyle": "-|>", "shrinkA": 0, "shrinkB": 0, "linewidth": scaled(2)}
    for tip, colour in ((0.8 * slip, "#D55E00"), (corner, "#0072B2")):
        diamond.annotate("", tip, (0, 0), arrowprops=look | {"color": colour})
    diamond.text(*(0.85 * slip), "slip", color="#D55E00", va="bottom")
    diamond.text(-0.5, 0.06, "friction", color="#0072B2", ha="center")
    diamond.text(*(level[1] + [0.05, 0.05]), "equal work", color="0.4")
    diamond.set(xlim=(-1.5, 1.5), ylim=(-1.15, 1.15), aspect="equal")
    ticks, names = [-1, 0, 1], [r"$-\mu_vf_n$", "0", r"$\mu_vf_n$"]
    diamond.set_xticks(ticks, names)
    diamond.set_yticks(ticks, names)
    label_axes(diamond, "friction along d1", "friction along d2")
    return page
