"""The pictures of a report, drawn: as PNG next to a page and as SVG inside one."""

from collections.abc import Callable, Mapping
from io import BytesIO
from typing import Any

from matplotlib import pyplot as plt
from matplotlib.figure import Figure

from quasistatic_ref.lab.figures.study import digits_time, kept_digits, profiles, sweep
from quasistatic_ref.optional.show.figures.style import figure_style

KINDS: dict[str, Callable[[Mapping[str, Any]], Figure]] = {
    draw.__name__: draw for draw in (profiles, digits_time, kept_digits, sweep)
}


def figure_of(kind: str, data: Mapping[str, Any]) -> Figure:
    """A figure of some kind, in the common style."""
    with figure_style("paper"):
        return KINDS[kind](data)


def images(kind: str, data: Mapping[str, Any]) -> dict[str, bytes]:
    """``"png"`` and ``"svg"`` of a figure: equal bytes for equal data."""
    found = {}
    with figure_style("paper"):
        figure = figure_of(kind, data)
        for suffix, metadata in (("png", None), ("svg", {"Date": None})):
            stream = BytesIO()
            figure.savefig(stream, format=suffix, metadata=metadata)
            found[suffix] = stream.getvalue()
    plt.close(figure)
    return found
