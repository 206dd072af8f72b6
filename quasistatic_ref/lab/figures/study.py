"""The figures of a report on solvers: profiles, success, digits against time, digits by family."""

from collections.abc import Mapping
from typing import Any, Final

import numpy as np
from matplotlib import pyplot as plt
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from quasistatic_ref.lab.figures.line_styles import pens, short
from quasistatic_ref.optional.show.figures.style import PAGE

FURTHEST: Final = 1e4
"""Largest ratio of times that a profile shows."""
DARK: Final = 0.6
"""Share of the scale beyond which a cell's number is white."""
POINT: Final = {"linestyle": "", "label": "_"}
LEVEL_MARKS: Final = ("o", "s", "^")


def profiles(data: Mapping[str, Any]) -> Figure:
    """Performance profiles, a panel a setting."""
    panels = data["panels"]
    names = list(dict.fromkeys(label for panel in panels for label in panel["labels"]))
    pen = pens(names)
    figure, grid = _panels(len(panels), 3.0)
    taus = np.geomspace(1, FURTHEST, 400)
    for axes, panel in zip(grid, panels, strict=True):
        for k, (label, ratios) in enumerate(zip(panel["labels"], panel["ratios"], strict=True)):
            every = (20 + 4 * k, 75)  # marks of lines that run together stay apart
            dress = pen[label] | {"markerfacecolor": "white", "markevery": every}
            axes.plot(taus, profile(ratios, taus), **dress)
        label = r"$\tau$: time / time of the fastest [-]"
        axes.set(xscale="log", xlabel=label, title=panel["title"])
    grid[0].set(ylim=(-3, 103), ylabel="problems right within that [%]")
    _legend(figure, names)
    return figure


def success(data: Mapping[str, Any]) -> Figure:
    """Shares of problems solved to so many digits, a panel a setting."""
    panels, levels = data["panels"], data["levels"]
    names = list(dict.fromkeys(label for panel in panels for label in panel["labels"]))[::-1]
    figure, grid = _panels(len(panels), 0.8 + 0.23 * len(names))
    for axes, panel in zip(grid, panels, strict=True):
        at = [names.index(label) for label in panel["labels"]]
        for k, (least, mark) in enumerate(zip(levels, LEVEL_MARKS, strict=True)):
            face = str(0.9 - 0.4 * k)
            axes.plot(
                panel["shares"][:, k], at, linestyle="", marker=mark, markersize=8 - 1.5 * k,
                markerfacecolor=face, markeredgecolor="black", label=rf"$\geq$ {least:g} digits",
                clip_on=False, zorder=3,
            )  # fmt: skip
        axes.set(xlim=(0, 100), xlabel="problems [%]", title=f"setting {panel['title']}")
    grid[0].set_yticks(range(len(names)), short(names).values())
    handles, labels = grid[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=len(levels))
    return figure


def digits_time(data: Mapping[str, Any]) -> Figure:
    """Median digits against median time, a line a solver, a mark a setting."""
    panels = data["panels"]
    names = list(dict.fromkeys(label for panel in panels for label in panel["lines"]))
    pen = pens(names)
    figure, grid = _panels(len(panels), 3.4, sharex=True)
    for axes, panel in zip(grid, panels, strict=True):
        for label, points in panel["lines"].items():
            set_ = [(1e3 * t, right) for own, t, right in points if not own]
            own = [(1e3 * t, right) for own, t, right in points if own]
            kinds: Any = (set_, "none", {}), (set_[-1:], "full", POINT), (own, "left", POINT)
            # An empty line that is not clipped has no extent, which upsets the layout.
            for part, fill, more in (kind for kind in kinds if kind[0]):
                dress = pen[label] | more | {"fillstyle": fill, "clip_on": False}
                axes.plot(*np.transpose(part), **dress)
        axes.set(xscale="log", xlabel="median time of a call [ms]", title=panel["title"])
    label = r"median correct digits of $\delta q$ [-]"
    grid[0].set(ylim=(0, 16.5), yticks=range(0, 17, 4), ylabel=label)
    _legend(figure, names)
    return figure


def families(data: Mapping[str, Any]) -> Figure:
    """Heat maps of digits: a row a solver, a column a family, a panel a setting."""
    panels = data["panels"]
    heights = [len(panel["labels"]) for panel in panels]
    figure, grid = plt.subplots(
        len(panels), 1, figsize=(PAGE, 1.3 + sum(0.45 + 0.21 * n for n in heights)),
        squeeze=False, sharex=True, layout="constrained", height_ratios=heights,
    )  # fmt: skip
    for axes, panel in zip(grid[:, 0], panels, strict=True):
        image = axes.imshow(panel["digits"], cmap="Greys", vmin=0, vmax=16, aspect="auto")
        _numbers(axes, panel["digits"])
        axes.set_yticks(range(len(panel["labels"])), short(panel["labels"]).values())
        axes.set_xticks(range(len(panel["families"])), panel["families"], rotation=60,
                        ha="right", rotation_mode="anchor")  # fmt: skip
        axes.grid(visible=False)
        axes.tick_params(length=0)
        axes.set_title(panel["title"])
    bar = figure.colorbar(image, ax=grid[:, 0], shrink=0.6, pad=0.01, ticks=range(0, 17, 4))
    bar.set_label("median correct digits [-]")
    return figure


def _panels(count: int, height: float, sharex: bool = False) -> tuple[Figure, Any]:
    """Axes side by side that share the axis upwards; `height` [in]."""
    options: dict[str, Any] = {"sharex": sharex, "sharey": True, "layout": "constrained"}
    figure, grid = plt.subplots(1, count, figsize=(PAGE, height), squeeze=False, **options)
    return figure, grid[0]


def _numbers(axes: Axes, values: np.ndarray) -> None:
    for (i, j), value in np.ndenumerate(values):
        if np.isfinite(value):
            colour = "white" if value > 16 * DARK else "black"
            axes.text(j, i, f"{value:.1f}", ha="center", va="center", fontsize=7, color=colour)
        else:
            axes.text(j, i, "-", ha="center", va="center", fontsize=7)


def _legend(figure: Figure, names: list[str]) -> None:
    """One legend for all panels, below them."""
    drawn = pens(names)
    handles = [Line2D([], [], **drawn[name], markerfacecolor="white") for name in names]
    shown = short(names)
    figure.legend(
        handles, list(shown.values()), loc="outside lower center",
        ncols=3 if shown[names[0]] == names[0] else 5, handlelength=2.6, columnspacing=1.0,
    )  # fmt: skip


def profile(ratios: np.ndarray, taus: np.ndarray) -> np.ndarray:
    """Share of problems within each ratio of the fastest [%].

    Parameters
    ----------
    ratios : ndarray, shape (problems,) [-]
    taus : ndarray, shape (n,) [-]

    Returns
    -------
    ndarray, shape (n,)
    """
    return 100 * np.searchsorted(np.sort(ratios), taus, side="right") / max(len(ratios), 1)
