"""Looks of figures for papers, slides and posters; where figures are drawn; writing them."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from functools import partial
from pathlib import Path
from typing import Any, Final

import numpy as np
from matplotlib import pyplot as plt
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.backend_bases import RendererBase
from matplotlib.figure import Figure
from matplotlib.legend import Legend
from matplotlib.transforms import Bbox

from quasistatic_ref.errors import InputError
from quasistatic_ref.quoting import suggestion
from quasistatic_ref.text.content import written_whole

PAGE: Final = 6.3
"""Width of the text on a page [in]: A4 or letter with the usual margins."""

TEXT: Final = 9.0
"""Size of text in the style for paper [pt], in which the sizes of figures are given."""

STYLES: Final = ("paper", "slides", "poster")
"""Styles that come along, each a file of rcParams next to this module."""

METADATA: Final = {"png": None, "pdf": {"CreationDate": None}}
"""What files of each format say of their making: the same figure has the same bytes."""
_current: ContextVar[str | Path] = ContextVar("figure style", default="paper")

ABOVE_AXES: Final = 0.85
"""Share of a cell's width that is above the axes, not above the labels at its side [-]."""


@contextmanager
def figure_style(name: str | Path | None = None) -> Iterator[None]:
    """Draw in one of the styles inside this block.

    Parameters
    ----------
    name : str or Path, optional
        One of ``STYLES``, one of matplotlib's own, or a file of rcParams such as
        ``"my.mplstyle"``; that of the enclosing block by default, or else paper.

    Raises
    ------
    InputError
        If there is no such style.
    """
    chosen = _current.get() if name is None else name
    context = plt.style.context(style_file(chosen))
    token = _current.set(chosen)
    try:
        with context:
            yield
    finally:
        _current.reset(token)


def style_file(name: str | Path) -> str | Path:
    """The rcParams of a style, for ``matplotlib.pyplot.style.use`` in figures of one's own.

    Raises
    ------
    InputError
        If there is no such style.
    """
    if str(name) in STYLES:
        return Path(__file__).parent / f"{name}.mplstyle"
    if name in (*plt.style.available, "default"):
        return name
    if Path(name).is_file():
        return Path(name)
    problem = f"is not a style{suggestion(str(name), STYLES)}"
    raise InputError(problem, field="style", value=str(name))


def sized(width: float, height: float) -> tuple[float, float]:
    """Size of a figure [in] that is `width` x `height` on paper, under the present rcParams.

    It grows with ``font.size``, and is no wider than ``figure.figsize``. Where text is larger than
    on paper it is no higher either: it is shown as high as a slide, whose text stays readable.
    """
    widest, highest = map(float, plt.rcParams["figure.figsize"])
    if scaled(1.0) > 1.0:
        height = min(height, highest / scaled(1.0))
    return min(scaled(width), widest), scaled(height)


def scaled(size: float) -> float:
    """A `size` on paper [pt or in], in proportion to the present rcParams' text [the same]."""
    return size * float(plt.rcParams["font.size"]) / TEXT


def panels(
    width: float = 4.6, height: float = 2.8, columns: int = 1, *, rows: int = 1, **options: Any
) -> tuple[Figure, list[Any]]:
    """A figure with axes in a grid.

    Parameters
    ----------
    width, height : float
        Of the figure, on paper [in].
    columns, rows : int
    options
        Further arguments of ``matplotlib.pyplot.subplots``.

    Returns
    -------
    tuple of Figure and list of Axes
        The axes row by row.
    """
    figure, grid = plt.subplots(
        rows, columns, squeeze=False, figsize=sized(width, height), layout="constrained", **options
    )
    return figure, list(grid.flat)


def room(axes: Axes) -> tuple[float, float]:
    """Width and height of the cell that axes and their labels have in a grid [pixels]."""
    spec = axes.get_subplotspec()
    parent = axes.get_figure(root=False)
    assert parent is not None
    whole = np.array(parent.bbox.size)
    if spec is None:
        place = axes.get_position()
        return float(whole[0] * place.width), float(whole[1] * place.height)
    rows, columns = spec.get_gridspec().get_geometry()
    width, height = whole * [len(spec.colspan) / columns, len(spec.rowspan) / rows]
    return float(width), float(height)


@contextmanager
def closed(figure: Figure) -> Iterator[None]:
    """Closes a figure at the end, also after an error.

    Parameters
    ----------
    figure : Figure
    """
    try:
        yield
    finally:
        plt.close(figure)


def figure_written(
    figure: Figure, folder: str | Path, name: str, kinds: Sequence[str] = ("png", "pdf")
) -> list[Path]:
    """Write a figure in each format, whole or not at all, and close it, also after an error.

    Parameters
    ----------
    figure : Figure
    folder : str or Path
    name : str
        Of the files, without their ends.
    kinds : sequence of str
        Of ``METADATA``; each format draws the figure once.

    Returns
    -------
    list of Path
    """
    paths = []
    with figure_style(), closed(figure):
        for kind in kinds:
            save = partial(figure.savefig, format=kind, metadata=METADATA[kind])
            paths.append(written_whole(Path(folder) / f"{name}.{kind}", save))
    return paths


def legend_above(axes: Axes, handles: Sequence[Artist], title: str = "") -> None:
    """A legend above axes, in as few lines as fit the cell of the grid that they stand in.

    A title that the axes get later stands above it.

    Parameters
    ----------
    axes : Axes
    handles : sequence of Artist
        With their labels.
    title : str
        Above the entries.
    """
    for columns in range(len(handles), 0, -1):
        legend = axes.legend(
            handles=handles, title=title, ncols=columns,
            loc="lower center", bbox_to_anchor=(0.5, 1.0), columnspacing=1.0,
            handlelength=1.8, borderaxespad=0.2,
        )  # fmt: skip
        if columns == 1 or legend.get_window_extent().width <= ABOVE_AXES * room(axes)[0]:
            _lift_title(axes, legend)
            return


def _lift_title(axes: Axes, legend: Legend) -> None:
    """Keep the title of axes clear of a legend above them, by an empty inset in its place."""
    inside = axes.inset_axes((0.0, 1.0, 1.0, 0.0))
    inside.set_axis_off()
    page: Any = axes.get_figure(root=False)

    def place(_: object, renderer: RendererBase) -> Bbox:
        extent = legend.get_window_extent(renderer)
        return Bbox(extent.transformed(page.transSubfigure.inverted()))

    inside.set_axes_locator(place)
