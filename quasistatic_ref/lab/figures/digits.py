"""Correct digits of backends against the accuracy of the call."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from quasistatic_ref.lab.figures.labels import labelled, legend_below
from quasistatic_ref.lab.figures.line_styles import COLOURS, DASHES, MARKS
from quasistatic_ref.optional.show.figures.style import panels, scaled

SPREAD = 0.17
"""Distance between backends at the same setting, settings being one apart."""


@dataclass(frozen=True)
class BackendDigits:
    """How right a backend was, over many steps, at one setting.

    Parameters
    ----------
    units : str
        Title of the panel: what the backend was handed.
    backend : str
    accuracy : str
        The setting, as its tick is to read.
    steps : int
    unsolved : int
        Steps of these for which it gave no answer; they are in none of the numbers below.
    worst, low, median, best : float
        Correct digits [-] of delta_q: the least, the first percentile, the median, the most.
    """

    units: str
    backend: str
    accuracy: str
    steps: int
    unsolved: int
    worst: float
    low: float
    median: float
    best: float


def digits_of_backends(
    records: Sequence[BackendDigits], subject: str, within: Any = None
) -> Figure:
    """Correct digits against the setting; one panel for each kind of units.

    Parameters
    ----------
    records : sequence of BackendDigits
        Panels, ticks and the legend are in the order in which they come.
    subject : str
        Which steps these are, with their time step and cone.
    within : Axes or SubFigure, optional
        Where to draw; a figure of its own by default.
    """
    units = list(dict.fromkeys(r.units for r in records))
    backends = list(dict.fromkeys(r.backend for r in records))
    settings = list(dict.fromkeys(r.accuracy for r in records))
    figure, grid = panels(6.3, 3.9, columns=len(units), within=within, sharey=True)
    for axes, kind in zip(grid, units, strict=True):
        for k, backend in enumerate(backends):
            own = [r for r in records if (r.units, r.backend) == (kind, backend)]
            aside = SPREAD * (k - (len(backends) - 1) / 2)
            _draw(axes, own, [settings.index(r.accuracy) + aside for r in own], k)
        axes.set_title(kind)
        axes.set_xticks(range(len(settings)), settings)
        axes.grid(visible=False, axis="x")
        axes.set(ylim=(-0.6, 16.6), yticks=range(0, 17, 4))
        labelled(
            axes,
            "accuracy asked of the backend [-]",
            r"correct digits of $\delta q$ [-]",
            key=False,
        )
        axes.label_outer(remove_inner_ticks=True)
    unsolved = any(r.unsolved for r in records)
    said = "some steps unsolved" if unsolved else "no step unsolved"
    key = "marker: median step; bar: first percentile; line: worst step to best"
    handles = grid[0].get_legend_handles_labels()[0]
    legend_below(grid, handles, f"{key}; {said}; {subject}")
    return figure


def _draw(axes: Axes, own: Sequence[BackendDigits], at: Sequence[float], k: int) -> None:
    """Draw one backend; where it left steps unsolved, their share stands at the bottom."""
    x = [p for p, r in zip(at, own, strict=True) if r.unsolved < r.steps]
    shown = [r for r in own if r.unsolved < r.steps]
    colour, style = COLOURS[k], DASHES[k % len(DASHES)]
    worst, best = [r.worst for r in shown], [r.best for r in shown]
    axes.vlines(x, worst, best, colors=colour, linewidth=scaled(1.0), linestyle=style)
    low = [r.low for r in shown]
    axes.plot(x, low, linestyle="none", marker="_", markersize=scaled(6), color="black")
    axes.plot(
        x, [r.median for r in shown], linestyle="none", marker=MARKS[k], markersize=scaled(5.5),
        color=colour, markeredgecolor="black", markeredgewidth=0.5, label=own[0].backend,
    )  # fmt: skip
    for p, r in zip(at, own, strict=True):
        if r.unsolved:
            text = f"{100 * r.unsolved / r.steps:.1f} % unsolved"
            axes.text(p, -0.4, text, rotation=90, fontsize="small", ha="center", va="bottom")
