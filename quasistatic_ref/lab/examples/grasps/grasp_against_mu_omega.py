"""How far the bunny of Figure 1 turns in the grip, against mu_omega of the fingers.

It is a threshold: from about 1.8 mm on the contacts stick, and more changes next to nothing. A
finger can have at most 2/3 mu_v r, where r is half of its width: the mu_omega of a patch as wide as
the finger under an even pressure, (R15). The scene's value lies between the two.
"""

from collections.abc import Sequence
from functools import cache
from typing import Any

import numpy as np

from quasistatic_ref.lab.cached_runs import grasp, scenario_run
from quasistatic_ref.lab.examples.shared import Numbers
from quasistatic_ref.lab.figures.labels import caption, label_axes
from quasistatic_ref.lab.grasp import CASES, CLOSED, TOP, grasp_report
from quasistatic_ref.optional.show.figures import Figure, panels, scaled
from quasistatic_ref.shapes.placed_shape import Box
from quasistatic_ref.simulate.trajectory import Trajectory
from quasistatic_ref.step.data import Array

BELOW, ABOVE = 1.75e-3, 1.8e-3
"""Where it slips and where it holds [m]."""
VALUES = (0.5e-3, 1e-3, 1.3e-3, 1.5e-3, 1.65e-3, BELOW, ABOVE, 2e-3, 4e-3, 5e-3)
"""mu_omega [m], apart from the two of Figure 1."""
LIFTING = 137
"""A step in the middle of the lift."""


@cache
def rotations(values: tuple[float, ...] = VALUES) -> tuple[Array, Array]:
    """mu_omega [m], ascending, and the largest rotation during the lift [deg], each shape (N,).

    Two of the runs are those of Figure 1. The others are not certified: without certificates the
    angle of the scene differs by 3e-8 degrees, and a picture needs 1e-1.

    Parameters
    ----------
    values : tuple of float
        mu_omega of the others [m].
    """
    own = ("solver.certify=off", f"steps={round(TOP / 0.01)}")
    runs = [scenario_run("bunny_grasp", f"contacts.grip.mu_omega={x}", *own) for x in values]
    runs += [grasp(case) for case in CASES]
    mu_omega = np.array([run["mu_omega"].max() for _, run in runs])
    turned = np.array([float(str(grasp_report(*run)["rotation_deg"])) for run in runs])
    order = np.argsort(mu_omega)
    return mu_omega[order], turned[order]


def physical_limit() -> float:
    """Largest mu_omega of a finger [m], 2/3 mu_v r with r half of its width, (R15)."""
    scenario, run = grasp("with torsion")
    fingers = [x.shape for x in scenario.system.shapes if "finger" in x.name]
    half_width = min(float(box.half_extents[0]) for box in fingers if isinstance(box, Box))
    mu_v = float(run["mu_v"][run["rows"] == 6].max())
    return 2 / 3 * mu_v * half_width


def least_mu_omega(run: Trajectory) -> float:
    """Least mu_omega [m] that bears the forces of a step in the middle of the lift, by (R9).

    Summed over the contacts of the fingers, (|f_1| + |f_2|) / mu_v + |tau_n| / mu_omega <= f_n.
    """
    fingers = run["rows"] == 6
    f_1, f_2, f_n, tau_n = np.abs(run.step_forces(LIFTING)[fingers]).sum(axis=0)
    return float(tau_n / (f_n - (f_1 + f_2) / run["mu_v"][fingers].max()))


def main() -> Numbers:
    """Where it begins to hold, in runs and by (R9), and what a finger can have."""
    _, run = grasp("with torsion")
    mu_omega, turned = rotations()
    at = dict(zip(mu_omega.tolist(), turned.tolist(), strict=True))
    return {
        f"rotation with mu_omega = {1e3 * BELOW:g} mm [deg]": at[BELOW],
        f"rotation with mu_omega = {1e3 * ABOVE:g} mm [deg]": at[ABOVE],
        "least mu_omega that holds, by (R9) from the forces of a step [mm]": 1e3
        * least_mu_omega(run),
        "mu_omega of the scene [mm]": 1e3 * float(run["mu_omega"].max()),
        "largest mu_omega of a finger, 2/3 mu_v r [mm]": 1e3 * physical_limit(),
    }


def figure(ax: Any = None, *, mu_omega: Sequence[float] = VALUES) -> Figure:
    """Rotation against mu_omega.

    Parameters
    ----------
    ax : Axes or SubFigure, optional
        Where to draw; a figure of its own by default.
    mu_omega : sequence of float
        Apart from the two of Figure 1 [m].
    """
    scenario, run = grasp("with torsion")
    at, turned = rotations(tuple(mu_omega))
    used = run["mu_omega"].max()
    limit = physical_limit()
    page, (axes,) = panels(4.6, 2.8, within=ax)
    axes.plot(1e3 * at, turned, marker="o", markersize=scaled(4), clip_on=False)
    for x, line, label in (
        (least_mu_omega(run), ":", "begins to hold, (R9)"),
        (used, "-", "value of the scene"),
        (limit, "--", r"$2\mu_v r\,/\,3$ of a finger"),
    ):
        axes.axvline(1e3 * x, color="black", linestyle=line, linewidth=scaled(1), label=label)
    axes.set_ylim(-1, 60)
    label_axes(
        axes, r"$\mu_\omega$ of the fingers [mm]",
        f"rotation, t = {CLOSED:g} to {TOP:g} s [deg]", caption(scenario.h, scenario.cone),
    )  # fmt: skip
    return page
