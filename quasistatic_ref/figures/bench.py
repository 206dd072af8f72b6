"""Figure 4 of the paper: where the time of a step goes, by engine and backend."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib import pyplot as plt
from matplotlib.figure import Figure

from quasistatic_ref.figures.style import figure_style
from quasistatic_ref.study.bench.acceptance import PAPER

PARTS = {
    "distances": "0.25", "selection": "0.0", "rows": "0.55", "solve": "0.75", "integrate": "0.92"
}  # fmt: skip
"""Parts of a step, and their greys."""


def step_times(tables: Mapping[str, Any]) -> Figure:
    """Stacked bars of the parts, shortest step first, and the paper's time."""
    rows = sorted(tables["parts"], key=lambda row: -row["step"])
    rows = [row for row in rows if np.isfinite(row["step"])]
    with figure_style():
        figure, axes = plt.subplots(figsize=(5.6, 0.5 + 0.22 * len(rows)))
        left = np.zeros(len(rows))
        for part, grey in PARTS.items():
            width = np.array([row[part] for row in rows])
            axes.barh(range(len(rows)), width, left=left, color=grey, label=part, edgecolor="0.2",
                      linewidth=0.4)  # fmt: skip
            left += width
        axes.axvline(PAPER, color="black", linestyle=":", linewidth=1)
        axes.annotate("the paper", (PAPER, len(rows) - 0.4), fontsize=6, ha="center")
        axes.set_xscale("log")
        axes.set_xlim(left=10)
        axes.set_yticks(
            range(len(rows)), [f"{row['backend']}, {row['engine']}" for row in rows], fontsize=6
        )
        axes.set_xlabel("time of a 13 x 80 step [us], nothing certified")
        axes.legend(fontsize=6, loc="lower right")
        figure.tight_layout()
    return figure
