"""Figures of sweeps: rotation and boundary layer against a parameter."""

from collections.abc import Mapping
from typing import Any

from matplotlib import pyplot as plt
from matplotlib.figure import Figure

from quasistatic_ref.lab.figures.line_styles import pens
from quasistatic_ref.optional.show.figures.style import PAGE

PANELS = ("largest rotation [deg]", r"boundary layer [$\mu$m]")


def sweep(data: Mapping[str, Any]) -> Figure:
    """Two panels; a line a value of the second axis."""
    lines = data["lines"]
    pen = pens(list(lines))
    figure, grid = plt.subplots(1, 2, figsize=(PAGE, 2.7), layout="constrained")
    first = [value for points in lines.values() for value, *_ in points]
    words = [v for v in dict.fromkeys(first) if isinstance(v, str)]
    for k, (axes, label) in enumerate(zip(grid, PANELS, strict=True)):
        for name, points in lines.items():
            at = [words.index(p[0]) if words else p[0] for p in points]
            own = pen[name] | ({"linestyle": ""} if words else {})
            axes.plot(at, [p[1 + k] for p in points], **own, fillstyle="none")
        if words:
            axes.set_xticks(range(len(words)), words)
            axes.set_xlim(-0.5, len(words) - 0.5)
        top = 1.08 * max(p[1 + k] for points in lines.values() for p in points) or 1
        axes.set(ylim=(0, top), xlabel=data["axis"], ylabel=label)
    if len(lines) > 1:
        grid[0].legend()
    return figure
