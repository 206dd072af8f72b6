"""A door on a passive hinge, pushed open by a round tip that moves straight on, and stops.

The hinge is a coordinate that nothing drives: M_u is one number, its inertia. The door is where the
tip puts it, and stays there when the tip stops, since no velocity is carried from step to step.
"""

from typing import Any

import numpy as np

from quasistatic_ref.lab.cached_runs import scenario_run
from quasistatic_ref.lab.examples.shared import Numbers
from quasistatic_ref.lab.figures.labels import caption, label_axes
from quasistatic_ref.optional.show.figures import Figure, draw_scene, moment, panels
from quasistatic_ref.scenario.scenario import Scenario
from quasistatic_ref.simulate.trajectory import Trajectory
from quasistatic_ref.step.data import Array

R, W = 0.6, 0.045
"""The tip's distance from the hinge, sideways; its radius and half of the door's thickness [m]."""

H, TIME = 0.04, 4.8
"""Time step and length of the run [s]."""


def place(theta: Array) -> Array:
    """Where a tip that touches the door is, x = r tan(theta) - w / cos(theta), of its shape [m]."""
    return np.asarray(R * np.tan(theta) - W / np.cos(theta))


def scene_and_run(h: float = H) -> tuple[Scenario, Trajectory]:
    """The scene and its run at a time step h [s]."""
    return scenario_run("door", f"h={h}", f"steps={round(TIME / h)}")


def main() -> Numbers:
    """The angle at the end, how far the tip is from where geometry has it, and the last motion."""
    _, run = scene_and_run()
    x, theta = run["q"][1:].T
    return {
        "angle at the end [deg]": np.degrees(theta[-1]),
        "tip's distance from x(theta) at the end [um]": 1e6 * abs(x[-1] - place(theta[-1:])[0]),
        "turn in the last step [rad]": abs(run["delta_q"][-1, 1]),
    }


def figure(ax: Any = None, *, h: float = H, t: float = 3.0) -> Figure:
    """The door from above, and its angle against the place of the tip.

    Parameters
    ----------
    ax : Axes or SubFigure, optional
        Where to draw; a figure of its own by default.
    h, t : float
        Time step; when the door is drawn [s].
    """
    page, (left, right) = panels(6.3, 3.0, columns=2, within=ax)
    scenario, run = scene_and_run(h)
    draw_scene(left, moment(scenario, run, round(t / h)), view="xy")
    x, theta = run["q"][1:].T
    right.plot(1e3 * x, np.degrees(theta), label="steps")
    touching = np.linspace(theta.min(), theta.max(), 50)
    label = r"$x = r \tan\theta - w / \cos\theta$"
    right.plot(1e3 * place(touching), np.degrees(touching), "k:", label=label)
    label_axes(right, "place x of the tip [mm]", r"angle $\theta$ of the door [deg]",
             caption(h, "frictionless"))  # fmt: skip
    return page
