"""Figure 1 of the paper: the bunny grasped and lifted, with and without torsional friction."""

from collections.abc import Mapping, Sequence
from typing import Any, Final

import numpy as np
from matplotlib.figure import Figure

from quasistatic_ref.cli.measures import link_motion
from quasistatic_ref.lab.figures.labels import caption, labelled, note_below
from quasistatic_ref.optional.show.figures.camera import Camera
from quasistatic_ref.optional.show.figures.draw import draw_scene
from quasistatic_ref.optional.show.figures.moments import moment
from quasistatic_ref.optional.show.figures.style import panels
from quasistatic_ref.scenario.scenario import Scenario
from quasistatic_ref.simulate.trajectory import Trajectory

CAMERA = Camera(azimuth=-62, elevation=12)
SHOWN: Final[dict[str, Any]] = {
    "view": CAMERA,
    "parts": ("contacts",),
    "around": (np.array([0.0, 0.0, 0.115]), 0.085),
    "legend": False,
}


def grasp_strip(
    scenario: Scenario,
    runs: Mapping[str, Trajectory],
    instants: Sequence[float],
    within: Any = None,
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
    within : Axes or SubFigure, optional
        Where to draw; a figure of its own by default.
    """
    rows, columns = len(runs), len(instants)
    page, grid = panels(
        6.3, 1.2 * rows + 0.5, columns, rows=rows, within=within, narrow=0,
        gridspec_kw={"wspace": 0.0, "hspace": 0.0},
    )  # fmt: skip
    for k, (title, run) in enumerate(runs.items()):
        row = grid[k * columns : (k + 1) * columns]
        for axes, instant in zip(row, instants, strict=True):
            j = min(max(round(instant / scenario.h) - 1, 0), run.steps - 1)
            draw_scene(axes, moment(scenario, run, j), **SHOWN)
        row[0].set_ylabel(title.replace(" ", "\n"))
    for axes, instant in zip(grid, instants, strict=False):
        axes.set_title(f"{instant:g} s")
    dots = "open dots: contacts considered, filled dots: contacts that bear load"
    note_below(grid, f"{caption(scenario.h, scenario.cone)}; {dots}")
    return page


def rotation_plot(
    scenario: Scenario,
    runs: Mapping[str, Trajectory],
    link: str,
    since: float,
    within: Any = None,
) -> Figure:
    """Angle that a body has turned since the grip closed, at the time `since` [s], against time."""
    page, (axes,) = panels(4.6, 2.8, within=within)
    for title, run in runs.items():
        motion = link_motion(scenario.system, run, link)
        after = motion.index(since)
        angle = np.degrees(motion.rotation_since(since))
        axes.plot(motion.times[after:], angle[after:], label=title)
    axes.set_ylim(bottom=-1)
    what = "rotation since the grip closed [deg]"
    labelled(axes, "time t [s]", what, caption(scenario.h, scenario.cone))
    return page
