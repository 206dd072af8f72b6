"""A block on a table, pulled sideways: the smallest problem with friction.

The block may move by delta_q, its twist in one time step. Eq. (13) weighs that motion against the
work of gravity and of the pull, and Eq. (4) forbids each lower corner to enter the table. Friction
is in the same rows: to slide by x, a corner has to rise by mu_v x. Lifting costs the weight, so
that nothing moves until the pull is mu_v m g. At rest, many forces inside the cones would do; the
ones that are drawn are those with a small compliance at each contact, which are unique.
"""

from typing import Any

import numpy as np

from quasistatic_ref.lab.cached_runs import scenario_run
from quasistatic_ref.lab.examples.shared import Numbers
from quasistatic_ref.lab.figures.labels import caption, label_axes
from quasistatic_ref.lab.scenes.contacts import GRAVITY, Z
from quasistatic_ref.lab.scenes.rigid import rigid_step
from quasistatic_ref.optional.show.figures import Figure, draw_scene, moment, panels, scaled
from quasistatic_ref.solve.solve import solve_step
from quasistatic_ref.step.data import Array

M, MU_V, H, HALF = 0.5, 0.4, 0.01, 0.05
"""Mass [kg], friction [-], time step [s], half of the block's side [m]."""

SETTINGS = ("steps=5", "bodies.pusher.pose.xyz=[-1, 0, 0.05]")
"""Of the scenario block_push: at rest, the pusher far away."""

PARTS = ("frames", "cones", "forces")
PULLS = np.linspace(0.0, 2.0, 21)
"""Over mu_v m g [-]."""


def slips(pulls: Array, mu_v: float = MU_V, h: float = H) -> Array:
    """How far the block slides in one step, shape (N,) [m].

    Parameters
    ----------
    pulls : ndarray, shape (N,)
        At the height of the table, over mu_v m g [-].
    mu_v, h : float
        [-], [s].
    """
    corners = HALF * np.array([[x, y, -1.0] for x in (-1, 1) for y in (-1, 1)])
    frames = np.tile([[1.0, 0, 0], [0, 1.0, 0], Z], (4, 1, 1))
    inertia = M * (2 * HALF) ** 2 / 6
    found = []
    for pull in pulls * mu_v * M * GRAVITY:
        wrench = (pull, 0, -M * GRAVITY, 0, -HALF * pull, 0)  # it acts at the bottom: no tipping
        step = rigid_step(M, inertia, wrench, corners, frames, mu_v=mu_v, h=h)
        found.append(solve_step(step, fast=True).delta_q[0])
    return np.array(found)


def main() -> Numbers:
    """The load of the corners at rest, and slips on both sides of the threshold."""
    _, run = scenario_run("block_push", *SETTINGS)
    below, beyond = slips(np.array([0.99, 1.5]))
    return {
        "load on the four corners [N]": run["wrench"][-1, :4, 2].sum(),
        "weight [N]": M * GRAVITY,
        "slip at 0.99 of the threshold [mm]": 1e3 * below,
        "slip at 1.5 of the threshold [mm]": 1e3 * beyond,
    }


def figure(ax: Any = None, *, mu_v: float = MU_V, h: float = H) -> Figure:
    """The block at rest with its forces; slip against pull.

    Parameters
    ----------
    ax : Axes or SubFigure, optional
        Where to draw; a figure of its own by default.
    mu_v, h : float
        [-], [s].
    """
    page, (left, right) = panels(6.3, 3.0, columns=2, within=ax)
    scenario, run = scenario_run("block_push", *SETTINGS, f"h={h}", f"contacts.floor.mu_v={mu_v}")
    draw_scene(left, moment(scenario, run, -1), parts=PARTS, around=(HALF * Z, 1.3 * HALF))
    right.plot(PULLS, 1e3 * slips(PULLS, mu_v, h), marker="o", markersize=scaled(3), clip_on=False)
    label_axes(right, r"pull / ($\mu_v m g$) [-]", "slip in one step [mm]", caption(h))
    return page
