"""What two fingers can bear, as a set of forces and torques, with the weight and with drag.

Two fingers hold a bar at a distance from its centre of mass. The vertical force and the torque
about their line that they can bear are a diamond (R14). The weight is a point in it. Drag moves the
point along the same ray: the farther, the smaller the time step.
"""

import numpy as np
from matplotlib.patches import Polygon

from docs.drawings.labels import label_axes, legend_below
from quasistatic_ref import solve_step
from quasistatic_ref.lab.made_steps.pinch import pinch_step
from quasistatic_ref.optional.show.figures import Figure, panels
from quasistatic_ref.optional.show.figures.style import scaled

M, GRAVITY, MU_V, MU_OMEGA = 0.2, 9.81, 0.5, 0.02  # kg, m/s^2, -, m
GRIP, D, SPEED = 4.2, 0.04, 0.02  # of each finger [N]; of the fingers from the centre [m]; [m/s]
STEPS = {0.05: "s", 0.029: "^", 0.01: "X"}
"""Each h [s], with its mark."""


def held(h: float) -> bool:
    """Whether a bar as heavy as weight and drag together, m (g + v / h), stays in the fingers."""
    heavier = M * (1 + SPEED / (GRAVITY * h))
    answer = solve_step(pinch_step(GRIP, D, MU_V, MU_OMEGA, m=heavier))
    return bool(np.abs(answer.delta_q[2:]).max() < 1e-12)


def figure() -> Figure:
    """The diamond, the weight, and weight and drag for three time steps."""
    assert [held(h) for h in STEPS] == [True, True, False]
    page, (axes,) = panels(6.3, 3.3)
    force, torque = 2 * MU_V * GRIP, 2e3 * MU_OMEGA * GRIP
    diamond = [(force, 0), (0, torque), (-force, 0), (0, -torque)]
    axes.add_patch(Polygon(diamond, facecolor="#0072B2", alpha=0.2, edgecolor="none"))
    weight = M * GRAVITY * np.array([1, 1e3 * D])
    axes.plot([0, 1.7 * weight[0]], [0, 1.7 * weight[1]], color="0.6", linestyle=":")
    pen = {"linestyle": "", "markersize": scaled(6)}
    axes.plot(*weight, "o", color="black", label="the weight", **pen)
    for h, mark in STEPS.items():
        load = weight * (1 + SPEED / (GRAVITY * h))
        label = f"with drag, h = {1e3 * h:g} ms"
        axes.plot(*load, mark, color="#D55E00", markeredgecolor="black", label=label, **pen)
    axes.text(1.5, 12, "what the fingers can bear")
    axes.set(xlim=(0, 4.5), ylim=(0, 175))
    label_axes(axes, "vertical force [N]", "torque about the fingers' line [N mm]", key=False)
    legend_below([axes], axes.get_legend_handles_labels()[0])
    return page
