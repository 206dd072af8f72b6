"""How the time of a `fast` step grows with the number of boxes that slide on a floor."""

from collections.abc import Mapping

import numpy as np

from docs.drawings.labels import label_axes
from quasistatic_ref.lab.figures.line_styles import MARKS
from quasistatic_ref.optional.show.figures import Figure, panels, scaled

MEASURED: Mapping[str, Mapping[int, float]] = {
    "proved": {1: 2.29, 3: 4.76, 10: 15.1, 30: 42.9, 100: 191, 300: 518, 1000: 1850},
    "unproved": {1: 0.43, 3: 0.36, 10: 0.50, 30: 0.81, 100: 3.2, 300: 7.4, 1000: 24},
}
"""Processor time of a step [ms] by the number of boxes: the least of some steps, in one thread of
an AMD EPYC (2 cores of a virtual machine)."""


def figure(*, measured: Mapping[str, Mapping[int, float]] = MEASURED) -> Figure:
    """The time of a step over the number of boxes.

    Parameters
    ----------
    measured : mapping of str to mapping of int to float
        Of each kind of step its times [ms].
    """
    page, (axes,) = panels(4.4, 3.4)
    for mark, (kind, times) in zip(MARKS, measured.items(), strict=False):
        axes.plot(
            [*times], [*times.values()], color="black", marker=mark, markersize=scaled(4.5),
            markerfacecolor="white", label=kind,
        )  # fmt: skip
    ends = np.array([1, max(measured["unproved"])])
    each = measured["unproved"][int(ends[1])] / ends[1]
    axes.plot(ends, each * ends, "--", color="0.6", label="in proportion to the number")
    axes.set_xscale("log")
    axes.set_yscale("log")
    label_axes(axes, "boxes on a floor", "time of a step [ms]")
    return page
