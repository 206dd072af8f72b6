"""The figures of claims, each drawn from what was measured for it."""

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from quasistatic_ref.lab.figures.labels import caption, label_axes, legend_below
from quasistatic_ref.optional.show.figures.style import panels, scaled

Picture = Mapping[str, Any]
GREYS = ("0.2", "0.42", "0.64", "0.82", "1.0")


def grasp(picture: Picture) -> Figure:
    """Rotation of the bunny during the lift."""
    figure, (axes,) = panels(4.6, 2.8)
    for case, angle in picture["angles"].items():
        axes.plot(picture["times"], angle, label=case)
    label_axes(axes, "time t [s]", "rotation since the grip closed [deg]", caption(picture["h"]))
    return figure


def step_time(picture: Picture) -> Figure:
    """Parts of a step by backend, stacked."""
    figure, (axes,) = panels(6.3, 3.4)
    profiles = picture["profiles"]
    at = -np.arange(len(profiles))
    times = np.array([list(p.typical.values()) for p in profiles])
    whole = times.sum(axis=1)
    shares = 100 * times / whole[:, None]
    left = np.zeros(len(profiles))
    for part, width, grey in zip(profiles[0].typical, shares.T, GREYS, strict=True):
        axes.barh(at, width, 0.8, left=left, label=part, color=grey, edgecolor="black",
                  linewidth=scaled(0.5))  # fmt: skip
        left += width
    axes.axvline(50, color="black", linestyle=":", linewidth=scaled(1.2))
    for y, p, total in zip(at, profiles, whole, strict=True):
        text = f"{100 * p.solve:.0f} % of {_duration(total)}"
        axes.annotate(text, (102, y), va="center", annotation_clip=False)
    axes.set_yticks(at, [p.backend.replace("qpsolvers:", "qpsolvers:\n") for p in profiles])
    axes.grid(False)
    axes.set(xlim=(0, 100), xticks=range(0, 101, 25))
    label_axes(
        axes, "share of the time of a step, medians [%]", title=caption(picture["h"]), key=False
    )
    words = f"all {picture['all']} distances in each step; right: share of the solve"
    legend_below([axes], axes.get_legend_handles_labels()[0], words)
    return figure


def _duration(microseconds: float) -> str:
    ms = microseconds >= 1000
    return f"{microseconds / 1000:.1f} ms" if ms else rf"{microseconds:.0f} $\mu$s"


PICTURES: dict[str, Callable[..., Figure]] = {"grasp": grasp, "step_time": step_time}
"""Claim -> its figure, of what was measured."""
