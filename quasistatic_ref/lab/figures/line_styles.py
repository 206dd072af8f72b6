"""Lines for many solvers, distinguished by dashes and marks, in colour and without."""

from collections.abc import Sequence
from typing import Any

COLOURS = (
    "#0072B2",
    "#D55E00",
    "#009E73",
    "black",
    "#CC79A7",
    "#56B4E9",
    "#B58900",
    "0.45",
    "#882255",
)
DASHES = ("-", "--", "-.", ":")
MARKS = ("o", "s", "^", "D", "v", "P", "X", "*", "<", ">", "h")


def pens(names: Sequence[str]) -> dict[str, dict[str, Any]]:
    """Name -> arguments of ``Axes.plot``; marks repeat after 11 names, with other dashes."""
    return {
        name: {
            "label": name,
            "color": COLOURS[k % len(COLOURS)],
            "linestyle": DASHES[k % len(DASHES)],
            "marker": MARKS[k % len(MARKS)],
            "markersize": 5,
            "markeredgecolor": COLOURS[k % len(COLOURS)],
            "linewidth": 1.2,
        }
        for k, name in enumerate(names)
    }
