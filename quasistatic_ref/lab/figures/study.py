"""The figures of a study: digits against time, and digits where the accuracy was reached."""

from functools import partial
from pathlib import Path
from typing import Any

from matplotlib import pyplot as plt
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from quasistatic_ref.files.content import written_whole
from quasistatic_ref.lab.figures.line_styles import pens
from quasistatic_ref.optional.show.figures.style import PAGE


def figures_written(folder: Path, points: Any, reached: Any) -> list[Path]:
    """Draw both figures of what has any lines, as PNG.

    Parameters
    ----------
    folder : Path
    points, reached : pandas.DataFrame
        What ``digits_time`` and ``reached_digits`` draw.
    """
    paths = []
    for draw, table in ((digits_time, points), (reached_digits, reached)):
        if len(table):
            figure = draw(table)
            path = folder / f"{draw.__name__}.png"
            paths.append(written_whole(path, partial(figure.savefig, dpi=200)))
            plt.close(figure)
    return paths


def digits_time(table: Any) -> Figure:
    """Median digits against median time, a line a solver and a mark a setting.

    Parameters
    ----------
    table : pandas.DataFrame
        Columns ``label``, ``setting`` (in the order of accuracy), ``digits`` [-] and ``ms``.
    """
    names = list(dict.fromkeys(table["label"]))
    pen = pens(names)
    figure, axes = plt.subplots(figsize=(PAGE, 4.4), layout="constrained")
    for name, points in table.groupby("label", sort=False):
        default = points["setting"] == "default"
        kinds: Any = (points[~default], "none", {}), (points[default], "left", {"linestyle": ""})
        for part, fill, more in kinds:
            if len(part):
                dress = pen[str(name)] | more | {"fillstyle": fill, "clip_on": False}
                axes.plot(part["ms"], part["digits"], **dress)
    axes.set(xscale="log", xlabel="median time of a call [ms]", ylim=(0, 16.5))
    axes.set(yticks=range(0, 17, 4), ylabel=r"median correct digits of $\delta q$ [-]")
    _legend(figure, names)
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
    axes.set(xlim=(0, 16.5), xlabel=r"correct digits of $\delta q$ [-]", ylim=(len(families), -1))
    axes.set_yticks(range(len(families)), [family.replace("_", " ") for family in families])
    _legend(figure, settings)
    return figure


def _legend(figure: Figure, names: list[str]) -> None:
    """A legend below the axes."""
    drawn = pens(names)
    handles = [Line2D([], [], **drawn[name], markerfacecolor="white") for name in names]
    figure.legend(handles, names, loc="outside lower center", ncols=3, handlelength=2.6,
                  columnspacing=1.0)  # fmt: skip
