"""The figures of a study: digits, times, and what papers show of both."""

from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib import pyplot as plt
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from quasistatic_ref.lab.figures.line_styles import pens
from quasistatic_ref.optional.show.figures.style import PAGE, closed
from quasistatic_ref.text.content import written_whole

DEFAULT = "default"
"""The setting whose marks are half-filled where others stand beside it."""
UNFILLED = {"markerfacecolor": "white"}
HALF = {"fillstyle": "left", "linestyle": ""}


def figures_written(folder: Path, points: Any, reached: Any, ratios: Any) -> list[Path]:
    """Draw the figures of what has any lines, as PNG.

    Parameters
    ----------
    folder : Path
    points, reached, ratios : pandas.DataFrame
        What ``digits_time`` and ``shifted_means``, ``reached_digits``, and ``performance_profile``
        draw.
    """
    drawn = (
        (digits_time, points),
        (reached_digits, reached),
        (performance_profile, ratios),
        (shifted_means, points),
    )
    paths = []
    for draw, table in drawn:
        if len(table):
            figure = draw(table)
            path = folder / f"{draw.__name__}.png"
            with closed(figure):
                paths.append(written_whole(path, partial(figure.savefig, dpi=200)))
    return paths


def digits_time(table: Any) -> Figure:
    """Median digits against median time, a line a solver and a mark a setting.

    Parameters
    ----------
    table : pandas.DataFrame
        Columns ``label``, ``setting`` (in the order of accuracy), ``digits`` [-] and ``ms``.
    """
    pen = pens(list(dict.fromkeys(table["label"])))
    figure, axes = plt.subplots(figsize=(PAGE, 4.6), layout="constrained")
    handles = []
    for name, points in table.groupby("label", sort=False):
        default = points["setting"] == DEFAULT
        line = UNFILLED if len(points[~default]) > 1 else UNFILLED | {"linestyle": ""}
        kinds: Any = (points[default], HALF), (points[~default], line)
        for part, looks in kinds:
            if len(part):
                dress = pen[str(name)] | looks
                axes.plot(part["ms"], part["digits"], **dress | {"clip_on": False})
        handles.append(Line2D([], [], **dress))
    if 0 < (table["setting"] == DEFAULT).sum() < len(table):
        grey: dict[str, Any] = {"marker": "o", "color": "0.45", "label": f"setting {DEFAULT}"}
        handles.append(Line2D([], [], **grey | HALF))
    axes.set(xscale="log", xlabel="median time of a call [ms]", ylim=(0, 16.5))
    axes.set(yticks=range(0, 17, 4), ylabel="median correct digits of x [-]")
    _legend(figure, handles)
    return figure


def reached_digits(table: Any) -> Figure:
    """Digits of answers that reached their accuracy, a row a family and a line a setting.

    Parameters
    ----------
    table : pandas.DataFrame
        Columns ``family``, ``setting``, ``low`` (5th percentile) and ``median`` [-].
    """
    families = sorted(set(table["family"]))
    settings = list(dict.fromkeys(table["setting"]))
    pen = pens(settings)
    figure, axes = plt.subplots(figsize=(PAGE, 0.9 + 0.3 * len(families)), layout="constrained")
    for one in table.itertuples():
        k = settings.index(one.setting)
        at = families.index(one.family) + 0.18 * (k - (len(settings) - 1) / 2)
        dress = pen[one.setting] | {"markerfacecolor": "white", "markevery": [1]}
        axes.plot([one.low, one.median], [at, at], **dress)
    axes.set(xlim=(0, 16.5), ylim=(len(families), -1))
    axes.set_xlabel("correct digits of x, from the 5th percentile to the median [-]")
    axes.set_yticks(range(len(families)), [family.replace("_", " ") for family in families])
    _legend(figure, [Line2D([], [], **pen[name], markerfacecolor="white") for name in settings])
    return figure


def performance_profile(table: Any) -> Figure:
    """Shares of problems that are solved within factors of the fastest time, a line a solver.

    Parameters
    ----------
    table : pandas.DataFrame
        Columns ``label`` and ``ratio``, of times [-], infinite where a problem is not solved.
    """
    pen = pens(list(dict.fromkeys(table["label"])))
    finite = table["ratio"][np.isfinite(table["ratio"])]
    end = 1.2 * finite.max() if len(finite) else 10.0
    figure, axes = plt.subplots(figsize=(PAGE, 4.4), layout="constrained")
    handles = []
    for name, calls in table.groupby("label", sort=False):
        solved = np.sort(calls["ratio"][np.isfinite(calls["ratio"])])
        shares = 100 * np.arange(len(solved) + 1) / len(calls)
        dress = pen[str(name)] | UNFILLED | {"markevery": [1 + len(solved) // 2]}
        steps = np.concatenate([[1.0], solved, [end]])
        axes.plot(steps, [*shares, shares[-1]], drawstyle="steps-post", **dress)
        handles.append(Line2D([], [], **pen[str(name)] | UNFILLED))
    axes.set(xscale="log", xlim=(0.9, end), xlabel="time over that of the fastest solver [-]")
    axes.set(ylim=(0, 100), ylabel="problems solved with 6 digits [%]")
    _legend(figure, handles)
    return figure


def shifted_means(table: Any) -> Figure:
    """Shifted geometric means of times, a row a solver and a mark a setting.

    Parameters
    ----------
    table : pandas.DataFrame
        Columns ``label``, ``setting``, ``order`` of its accuracy, and ``mean`` [ms].
    """
    order = table.groupby("label")["mean"].min().sort_values()
    settings = list(dict.fromkeys(table.sort_values("order")["setting"]))
    rows = dict(zip(order.index, range(len(order)), strict=True))
    clear = {"markerfacecolor": "none", "linestyle": ""}  # marks may lie on each other
    pen = {name: one | clear for name, one in pens(settings).items()}
    figure, axes = plt.subplots(figsize=(PAGE, 1.2 + 0.24 * len(rows)), layout="constrained")
    for name, points in table.groupby("setting", sort=False):
        axes.plot(points["mean"], points["label"].map(rows), **pen[str(name)])
    axes.set(xscale="log", ylim=(len(rows), -1), xlabel="shifted geometric mean of times [ms]")
    axes.set_yticks(range(len(rows)), order.index)
    _legend(figure, [Line2D([], [], **pen[name]) for name in settings])
    return figure


def _legend(figure: Figure, handles: Sequence[Line2D]) -> None:
    """A legend below the axes."""
    figure.legend(handles=handles, loc="outside lower center", ncols=3, handlelength=2.6,
                  columnspacing=1.0)  # fmt: skip
