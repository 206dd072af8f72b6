"""A block that is pushed with 6 N and then with 3 N, step after step: its place and its gap."""

from dataclasses import replace
from functools import cache

import numpy as np
from matplotlib.patches import Rectangle

from docs.drawings.labels import label_axes
from docs.drawings.the_program import H, point
from quasistatic_ref import solve_step
from quasistatic_ref.optional.show.figures import panels
from quasistatic_ref.optional.show.figures.style import scaled

STEPS = (60, 40)  # with the larger push, and with the smaller one
TALL = 200  # times its height, as drawn
BLOCK = (60.0, 40.0)  # mm


def pushes(larger, smaller):
    """The push of each step, shape (steps,) [N]."""
    return np.repeat([larger, smaller], STEPS)


@cache
def run(larger=6.0, smaller=3.0):
    """The block's (x, gap) before each step and after the last, shape (steps + 1, 2) [m]."""
    places = [np.zeros(2)]
    for push in pushes(larger, smaller):
        step = point(push)
        contacts = replace(step.contacts, phi=[places[-1][1]])
        places.append(places[-1] + solve_step(step.replace(contacts=contacts)).delta_q)
    return np.array(places)


def drawn(axes, k):
    """The block before step k, its height above the table times TALL."""
    (x, gap), push = 1e3 * run()[k], pushes(6.0, 3.0)[min(k, sum(STEPS) - 1)]
    axes.axhline(0.0, color="0.3", linewidth=scaled(1.2))
    axes.add_patch(Rectangle((x, TALL * gap), *BLOCK, facecolor="#0072B2", alpha=0.5))
    tip = (x, TALL * gap + BLOCK[1] / 2)
    style = {"arrowstyle": "-|>", "color": "#D55E00", "linewidth": scaled(1.6)}
    axes.annotate("", tip, (tip[0] - 6 * push, tip[1]), arrowprops={**style, "shrinkB": 0})
    axes.set(xlim=(-45, 75), ylim=(-8, 60), aspect="equal", yticks=[])
    axes.grid(visible=False)
    label_axes(axes, "x [mm]", "", f"{push:g} N, step {k}, gap {1e3 * gap:.0f} µm", key=False)


def figure(*, larger=6.0, smaller=3.0):
    """Slip and gap of each step under two pushes [N], and what Coulomb's law has instead."""
    made, (left, right) = panels(6.3, 3.0, columns=2)
    places = 1e6 * run(larger, smaller)
    push = pushes(larger, smaller)
    steps = np.arange(1, len(places))
    coulomb = np.where(push > 0.5 * 9.81, 1e6 * H**2 * (push - 0.5 * 9.81), 0.0)
    for axes, ours, theirs, what in (
        (left, np.diff(places[:, 0]), coulomb, "slip of a step [µm]"),
        (right, places[1:, 1], 0.0 * coulomb, "gap after a step [µm]"),
    ):
        axes.plot(steps, ours, color="#0072B2", label="the model")
        axes.plot(steps, theirs, "--", color="0.3", label="Coulomb's law")
        label_axes(axes, "step [-]", what)
    return made
