"""The six rows of one contact, and which of them are tight when a ball slides or spins.

The slack of row i of Eq. (4) must not be negative. It is how far the ball has risen, plus mu_v
times its slip along +d1, +d2, -d1 or -d2, or plus mu_omega times its turn about n, in one direction
or the other. So the row named -d1 becomes tight when the ball slides along +d1, and pushes it along
-d1. A ball that only slides along d1 has one tight row. A ball that slides and spins so that both
cost the same has two. The tight rows push; all others do not.
"""

from typing import Any

import numpy as np

from quasistatic_ref.lab.examples.shared import Numbers
from quasistatic_ref.lab.figures.labels import caption, label_axes
from quasistatic_ref.lab.scenes.contacts import GRAVITY
from quasistatic_ref.lab.scenes.rigid import sphere_step
from quasistatic_ref.optional.show.figures import Figure, panels
from quasistatic_ref.optional.show.figures.looks import FORCE
from quasistatic_ref.solve.solve import solve_step
from quasistatic_ref.step.data import Array, StepData
from quasistatic_ref.step.standard_form import standard_form

M = 0.3
RADIUS = 0.05
MU_V = 0.5
MU_OMEGA = 0.01
H = 0.01
ROWS = ("+d1", "+d2", "-d1", "-d2", "+spin", "-spin")
TIGHT = 1e-12
"""Slack up to which a row is tight [m]: rounding of slips of 1e-6 m."""
LOADS = {"at rest": (0.0, 0.0), "pushed along d1": (2.0, 0.0), "turned about n": (0.0, 2.0)}
"""Push over mu_v m g, torque over mu_omega m g [-]."""


def loaded_ball(
    push: float, turn: float, mu_v: float = MU_V, mu_omega: float = MU_OMEGA, h: float = H
) -> StepData:
    """A ball on the floor, with a push where it touches and a turn about the vertical.

    Parameters
    ----------
    push, turn : float
        Over what friction holds, mu_v m g and mu_omega m g [-].
    mu_v, mu_omega, h : float
        [-], [m], [s].
    """
    force = push * mu_v * M * GRAVITY
    torque = turn * mu_omega * M * GRAVITY
    wrench = (force, 0, -M * GRAVITY, 0, -RADIUS * force, torque)
    inertia = 0.4 * M * RADIUS**2
    return sphere_step(M, inertia, RADIUS, wrench, mu_v=mu_v, mu_omega=mu_omega, phi=0.0, h=h)


def slacks(step: StepData) -> Array:
    """Slacks A delta_q - b of the six rows [m], shape (6,); 0 where a row is tight."""
    form = standard_form(step)
    slack = form.A @ solve_step(step).delta_q - form.b
    return np.where(np.abs(slack) < TIGHT, 0.0, slack)


def main() -> Numbers:
    """How many rows are tight under each load: these push, and all others do not."""
    return {
        f"tight rows, {name} [-]": float(np.sum(slacks(loaded_ball(*load)) == 0))
        for name, load in LOADS.items()
    }


def figure(
    ax: Any = None, *, mu_v: float = MU_V, mu_omega: float = MU_OMEGA, h: float = H
) -> Figure:
    """The slack of each row under each load.

    Parameters
    ----------
    ax : Axes or SubFigure, optional
        Where to draw; a figure of its own by default.
    mu_v, mu_omega, h : float
        [-], [m], [s].
    """
    columns = len(LOADS)
    page, grid = panels(6.3, 2.6, columns=columns, within=ax, narrow=12, sharey=True)
    for axes, (name, load) in zip(grid, LOADS.items(), strict=True):
        slack = slacks(loaded_ball(*load, mu_v, mu_omega, h))
        axes.grid(visible=False)
        axes.bar(ROWS, 1e6 * slack, color="white", edgecolor="black")
        pushing = np.flatnonzero(slack == 0)
        label = "tight rows, which push" if axes is grid[0] else None
        axes.plot(pushing, 0 * pushing, "^", color=FORCE, clip_on=False, zorder=5, label=label)
        axes.tick_params(axis="x", rotation=60)
        axes.set_title(name)
        label_axes(axes, y=r"slack [$\mu$m]", key=False)
        axes.label_outer(remove_inner_ticks=True)
    grid[0].get_figure(root=False).legend(loc="outside upper center", title=caption(h))
    return page
