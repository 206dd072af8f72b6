"""What the rows +d1 and -d1 allow a block to do in a step, at a gap and without one."""

import numpy as np

from docs.drawings.labels import label_axes
from docs.drawings.the_program import MU_V
from quasistatic_ref.optional.show.figures import Figure, panels
from quasistatic_ref.optional.show.figures.style import scaled

GAPS = (0.0, 50.0)
"""phi [um]."""


def figure() -> Figure:
    """One panel a gap: the lines of both rows, and the motions on their upper side."""
    page, row = panels(6.3, 2.9, columns=2, sharey=True)
    dx = np.array([-200.0, 200.0])
    for axes, phi in zip(row, GAPS, strict=True):
        x = np.linspace(*dx, 101)
        axes.fill_between(x, MU_V * np.abs(x) - phi, 120, color="#0072B2", alpha=0.15)
        axes.plot(dx, -phi - MU_V * dx, label=r"$\phi + dz + \mu_v dx = 0$", linewidth=scaled(1.8))
        axes.plot(dx, -phi + MU_V * dx, label=r"$\phi + dz - \mu_v dx = 0$", linewidth=scaled(1.8))
        axes.plot(0, 0, "o", color="black", markersize=scaled(5))
        axes.text(8, -4, "rest", va="top")
        axes.text(0, 85, "allowed", ha="center")
        axes.set(xlim=tuple(dx), ylim=(-70, 120))
        label_axes(axes, r"dx [$\mu$m]", r"dz [$\mu$m]", rf"$\phi$ = {phi:g} $\mu$m", key=False)
        axes.label_outer()
    page.legend(*row[0].get_legend_handles_labels(), loc="outside lower center", ncols=2)
    return page
