"""What stands around the axes of a drawing, in as many lines as there is room for."""

from collections.abc import Sequence
from typing import Any

from quasistatic_ref.lab.figures.labels import fitted, wrapped
from quasistatic_ref.optional.show.figures.style import legend_above, room

LABEL = 0.8
"""Share of a cell that a label along an axis may take [-]."""


def label_axes(axes: Any, x: str = "", y: str = "", title: str = "", key: bool = True) -> None:
    """Label axes that have been drawn into, with their title and legend above them.

    Lines are broken where they are full, and the legend never covers what is drawn.

    Parameters
    ----------
    axes : Axes
    x, y, title : str
        None of it where it is empty.
    key : bool
        Whether to write a legend, of all that has a label.
    """
    width, height = (LABEL * size * 72 / axes.get_figure(root=True).dpi for size in room(axes))
    size = axes.xaxis.label.get_fontsize()
    axes.set(xlabel=wrapped(x, width / size), ylabel=wrapped(y, height / size))
    handles = axes.get_legend_handles_labels()[0] if key else []
    title = wrapped(title, width / axes.title.get_fontsize())
    if handles:
        legend_above(axes, handles, title)
    elif title:
        axes.set_title(title, loc="right")


def legend_below(grid: Sequence[Any], handles: Sequence[Any], title: str = "") -> None:
    """A legend below all axes of a figure, or of a part of one, in lines that fit it.

    Parameters
    ----------
    grid : sequence of Axes
    handles : sequence of Artist
        With their labels.
    title : str
        Above the entries.
    """
    part = grid[0].get_figure(root=False)
    across = part.bbox.width
    for columns in range(len(handles), 0, -1):
        legend = part.legend(
            handles=handles, ncols=columns, loc="outside lower center", columnspacing=1.0
        )
        if columns == 1 or legend.get_window_extent().width <= across:
            if title:
                legend.set_title(fitted(title, part, legend.get_title().get_fontsize()))
                legend.get_title().set_multialignment("center")
            return
        legend.remove()
