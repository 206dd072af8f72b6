"""A second opinion as bars: what contacts bear and how bodies move, by both."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from quasistatic_ref.optional.show.figures.style import figure_style, panels

MOST = 12
"""Most contacts or bodies that are drawn: those with the largest numbers."""


def opinion_figure(opinion: Any) -> Figure:
    """Normal forces, shares of the limit, and speeds of bodies: MuJoCo's and the exact ones.

    Parameters
    ----------
    opinion : Opinion
        Of ``mujoco_opinion``.
    """
    contacts = sorted(opinion.contacts, key=lambda c: -c.theirs.normal)[:MOST]
    bodies = sorted(opinion.bodies, key=lambda b: -b.fastest(b.theirs))[:MOST]
    names = [c.name for c in contacts]
    exact = [c.exact for c in contacts]
    count = max(len(contacts), len(bodies), 2)
    with figure_style():
        figure, (forces, shares, speeds) = panels(6.3, 1.3 + 0.3 * count, columns=3)
        _bars(forces, names, [c.theirs.normal for c in contacts],
              [np.nan if one is None else one.normal for one in exact])  # fmt: skip
        forces.set(xlabel="normal force [N]")
        _bars(shares, None, [c.theirs.share for c in contacts],
              [np.nan if one is None else one.share for one in exact])  # fmt: skip
        shares.set(xlabel="share of the limit of friction", xlim=(0, 1.05))
        shares.axvline(1.0, color="black", linestyle=":", linewidth=1)
        least = 1e3 * opinion.tolerance
        _bars(speeds, [b.name for b in bodies], [1e3 * b.fastest(b.theirs) for b in bodies],
              [1e3 * b.fastest(b.exact) for b in bodies])  # fmt: skip
        speeds.set_xscale("symlog", linthresh=least)
        speeds.set(xlabel="speed of the body [mm/s]", xlim=(0, None))
        speeds.axvline(least, color="black", linestyle=":", linewidth=1)
        figure.legend(*forces.get_legend_handles_labels(), loc="outside upper right", ncols=2)
    return figure


def _bars(
    axes: Axes, names: Sequence[str] | None, theirs: Sequence[float], exact: Sequence[float]
) -> None:  # fmt: skip
    """Two bars for each name, the first at the top."""
    places = np.arange(len(theirs))
    axes.barh(places - 0.2, theirs, 0.36, label="MuJoCo")
    axes.barh(places + 0.2, exact, 0.36, label="exact", hatch="//", edgecolor="white")
    axes.set_yticks(places, labels=[""] * len(places) if names is None else names)
    axes.invert_yaxis()
    axes.grid(axis="y", visible=False)
