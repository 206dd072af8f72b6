"""mu_omega / mu_v of each pair of object and surface: interval, published, uniform pressure."""

import json
from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes

from docs.drawings.labels import label_axes
from quasistatic_ref.optional.show.figures import Figure
from quasistatic_ref.optional.show.figures.style import panels, scaled
from validation.tools.scripts import RESULTS


def name_rows(axes: Axes, names: Sequence[str]) -> None:
    """Names at the left, the first at the top."""
    axes.set_yticks(range(len(names)), names)
    axes.set_ylim(len(names) - 0.4, -0.6)
    axes.grid(False, axis="y")


def _marks(axes: Axes, x: Any, y: Any, mark: str, size: float, label: str) -> None:
    axes.plot(x, y, linestyle="", marker=mark, markersize=scaled(size), color="black",
              markerfacecolor="none", label=label)  # fmt: skip


def figure() -> Figure:
    """The ratios of all pairs."""
    record = json.loads((RESULTS / "reality_identified.json").read_text("utf-8"))
    figure, (axes,) = panels(5.2, 4.6)
    rows = np.arange(len(record))
    pairs = list(record.values())
    ratio = 1e3 * np.array([e["ratio"] for e in pairs])
    ends = 1e3 * np.array([[e["low"], e["high"]] for e in pairs]).T
    axes.errorbar(ratio, rows, xerr=np.abs(ends - ratio), fmt="o", color="black",
                  markersize=scaled(3.5), label="identified, 95 %")  # fmt: skip
    _marks(axes, 1e3 * np.array([e["published"] for e in pairs]), rows, "s", 5.5, "published")
    _marks(axes, 1e3 * np.array([e["uniform"] for e in pairs]), rows, "|", 8, "uniform")
    name_rows(axes, list(record))
    axes.set_xlim(left=0)
    label_axes(axes, r"$\mu_\omega / \mu_v$ [mm]")
    return figure
