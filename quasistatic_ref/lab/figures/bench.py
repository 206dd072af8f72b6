"""Figure 4 of the paper: where the time of a step goes, by interface and backend."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib import pyplot as plt
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from quasistatic_ref.optional.show.figures.style import figure_style

PARTS = {
    "distances": "0.25", "selection": "0.0", "rows": "0.55", "solve": "0.75", "integrate": "0.92"
}  # fmt: skip
"""Parts of a step, and their greys."""


def step_times(tables: Mapping[str, Any], paper: float) -> Figure:
    """Stacked bars of the parts, one panel for each interface, and the `paper`'s time [us].

    Lengths are to be compared, so the axes begin at zero; the interfaces differ too much for one.
    """
    rows = [row for row in tables["parts"] if np.isfinite(row["step"])]
    engines = [[row for row in rows if row["engine"] == name] for name in ("native", "cvxpy")]
    engines = [sorted(some, key=lambda row: -row["step"]) for some in engines if some]
    with figure_style():
        figure, panels = plt.subplots(
            len(engines), figsize=(5.6, 1.6 + 0.22 * len(rows)), squeeze=False,
            height_ratios=[1 + len(some) for some in engines], layout="constrained",
        )  # fmt: skip
        for axes, some in zip(panels[:, 0], engines, strict=True):
            _bars(axes, some, paper)
            axes.set_title(f"interface: {some[0]['engine']}", fontsize=7, loc="left")
        axes.set_xlabel("time of a 13 x 80 step [us], nothing certified")
        handles, labels = axes.get_legend_handles_labels()
        figure.legend(handles, labels, fontsize=6, loc="outside upper center", ncols=len(labels))
    return figure


def _bars(axes: Axes, rows: Sequence[Mapping[str, Any]], paper: float) -> None:
    left = np.zeros(len(rows))
    for part, grey in PARTS.items():
        width = np.array([row[part] for row in rows])
        axes.barh(range(len(rows)), width, left=left, color=grey, label=part, edgecolor="0.2",
                  linewidth=0.4)  # fmt: skip
        left += width
    said = f"the paper's {paper:g} us"
    axes.axvline(paper, color="black", linestyle=":", linewidth=1, label=said)
    axes.set_axisbelow(True)
    axes.grid(False, axis="y")
    axes.set_yticks(range(len(rows)), [row["backend"] for row in rows], fontsize=6)
