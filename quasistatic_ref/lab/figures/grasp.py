"""Figure 1 of the paper: the bunny grasped and lifted, with and without torsional friction."""

from collections.abc import Mapping, Sequence
from typing import Any, Final

import numpy as np
from matplotlib import pyplot as plt
from matplotlib.figure import Figure

from quasistatic_ref.figures.camera import Camera
from quasistatic_ref.figures.draw import draw_scene
from quasistatic_ref.figures.moments import moment
from quasistatic_ref.figures.style import figure_style, sized
from quasistatic_ref.simulate.measures import link_motion
from quasistatic_ref.simulate.scenario import Scenario
from quasistatic_ref.simulate.trajectory import Trajectory

CAMERA = Camera(azimuth=-62, elevation=12)
SHOWN: Final[dict[str, Any]] = {
    "view": CAMERA,
    "parts": ("contacts",),
    "around": (np.array([0.0, 0.0, 0.115]), 0.085),
    "legend": False,
}


def grasp_strip(
    scenario: Scenario, runs: Mapping[str, Trajectory], instants: Sequence[float]
) -> Figure:
    """Runs in rows, instants in columns.

    Parameters
    ----------
    scenario : Scenario
        Its bodies and shapes; the runs may differ from it in contact numbers only.
    runs : mapping of str to Trajectory
        Row title -> run.
    instants : sequence of float
        Times of the columns [s].
    """
    with figure_style():
        figure, grid = plt.subplots(
            len(runs), len(instants), figsize=sized(6.3, 1.45 * len(runs)), squeeze=False,
            gridspec_kw={"wspace": 0.03, "hspace": 0.05},
        )  # fmt: skip
        for row, (title, run) in zip(grid, runs.items(), strict=True):
            for axes, instant in zip(row, instants, strict=True):
                k = min(max(round(instant / scenario.h) - 1, 0), run.steps - 1)
                draw_scene(axes, moment(scenario, run, k), **SHOWN)
            row[0].set_ylabel(title.replace(" ", "\n"))
        for axes, instant in zip(grid[0], instants, strict=True):
            axes.set_title(f"t = {instant:g} s")
        figure.text(
            0.5, 0.03,
            f"h = {1e3 * scenario.h:g} ms, friction {scenario.cone}; "
            "open dots: contacts considered, filled dots: contacts that bear load",
            ha="center", fontsize="small",
        )  # fmt: skip
    return figure


def rotation_plot(
    scenario: Scenario, runs: Mapping[str, Trajectory], link: str, since: float
) -> Figure:
    """Angle that a body has turned since the grip closed, at the time `since` [s], against time."""
    with figure_style():
        figure, axes = plt.subplots(figsize=sized(4.6, 2.8))
        for title, run in runs.items():
            motion = link_motion(scenario.system, run, link)
            after = motion.index(since)
            angle = np.degrees(motion.rotation_since(since))
            axes.plot(motion.times[after:], angle[after:], label=title)
        axes.set(xlabel="time t [s]", ylabel="rotation since the grip closed [deg]")
        axes.set_title(f"h = {1e3 * scenario.h:g} ms, friction {scenario.cone}", loc="right")
        axes.set_ylim(bottom=-1)
        axes.legend()
    return figure
