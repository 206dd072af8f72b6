"""The figures of reports: performance profiles, digits against time, and sweeps."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib import pyplot as plt
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from quasistatic_ref.lab.figures.line_styles import pens, short
from quasistatic_ref.optional.show.figures.style import PAGE

FURTHEST = 1e4
"""Largest ratio of times that a profile shows."""
POINT = {"linestyle": "", "label": "_"}


def profiles(data: Mapping[str, Any]) -> Figure:
    """Performance profiles, a line a solver."""
    names = data["labels"]
    pen = pens(names)
    figure, axes = plt.subplots(figsize=(PAGE, 3.0), layout="constrained")
    taus = np.geomspace(1, FURTHEST, 400)
    for k, (label, ratios) in enumerate(zip(names, data["ratios"], strict=True)):
        every = (20 + 4 * k, 75)  # marks of lines that run together stay apart
        dress = pen[label] | {"markerfacecolor": "white", "markevery": every}
        axes.plot(taus, profile(ratios, taus), **dress)
    axes.set(xscale="log", xlabel=r"$\tau$: time / time of the fastest [-]", title=data["title"])
    axes.set(ylim=(-3, 103), ylabel="problems right within that [%]")
    _legend(figure, names)
    return figure


def digits_time(data: Mapping[str, Any]) -> Figure:
    """Median digits against median time, a line a solver, a mark a setting."""
    lines = data["lines"]
    pen = pens(list(lines))
    figure, axes = plt.subplots(figsize=(PAGE, 3.4), layout="constrained")
    for label, points in lines.items():
        set_ = [(1e3 * t, right) for own, t, right in points if not own]
        own = [(1e3 * t, right) for own, t, right in points if own]
        kinds: Any = (set_, "none", {}), (set_[-1:], "full", POINT), (own, "left", POINT)
        # An empty line that is not clipped has no extent, which upsets the layout.
        for part, fill, more in (kind for kind in kinds if kind[0]):
            dress = pen[label] | more | {"fillstyle": fill, "clip_on": False}
            axes.plot(*np.transpose(part), **dress)
    axes.set(xscale="log", xlabel="median time of a call [ms]", title=data["title"])
    label = r"median correct digits of $\delta q$ [-]"
    axes.set(ylim=(0, 16.5), yticks=range(0, 17, 4), ylabel=label)
    _legend(figure, list(lines))
    return figure


def kept_digits(data: Mapping[str, Any]) -> Figure:
    """Digits of kept tolerances, a row a family: from the 5th percentile to the median."""
    families = list(data["lines"])
    settings = data["settings"]
    pen = pens(settings)
    figure, axes = plt.subplots(figsize=(PAGE, 0.9 + 0.3 * len(families)), layout="constrained")
    for k, setting in enumerate(settings):
        dress = pen[setting] | {"markerfacecolor": "white"}
        for row, family in enumerate(families):
            low, median = data["lines"][family][2 * k : 2 * k + 2]
            if median != "-":
                at = row + 0.18 * (k - (len(settings) - 1) / 2)
                axes.plot([float(low), float(median)], [at, at], **dress, markevery=[1])
    axes.set(xlim=(0, 16.5), xlabel=r"correct digits of $\delta q$ [-]", ylim=(len(families), -1))
    axes.set_yticks(range(len(families)), [family.replace("_", " ") for family in families])
    _legend(figure, list(settings))
    return figure


def sweep(data: Mapping[str, Any]) -> Figure:
    """Two measures against a parameter, a line a value of the second one."""
    lines = data["lines"]
    pen = pens(list(lines))
    figure, grid = plt.subplots(1, 2, figsize=(PAGE, 2.7), layout="constrained")
    first = [value for points in lines.values() for value, *_ in points]
    words = [v for v in dict.fromkeys(first) if isinstance(v, str)]
    for k, (axes, label) in enumerate(zip(grid, data["panels"], strict=True)):
        for name, points in lines.items():
            at = [words.index(p[0]) if words else p[0] for p in points]
            own = pen[name] | ({"linestyle": ""} if words else {})
            axes.plot(at, [p[1 + k] for p in points], **own, fillstyle="none")
        if words:
            axes.set_xticks(range(len(words)), words)
            axes.set_xlim(-0.5, len(words) - 0.5)
        top = 1.08 * max(p[1 + k] for points in lines.values() for p in points) or 1
        what, _, unit = label.rpartition("_")
        axes.set(ylim=(0, top), xlabel=data["axis"], ylabel=f"{what} [{unit}]")
    if len(lines) > 1:
        grid[0].legend()
    return figure


def _legend(figure: Figure, names: list[str]) -> None:
    """A legend below the axes."""
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
