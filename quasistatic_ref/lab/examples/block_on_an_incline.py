"""Two blocks on a slope of 25 degrees: the rough one stays, the smooth one slides.

What slides would accelerate. Here it moves at once at the speed at which the model's drag m v / h
balances what friction leaves of the weight, v = h g (sin a - mu_v cos a): no velocity is carried
from step to step.
"""

from typing import Any

import numpy as np

from quasistatic_ref.lab.examples.shared import Numbers, only
from quasistatic_ref.lab.figures.labels import caption, labelled
from quasistatic_ref.lab.runs import ran
from quasistatic_ref.optional.show.figures import Figure, draw_scene, moment, panels
from quasistatic_ref.scenario.scenario import Scenario
from quasistatic_ref.simulate.trajectory import Trajectory
from quasistatic_ref.step.data import Array

SLOPE = np.radians(25)
MU_V = {"rough": 0.6, "smooth": 0.3}
G = 9.81
H, TIME = 0.01, 0.4
"""Time step and length of the run [s]."""
PARTS = ("contacts", "cones", "forces")
"""What is drawn of contacts."""
SCALE = 0.02
"""Length of a force of 1 N, of both blocks [m]."""


def slid(h: float = H, **mu_v: float) -> tuple[Scenario, Trajectory, dict[str, Array]]:
    """The scene, its run, and how far each block has gone down the slope, shapes (steps + 1,) [m].

    Parameters
    ----------
    h : float
        [s].
    mu_v : float
        Of ``rough`` and of ``smooth`` [-].
    """
    own = [f"contacts.{name}.mu_v={mu}" for name, mu in mu_v.items()]
    scenario, run = ran("block_incline", f"h={h}", f"steps={round(TIME / h)}", *own)
    down = np.array([np.cos(SLOPE), 0, -np.sin(SLOPE)])
    bases = {name: scenario.system.joint(f"{name}/base").q for name in MU_V}
    gone = {name: (run["q"][:, q][:, :3] - run["q"][0, q][:3]) @ down for name, q in bases.items()}
    return scenario, run, gone


def main() -> Numbers:
    """Speeds at the end, and that of the formula."""
    _, _, gone = slid()
    return {
        "speed of the rough block [mm/s]": 1e3 * (gone["rough"][-1] - gone["rough"][-2]) / H,
        "speed of the smooth block [mm/s]": 1e3 * (gone["smooth"][-1] - gone["smooth"][-2]) / H,
        "h g (sin a - mu_v cos a) [mm/s]": 1e3
        * float(H * G * (np.sin(SLOPE) - MU_V["smooth"] * np.cos(SLOPE))),
    }


def figure(ax: Any = None, *, rough: float = 0.6, smooth: float = 0.3, h: float = H) -> Figure:
    """Each block at the end, from the side; the way of both.

    Parameters
    ----------
    ax : Axes or SubFigure, optional
        Where to draw; a figure of its own by default.
    rough, smooth : float
        mu_v of the two blocks [-].
    h : float
        [s].
    """
    page, (*sides, right) = panels(6.3, 2.8, columns=3, within=ax)
    scenario, run, gone = slid(h, rough=rough, smooth=smooth)
    end = moment(scenario, run, -1)
    for k, (axes, name, mu) in enumerate(zip(sides, MU_V, (rough, smooth), strict=True)):
        own = only(end, (name, "slope"), range(4 * k, 4 * k + 4))  # its four corners
        draw_scene(axes, own, view="xz", parts=PARTS, metres_per_newton=SCALE)
        axes.get_legend().set_title(rf"{name}, $\mu_v$ = {mu:g}")
    for (name, way), mu in zip(gone.items(), (rough, smooth), strict=True):
        times = np.linspace(0.0, h * run.steps, len(way))
        right.plot(times, 1e3 * way, label=rf"{name}, $\mu_v$ = {mu:g}")
    labelled(right, "time t [s]", "way down the slope [mm]", caption(h))
    return page
