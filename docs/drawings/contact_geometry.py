"""Two bodies, nearest at alpha and beta: phi, n, d1 and d2, apart and overlapping."""

import numpy as np
from matplotlib.patches import Circle, Rectangle

from docs.drawings.labels import label_axes
from quasistatic_ref.optional.show.figures import panels
from quasistatic_ref.optional.show.figures.style import scaled

RADIUS = 20.0  # mm, of the first body
ANGLE = np.radians(30)  # of n against the vertical
N = np.array([np.sin(ANGLE), np.cos(ANGLE)])
D1 = np.array([np.cos(ANGLE), -np.sin(ANGLE)])
BLACK, BLUE, ORANGE = "black", "#0072B2", "#D55E00"


def points(phi):
    """Alpha on the ball and beta on the face, each the nearest of its body, shape (2, 2) [mm].

    Parameters
    ----------
    phi : float
        Signed distance of the bodies [mm]: beta - alpha = phi n.
    """
    alpha = RADIUS * N
    return np.array([alpha, alpha + phi * N])


def arrow(axes, start, way, name, colour, offset):
    """An arrow from a point along a vector, with its letter next to the tip."""
    tip = start + way
    style = {"arrowstyle": "-|>", "color": colour, "shrinkA": 0, "shrinkB": 0}
    axes.annotate("", tip, start, arrowprops={**style, "linewidth": scaled(1.6)})
    axes.text(*(tip + offset), name, color=colour, ha="center", va="center")


def figure(*, gap=10.0):
    """A panel for each sign of phi, whose size is the gap [mm]."""
    gaps = {"apart": gap, "overlapping": -gap}
    made, row = panels(6.3, 3.6, columns=len(gaps), sharey=True)
    turn = -np.degrees(ANGLE)
    for axes, (name, phi) in zip(row, gaps.items(), strict=True):
        alpha, beta = points(phi)
        axes.add_patch(Circle((0, 0), RADIUS, facecolor="0.85", edgecolor="0.4"))
        corner = beta - 38 * D1
        axes.add_patch(Rectangle(corner, 76, 28, angle=turn, facecolor=BLUE, alpha=0.25))
        axes.plot(*np.array([corner, beta + 38 * D1]).T, color=BLUE, linewidth=scaled(1.2))
        axes.plot(*np.array([alpha, beta]).T, color=BLACK, linestyle=":", linewidth=scaled(1.2))
        axes.plot(*alpha, "D", linestyle="", color=BLACK, markersize=scaled(4))
        axes.text(*(alpha - 7 * D1 - 2 * np.sign(phi) * N), r"$\alpha$", ha="center", va="center")
        axes.text(*(beta - 7 * D1 + 2 * np.sign(phi) * N), r"$\beta$", color=BLUE, ha="center",
                  va="center")  # fmt: skip
        axes.text(*((alpha + beta) / 2 + 4 * D1), r"$\phi$", ha="center", va="center")
        arrow(axes, beta, 18 * N, "n", ORANGE, 4 * N)
        arrow(axes, beta, 18 * D1, r"$d_1$", ORANGE, 4 * D1 + 4 * N)
        for mark in "ox":  # a circle with a cross: d2 = n x d1 points into the page
            axes.plot(
                *beta,
                mark,
                linestyle="",
                color=ORANGE,
                markersize=scaled(9),
                markerfacecolor="none",
            )
        beside = 6 * D1 + 6 * np.sign(phi) * N
        axes.text(*(beta + beside), r"$d_2$", color=ORANGE, ha="center", va="center")
        axes.text(0, -27, "first body", ha="center", va="center")
        axes.text(*(beta + 23 * N - 15 * D1), "second body", color=BLUE, ha="center", va="center")
        axes.set(xlim=(-41, 63), ylim=(-34, 70), aspect="equal", xticks=[], yticks=[])
        axes.set_axis_off()
        sign = ">" if phi > 0 else "<"
        label_axes(axes, title=rf"{name}: $\phi$ {sign} 0", key=False)
    return made
