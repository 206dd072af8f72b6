"""Figure 1 of the paper: the bunny grasped and lifted, with and without torsional friction."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from quasistatic_ref.files.scenario.scenario import Scenario
from quasistatic_ref.lab.figures.labels import caption, note_below
from quasistatic_ref.lab.grasp import CLOSED, lift_motion
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.optional.show.figures.draw import draw_scene, force_scale
from quasistatic_ref.optional.show.figures.looks import CAMERA, FORCE
from quasistatic_ref.optional.show.figures.moments import Moment, moment
from quasistatic_ref.optional.show.figures.style import panels, scaled
from quasistatic_ref.simulate.record.trajectory import Trajectory

LEAST = 0.03
"""Smaller rotations are drawn there [deg]."""
HALF = 0.084
"""Half the width of what is shown [m]."""
SHOWN: dict[str, Any] = {
    "view": CAMERA,
    "parts": ("contacts", "forces"),
    "around": (np.array([0.0, 0.0, 0.116]), HALF),
    "legend": False,
}


def grasp_strip(
    scenario: Scenario,
    runs: Mapping[str, Trajectory],
    instants: Sequence[float],
    spread: Mapping[str, Array],
) -> Figure:
    """Runs in rows, instants in columns; and how far other clouds of the same bunny turn.

    Parameters
    ----------
    scenario : Scenario
        Its bodies and shapes; the runs may differ from it in contact numbers only.
    runs : mapping of str to Trajectory
        Row title -> run.
    instants : sequence of float
        Times of the columns [s].
    spread : mapping of str to ndarray, shape (N,)
        Row title -> rotations of other clouds [deg].
    """
    rows = len(runs)
    columns = len(instants) + 1
    page, grid = panels(
        6.3, 1.7 * rows + 0.5, columns, rows=rows,
        gridspec_kw={"wspace": 0.0, "hspace": 0.0, "width_ratios": [1] * len(instants) + [0.8]},
    )  # fmt: skip
    shown = {title: [_at(scenario, run, t) for t in instants] for title, run in runs.items()}
    every = [of for moments in shown.values() for of in moments]
    scale = force_scale(every, CAMERA, HALF)
    for k, (title, moments) in enumerate(shown.items()):
        row = grid[k * columns : (k + 1) * columns]
        for axes, of in zip(row, moments, strict=False):
            draw_scene(axes, of, metres_per_newton=scale, **SHOWN)
        row[0].set_ylabel(title.replace(" ", "\n"))
        motion, lift = lift_motion(scenario, runs[title])
        turn = float(np.degrees(motion.rotation_since(CLOSED)[lift].max()))
        row[-2].set_xlabel(f"turns by {turn:.1f}$\\degree$")
        _spread_plot(row[-1], spread[title], turn, last=k == rows - 1)
    for axes, instant in zip(grid, instants, strict=False):
        axes.set_title(f"{instant:g} s")
    grid[columns - 1].set_title(f"{len(next(iter(spread.values())))} clouds")
    key = (
        f"arrows: contact forces on the bunny, 1 N is {1e3 * scale:g} mm; open dots bear no load; "
    )
    key += "star: this bunny, dots: other clouds of it"
    note_below(grid, f"{caption(scenario.h, scenario.cone)}; {key}")
    return page


def _at(scenario: Scenario, run: Trajectory, t: float) -> Moment:
    """The step of a run that ends at the time t [s]."""
    return moment(scenario, run, min(max(round(t / scenario.h) - 1, 0), run.steps - 1))


def _spread_plot(axes: Any, rotations: Array, turn: float, last: bool) -> None:
    """A dot for each rotation and a star for this bunny's, on a logarithmic axis [deg].

    Dots are moved up and down so that all are seen.
    """
    aside = np.random.default_rng(0).uniform(-1, 1, len(rotations))
    axes.plot(np.maximum(rotations, LEAST), aside, ".", color="black", alpha=0.5,
              markersize=scaled(2.5))  # fmt: skip
    axes.plot(max(turn, LEAST), 1.5, "*", color=FORCE, markeredgecolor="black",
              markeredgewidth=scaled(0.5), markersize=scaled(7))  # fmt: skip
    axes.set(xscale="log", xlim=(LEAST / 1.5, 150), ylim=(-2, 2), yticks=[])
    axes.set_xticks([0.1, 1, 10, 100], ["0.1", "1", "10", "100"] if last else [])
    axes.minorticks_off()
    axes.spines["left"].set_visible(False)
    if last:
        axes.set_xlabel("turn in the lift [deg]")
