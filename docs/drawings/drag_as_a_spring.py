"""A step of a finger on ice with h and with h / 2: to the finger, the block is a spring m / h^2.

The numbers are those of lecture 3: N = K_q (delta_q_bar - delta_q) = (m / h^2) delta_q_u.
"""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Rectangle

from docs.drawings.finger_and_block import BLOCK, FINGER, K_Q, MASS, PHI, H, step
from quasistatic_ref import solve_step
from quasistatic_ref.optional.show.figures import Figure, panels
from quasistatic_ref.optional.show.figures.style import scaled

LEFT, RIGHT = -9.0, 13.0
"""The walls to which both springs are fixed [mm]."""


def _spring(axes: Axes, ends: tuple[float, float], stiffness: float, colour: str) -> None:
    """A spring whose wire is the thicker, the stiffer it is."""
    x = np.linspace(*ends, 300)
    coils = 0.5 * np.sin(np.linspace(0, 14 * np.pi, 300))
    width = 0.8 * (stiffness / K_Q) ** 0.5
    axes.plot(x, 1.5 + coils, color=colour, linestyle="-", linewidth=scaled(width))


def figure() -> Figure:
    """One row a time step."""
    page, rows = panels(5.6, 2.9, rows=2, sharex=True)
    for axes, h in zip(rows, (H, H / 2), strict=True):
        solution = solve_step(step().replace(h=h))
        finger, block = 1e3 * solution.delta_q
        dynamic = MASS / h**2
        force = solution.wrench[0, 2]
        assert abs(force - dynamic * 1e-3 * block) < 1e-9
        back, front = 1e3 * PHI + block, 1e3 * PHI + block + 4
        _spring(axes, (LEFT, finger - 3), K_Q, "0.3")
        axes.add_patch(Rectangle((finger - 3, 0.6), 3, 1.8, facecolor=FINGER, alpha=0.6))
        axes.add_patch(Rectangle((back, 0.2), front - back, 2.6, facecolor=BLOCK, alpha=0.6))
        _spring(axes, (front, RIGHT), dynamic, "#D55E00")
        for x in (LEFT, RIGHT):
            axes.plot([x, x], [0, 3], color="0.3", linestyle="-", linewidth=scaled(3))
        axes.text(-6, 2.3, f"$K_q$ = {K_Q:g} N/m", ha="center")
        axes.text(RIGHT - 0.3, 3.1, f"$m/h^2$ = {dynamic:g} N/m", ha="right", color="#D55E00")
        axes.text(finger, 3.1, f"N = {force:.2f} N", ha="center")
        axes.set(xlim=(-9.5, 13.5), ylim=(-0.2, 4.4), yticks=[])
        axes.set_title(f"h = {1e3 * h:g} ms", loc="left")
        axes.grid(visible=False)
    rows[-1].set_xlabel("x [mm]")
    return page
