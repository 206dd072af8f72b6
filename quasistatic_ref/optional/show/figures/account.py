"""The figure of an account: what touches and slides, loads, slips, and motions, over time."""

from __future__ import annotations

from io import BytesIO
from typing import TYPE_CHECKING, Final

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.optional.show.figures.style import PAGE, figure_style, panels

if TYPE_CHECKING:
    from quasistatic_ref.optional.doctor.accounts import Account

MILLI: Final = 1e3
BAR: Final = 0.3
"""Height of the bar of a pair [in]."""
PANEL: Final = 1.3
"""Height of a panel with lines [in]."""
MOST: Final = 8
"""Most lines of a panel: those that reach farthest."""
HEIGHTS: Final = {"touches": 0.3, "slides": 0.6, "spins": 0.8}
"""Of bars, over the height of a pair's row [-]."""
COLOURS: Final = {"touches": "0.75", "slides": "C1", "spins": "black"}
"""They differ in grey, too."""


def page(account: Account) -> bytes:
    """The figure as PNG, as wide as a page of text.

    Parameters
    ----------
    account : Account
    """
    with figure_style("paper"):
        drawn = figure(account)
        file = BytesIO()
        drawn.savefig(file, format="png", dpi=150, metadata={"Software": None})
        plt.close(drawn)
    return file.getvalue()


def figure(account: Account) -> Figure:
    """Bars of contacts; normal forces and slips of pairs; motions of bodies; errors of joints.

    Parameters
    ----------
    account : Account
    """
    t = account.t
    start = np.concatenate([[0.0], t])
    lines = {
        "normal force [N]": {p.name: (t, p.loads.normal) for p in account.pairs if p.loads},
        "slip [mm]": {
            p.name: (t, MILLI * np.cumsum(p.slip)) for p in account.pairs if p.slip is not None
        },
        "moved [mm]": {
            m.of.name: (start, MILLI * np.linalg.norm(m.moved, axis=1)) for m in account.motions
        },
        "turned [deg]": {m.of.name: (start, np.degrees(m.turned)) for m in account.motions},
        "off target [mm]": {
            d.of.name: (t, MILLI * d.error) for d in account.drives if d.unit == "m"
        },
        "off target [deg]": {
            d.of.name: (t, np.degrees(d.error)) for d in account.drives if d.unit == "rad"
        },
    }
    lines = {label: each for label, each in lines.items() if _matters(each)}
    bars = max(len(account.pairs), 1)
    heights = [BAR * bars + 0.4, *[PANEL] * len(lines)]
    drawn, axes = panels(PAGE, sum(heights), rows=len(heights), sharex=True, height_ratios=heights)
    _contacts(axes[0], account)
    for place, (label, each) in zip(axes[1:], lines.items(), strict=True):
        for name, (time, values) in _farthest(each):
            place.plot(time, values, label=name)
        place.set_ylabel(label)
        place.legend(fontsize="x-small", loc="center left", bbox_to_anchor=(1, 0.5), frameon=False)
    axes[-1].set_xlabel("t [s]")
    return drawn


def _contacts(axes: Axes, account: Account) -> None:
    """A row a pair: a thin bar while it touches, thicker ones while it slides or spins."""
    for word, height in reversed(HEIGHTS.items()):
        for row, pair in enumerate(account.pairs):
            starts = account.t[getattr(pair, word)] - account.h
            parts = [(start, account.h) for start in starts]
            label = word if row == 0 else None
            axes.broken_barh(
                parts, (row - height / 2, height), color=COLOURS[word], lw=0, label=label
            )
    axes.set_yticks(range(len(account.pairs)), [pair.name for pair in account.pairs])
    axes.tick_params(axis="y", labelsize="x-small")
    axes.set_ylim(len(account.pairs) - 0.5, -0.5)
    axes.legend(fontsize="x-small", loc="center left", bbox_to_anchor=(1, 0.5), frameon=False)


def _matters(lines: dict[str, tuple[Array, Array]]) -> bool:
    return any(np.abs(values).max(initial=0.0) > 0 for _, values in lines.values())


def _farthest(lines: dict[str, tuple[Array, Array]]) -> list[tuple[str, tuple[Array, Array]]]:
    return sorted(lines.items(), key=lambda line: -float(np.abs(line[1][1]).max()))[:MOST]
