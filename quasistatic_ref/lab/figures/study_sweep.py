"""Figures of sweeps: rotation and boundary layer against a parameter, what holds and slips."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib import pyplot as plt
from matplotlib.figure import Figure

from quasistatic_ref.figures.style import PAGE, figure_style, scaled, sized
from quasistatic_ref.lab.figures.study_pens import pens
from quasistatic_ref.step.data import Array, Mask

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


def hold_map(mu_v: Array, mu_omega: Array, held: Mask, line_v: Array, line: Array) -> Figure:
    """Which runs of a grid hold, and the least mu_omega in closed form.

    Parameters
    ----------
    mu_v, mu_omega : ndarray, shapes (V,) and (W,)
        What was swept [-], [m].
    held : ndarray of bool, shape (V, W)
        [-].
    line_v, line : ndarray, shape (N,)
        mu_v and the least mu_omega [-], [m].
    """
    with figure_style():
        figure, axes = plt.subplots(figsize=sized(4.8, 3.6))
        grid_v, grid_w = np.meshgrid(mu_v, 1e3 * mu_omega, indexing="ij")
        style: dict[str, Any] = {"linestyle": "none", "color": "black", "markersize": scaled(3)}
        axes.plot(grid_v[held], grid_w[held], "s", label="holds", **style)
        axes.plot(grid_v[~held], grid_w[~held], "o", label="slips", markerfacecolor="none",
                  markeredgewidth=0.5, **style)  # fmt: skip
        shown = line <= mu_omega[-1]
        axes.plot(line_v[shown], 1e3 * line[shown], color="tab:blue", label="(R21)")
        axes.set(xlabel=r"$\mu_v$ [-]", ylabel=r"$\mu_\omega$ [mm]")
        axes.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=3)
    return figure
