"""A compliant peg finds a hole that it misses by 3 mm and 2 mm, and slides in along two walls.

The gantry's springs give way until the peg is in. Inside, they press it on the walls with
K (e - c + b), for a miss e, a clearance c and a boundary layer b; friction on both walls holds it
back.
"""

from typing import Any

import numpy as np

from quasistatic_ref.lab.cached_runs import scenario_run
from quasistatic_ref.lab.examples.shared import Numbers
from quasistatic_ref.lab.figures.labels import caption, label_axes
from quasistatic_ref.optional.show.figures import Figure, draw_scene, moment, panels
from quasistatic_ref.scenario.scenario import Scenario
from quasistatic_ref.simulate.trajectory import Trajectory

K = np.array([500.0, 500.0, 2000.0])
MISS = np.array([0.003, 0.002])
CLEARANCE = 0.0005
MU_V = 0.2
V = 0.01
H, TIME = 0.02, 4.0
"""Time step and length of the run [s]."""
WALLS = ("east", "west", "north", "south")


def scene_and_run(mu_v: float = MU_V, h: float = H) -> tuple[Scenario, Trajectory]:
    """The scene and its run, at mu_v [-] and a time step h [s]."""
    settings = f"h={h}", f"steps={round(TIME / h)}", f"contacts.walls.mu_v={mu_v}"
    return scenario_run("peg_in_hole", *settings)


def main() -> Numbers:
    """Forces of the walls that the peg slides along, and its lag in depth, with their formulas."""
    scenario, run = scene_and_run()
    layer = MU_V * scenario.h * V
    east, _, north, _ = run["wrench"][-1, :, 2]
    N_x, N_y = K[:2] * (MISS - CLEARANCE + layer)
    return {
        "force of the east wall [N]": east,
        "K_x (e_x - c + b) [N]": N_x,
        "force of the north wall [N]": north,
        "K_y (e_y - c + b) [N]": N_y,
        "lag in depth [mm]": 1e3 * (run["q"][-1, 2] - run["q_bar_a"][-1, 2]),
        "mu_v (N_x + N_y) / K_z [mm]": 1e3 * MU_V * (N_x + N_y) / K[2],
    }


def figure(ax: Any = None, *, mu_v: float = MU_V, h: float = H) -> Figure:
    """The peg on its way in, and the forces of the walls.

    Parameters
    ----------
    ax : Axes or SubFigure, optional
        Where to draw; a figure of its own by default.
    mu_v, h : float
        [-], [s].
    """
    page, (left, right) = panels(6.3, 3.0, columns=2, within=ax)
    scenario, run = scene_and_run(mu_v, h)
    tip = np.array([0.0, 0.0, -0.005])
    draw_scene(left, moment(scenario, run, round(2.4 / h)), view="xz", around=(tip, 0.03))
    for wall, force in zip(WALLS, run["wrench"][:, :, 2].T, strict=True):
        right.plot(run["t"], force, label=wall)
    label_axes(right, "time t [s]", "normal force of a wall [N]", caption(h))
    return page
