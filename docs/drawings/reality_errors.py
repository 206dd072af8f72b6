"""Errors of each pair with intervals: this package, and the published simulator."""

import json
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes

from docs.drawings.labels import label_axes, legend_below
from docs.drawings.reality_identified import name_rows
from quasistatic_ref.optional.show.figures import Figure
from quasistatic_ref.optional.show.figures.style import panels, scaled
from validation.tools.scripts import RESULTS


def _spans(
    axes: Axes, entries: Sequence[Mapping[str, Any]], k: int, aside: float, **pen: Any
) -> None:
    """Means and their intervals of column k, one entry a line."""
    rows = np.arange(len(entries)) + aside
    low, mean, high = (np.array([e[key][k] for e in entries]) for key in ("low", "mean", "high"))
    axes.errorbar(mean, rows, xerr=[mean - low, high - mean], linestyle="", color="black",
                  markersize=scaled(3.5), elinewidth=scaled(0.8), **pen)  # fmt: skip


def figure() -> Figure:
    """The mean errors of all pairs."""
    record = json.loads((RESULTS / "reality.json").read_text("utf-8"))
    figure, both = panels(6.3, 4.8, columns=2)
    names = list(record["pairs"])
    entries = [record["pairs"][name] for name in names]
    for k, (axes, unit) in enumerate(zip(both, ("position [mm]", "rotation [deg]"), strict=True)):
        _spans(axes, [e["error"] for e in entries], k, -0.15, marker="o", label="ellipsoid, 95 %")
        _spans(axes, [e["published"] for e in entries], k, 0.15, marker="s", markerfacecolor="none",
               label="published simulator")  # fmt: skip
        shown = ["mean over pairs" if name == "all" else name for name in names]
        name_rows(axes, [""] * len(shown) if k else shown)
        axes.set_xlim(left=0)
        label_axes(axes, f"mean error of {unit}", key=False)
    legend_below(both, both[0].get_legend_handles_labels()[0])
    return figure
