"""A real robot: a Franka Panda pushes a block over the floor, and its joints yield.

The robot comes as a URDF with the extra `robots`. Each joint is a spring whose target moves; how
far it stays behind is the torque that it bears. Friction and the model's drag push back with
F = mu_v m g + m v / h, and the sum of two joints' torques is F times the difference of their
heights.
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

M = 0.4
MU_V = 0.4
K_Q = 7000.0
G = 9.81
H, TIME = 0.02, 1.2
"""Time step and length of the run [s]."""


def scene_and_run(mu_v: float = MU_V, h: float = H) -> tuple[Scenario, Trajectory]:
    """The scene and its run, at mu_v of the floor [-] and a time step h [s]."""
    settings = f"h={h}", f"steps={round(TIME / h)}", f"contacts.floor.mu_v={mu_v}"
    return scenario_run("panda_push", *settings)


def torques(mu_v: float = MU_V, h: float = H) -> tuple[Array, Array]:
    """tau_2 + tau_4 after each step, and F (z_4 - z_2) [N m], shapes (N,)."""
    scenario, run = scene_and_run(mu_v, h)
    system = scenario.system
    axes = [system.link(f"panda/panda_link{i}") for i in (2, 4)]
    z_2, z_4 = np.array([system.kinematics(q).t[axes, 2] for q in run["q"][:-1]]).T
    speed = run["delta_q"][:, system.joint("block/base").v][:, 0] / h
    force = np.where(speed > 0, mu_v * M * G, 0.0) + M * speed / h
    tau = K_Q * (run["q_bar_a"] - run["q"][1:, : system.n_q_a])[:, :7]
    return tau[:, 1] + tau[:, 3], force * (z_4 - z_2)


def main() -> Numbers:
    """The torques at the end, and how far the block went."""
    scenario, run = scene_and_run()
    measured, formula = torques()
    x = run["q"][:, scenario.system.joint("block/base").q][:, 0]
    return {
        "tau_2 + tau_4 [N m]": measured[-1],
        "F (z_4 - z_2) [N m]": formula[-1],
        "way of the block [mm]": 1e3 * (x[-1] - x[0]),
    }


def figure(ax: Any = None, *, mu_v: float = MU_V, h: float = H) -> Figure:
    """The robot from the side, and the torques of two joints.

    Parameters
    ----------
    ax : Axes or SubFigure, optional
        Where to draw; a figure of its own by default.
    mu_v, h : float
        Of the floor [-], [s].
    """
    page, (left, right) = panels(6.3, 3.2, columns=2, within=ax)
    scenario, run = scene_and_run(mu_v, h)
    draw_scene(left, moment(scenario, run, -1), view="xz", parts=("contacts", "forces"))
    measured, formula = torques(mu_v, h)
    right.plot(run["t"], measured, label=r"$\tau_2 + \tau_4$")
    right.plot(run["t"], formula, color="black", linestyle=":", label=r"$F\,(z_4 - z_2)$")
    label_axes(right, "time t [s]", "torque [N m]", caption(h))
    return page
