"""A block on a table, pushed with 3 and with 6 N: the question before the answer."""

from matplotlib.patches import Rectangle

from docs.drawings.the_program import GRAVITY, MASS, MU_V
from quasistatic_ref.optional.show.figures import Figure, panels
from quasistatic_ref.optional.show.figures.style import scaled

PUSHES = (3.0, 6.0)  # N


def figure() -> Figure:
    """One panel a push."""
    page, row = panels(6.3, 2.0, columns=2)
    for axes, push in zip(row, PUSHES, strict=True):
        axes.add_patch(Rectangle((-1, 0), 2, 1.3, facecolor="#BBD6EA", edgecolor="0.4"))
        axes.axhline(0.0, color="0.3", linewidth=scaled(1.5))
        look = {"arrowstyle": "-|>", "shrinkA": 0, "shrinkB": 0, "linewidth": scaled(2)}
        axes.annotate("", (-1, 0.65), (-1 - push / 3, 0.65), arrowprops=look | {"color": "#D55E00"})
        axes.text(-1.1, 0.8, f"{push:g} N", ha="right")
        axes.annotate("", (0, -0.6), (0, 0.65), arrowprops=look | {"color": "0.3"})
        axes.text(0.1, -0.55, f"{MASS * GRAVITY:.2f} N")
        axes.text(1.6, 0.08, rf"$\mu_v$ = {MU_V:g}")
        axes.set(xlim=(-3.2, 2.9), ylim=(-0.8, 1.5), aspect="equal")
        axes.set_axis_off()
    return page
