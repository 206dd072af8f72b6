"""The four ways in which a contact yields, if it has a compliance c: along n, d1, d2 and about n.

Yields along d1 and d2 are of the slips times mu_v, the yield about n is of the spin times mu_omega.
"""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Circle, Rectangle

from quasistatic_ref.optional.show.figures import Figure, panels
from quasistatic_ref.optional.show.figures.style import scaled

BODY, YIELD = "#E69F00", "#D55E00"


def _spring(axes: Axes, start: tuple[float, float], end: tuple[float, float]) -> None:
    """A coiled spring from one place to another."""
    ends = np.array([start, end])
    share = np.linspace(0, 1, 160)
    along = ends[1] - ends[0]
    across = np.array([-along[1], along[0]]) / np.hypot(*along)
    coils = 0.22 * np.sin(10 * np.pi * share) * (np.abs(share - 0.5) < 0.4)
    axes.plot(*(ends[0] + share[:, None] * along + coils[:, None] * across).T, "-", color="0.3")


def _words(axes: Axes, x: float, y: float, words: str) -> None:
    axes.text(x, y, words, color=YIELD, ha="center", va="center")


def figure() -> Figure:
    """From the side, the spring along n. From above, those along d1 and d2, and about n."""
    page, (side, above) = panels(5.6, 2.5, columns=2)
    side.add_patch(Rectangle((-3, 1.6), 6, 2, facecolor=BODY, alpha=0.6))
    side.plot([-4, 4], [0, 0], "-", color="0.4", linewidth=scaled(2))
    _spring(side, (0, 0), (0, 1.6))
    side.plot([0], [1.6], "o", color="black", markersize=scaled(5))
    side.annotate("n", (-2.6, 1.5), (-2.6, 0.3), arrowprops={"arrowstyle": "-|>"}, ha="center")
    _words(side, 1.5, 0.8, "$c\\,f_n$")
    above.add_patch(Rectangle((-3, -2.2), 6, 4.4, facecolor=BODY, alpha=0.3))
    _spring(above, (-3.9, 0), (-1.05, 0))
    _spring(above, (0, -3.1), (0, -0.78))
    angle = np.linspace(0, 5 * np.pi, 200)
    spiral = (0.12 + 0.06 * angle) * np.array([np.cos(angle), np.sin(angle)])
    above.plot(*spiral, "-", color="0.3")
    above.add_patch(Circle((0, 0), 0.12, color="black"))
    _words(above, -2.1, 0.75, "$c\\,f_{d1}/\\mu_v$")
    _words(above, 1.3, -1.7, "$c\\,f_{d2}/\\mu_v$")
    _words(above, 2.0, 0.9, "$c\\,\\tau_n/\\mu_\\omega$")
    for axes, words in ((side, "from the side"), (above, "from above")):
        axes.set_title(words, loc="left")
        axes.set(xlim=(-4.2, 4.2), ylim=(-3.2, 3.8), aspect="equal")
        axes.axis("off")
    return page
