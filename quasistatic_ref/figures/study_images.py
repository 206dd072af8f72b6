"""The pictures of a report, drawn: as PNG beside a page and as SVG inside one."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from io import BytesIO
from typing import Any, Final

from matplotlib import pyplot as plt
from matplotlib.figure import Figure

from quasistatic_ref.figures.study import digits_time, families, profiles, success
from quasistatic_ref.figures.study_sweep import sweep
from quasistatic_ref.figures.style import figure_style
from quasistatic_ref.study.page import Picture

KINDS: Final[dict[str, Callable[[Mapping[str, Any]], Figure]]] = {
    draw.__name__: draw for draw in (profiles, success, digits_time, families, sweep)
}


def drawn(picture: Picture) -> Figure:
    """The figure of a picture, in the common style."""
    with figure_style("paper"):
        return KINDS[picture.kind](picture.data)


def images(picture: Picture) -> dict[str, bytes]:
    """``"png"`` and ``"svg"`` of a picture: equal bytes for equal data."""
    found = {}
    with figure_style("paper"):
        figure = drawn(picture)
        for kind, metadata in (("png", None), ("svg", {"Date": None})):
            stream = BytesIO()
            figure.savefig(stream, format=kind, metadata=metadata)
            found[kind] = stream.getvalue()
    plt.close(figure)
    return found
