"""A box on a slope that is too steep for its base: it turns about the lower edge, (R11)."""

import numpy as np
from matplotlib.patches import Arc, Polygon

from quasistatic_ref.optional.show.figures import Figure, panels
from quasistatic_ref.optional.show.figures.style import scaled

ANGLE, L, Z = np.radians(35), 20.0, 40.0  # of the slope; half the base, height of the centre [mm]


def figure() -> Figure:
    """The box, its weight and the lower edge of its base."""
    assert np.tan(ANGLE) > L / Z  # it tips
    page, (axes,) = panels(4.2, 3.6)
    along = np.array([np.cos(ANGLE), -np.sin(ANGLE)])  # down the slope
    up = np.array([np.sin(ANGLE), np.cos(ANGLE)])
    pen = {"color": "0.4", "linestyle": "-", "linewidth": scaled(1.2)}
    axes.plot(*np.array([-70 * along, 70 * along]).T, **pen)
    axes.plot([70 * along[0], -40], [70 * along[1]] * 2, **pen)
    low, high = L * along, -L * along
    corners = [low, high, high + 2 * Z * up, low + 2 * Z * up]
    axes.add_patch(Polygon(corners, facecolor="0.9", edgecolor="0.3"))
    centre = Z * up
    look = {"arrowstyle": "-|>", "shrinkA": 0, "shrinkB": 0, "linewidth": scaled(2)}
    axes.annotate("", centre - [0, 62], centre, arrowprops=look | {"color": "#D55E00"})
    axes.text(centre[0] + 2, centre[1] - 60, "m g", color="#D55E00")
    axes.plot(*centre, "o", color="black", markersize=scaled(5))
    axes.plot(*low, "o", color="#0072B2", markersize=scaled(7))
    axes.annotate(
        "lower edge", low, low + np.array([14, 12]), color="#0072B2", arrowprops={"arrowstyle": "-"}
    )
    thin = {"color": "black", "linestyle": ":", "linewidth": scaled(1)}
    axes.plot(*np.array([centre, [0, 0]]).T, **thin)
    axes.text(*(centre / 2 + [-5, 2]), "z")
    axes.text(*(low / 2 + [-4, -9]), "L")
    corner = 70 * along
    axes.add_patch(Arc(corner, 40, 40, theta1=180 - np.degrees(ANGLE), theta2=180))
    axes.text(corner[0] - 29, corner[1] + 4, "a")
    axes.set(xlim=(-62, 66), ylim=(-46, 86), aspect="equal")
    axes.axis("off")
    return page
