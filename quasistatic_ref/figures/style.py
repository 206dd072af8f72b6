"""The common looks of all figures, for papers and for slides, and writing them."""

import os
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from functools import partial, wraps
from pathlib import Path
from typing import Any, Final, ParamSpec

import matplotlib as mpl

if "matplotlib.pyplot" not in sys.modules and not os.environ.get("MPLBACKEND"):
    mpl.use("Agg")  # files need no window; a session that has chosen keeps its choice

from matplotlib import pyplot as plt
from matplotlib.figure import Figure

from quasistatic_ref.errors import InputError
from quasistatic_ref.files import written_whole
from quasistatic_ref.quoting import suggestion

PAGE: Final = 6.3
"""Width of the text on a page [in]: A4 or letter with the usual margins. No figure is wider."""

STYLES: Final[dict[str, float]] = {"paper": 1.0, "slides": 1.6}
"""Style -> how much larger than on paper its figures are; its text is larger still."""

FORMATS = ("png", "pdf")
Given = ParamSpec("Given")
_current: ContextVar[str] = ContextVar("figure style", default="paper")


@contextmanager
def figure_style(name: str | None = None) -> Iterator[None]:
    """Draw in one of the styles inside this block.

    Parameters
    ----------
    name : str, optional
        ``"paper"`` or ``"slides"``; that of the enclosing block by default, or else paper.

    Raises
    ------
    InputError
        If there is no such style.
    """
    chosen = _current.get() if name is None else name
    if chosen not in STYLES:
        raise InputError(f"is no style{suggestion(chosen, STYLES)}", field="style", value=chosen)
    token = _current.set(chosen)
    try:
        with plt.style.context(style_file(chosen)):
            yield
    finally:
        _current.reset(token)


def styled(draw: Callable[Given, Figure]) -> Callable[Given, Figure]:
    """A function that makes a figure, so that all of it is made in the current style."""

    @wraps(draw)
    def figure(*args: Given.args, **kwargs: Given.kwargs) -> Figure:
        with figure_style():
            return draw(*args, **kwargs)

    return figure


def style_file(name: str) -> Path:
    """The rcParams of a style, for ``matplotlib.pyplot.style.use`` in figures of one's own."""
    return Path(__file__).parent / f"{name}.mplstyle"


def sized(width: float, height: float) -> tuple[float, float]:
    """Size of a figure [in] that is `width` x `height` on paper, in the style of this block."""
    scale = STYLES[_current.get()]
    return scale * width, scale * height


def scaled(size: float) -> float:
    """A line's width or a mark's size [pt] that is `size` on paper, in the style of this block."""
    return STYLES[_current.get()] * size


def panels(
    width: float = 4.6, height: float = 2.8, columns: int = 1, **options: Any
) -> tuple[Figure, list[Any]]:
    """A figure in the current style with axes side by side.

    Parameters
    ----------
    width, height : float
        On paper [in].
    columns : int
    options
        Further arguments of ``matplotlib.pyplot.subplots``.

    Returns
    -------
    tuple of Figure and list of Axes
    """
    with figure_style():
        figure, grid = plt.subplots(
            1, columns, figsize=sized(width, height), squeeze=False, layout="constrained", **options
        )
    return figure, list(grid[0])


def figure_written(figure: Figure, folder: str | Path, name: str) -> list[Path]:
    """Write a figure as PNG and PDF, each whole or not at all, and close it.

    Returns
    -------
    list of Path
    """
    paths = []
    with figure_style():
        for kind in FORMATS:
            metadata = {"CreationDate": None} if kind == "pdf" else None
            save = partial(figure.savefig, format=kind, metadata=metadata)
            paths.append(written_whole(Path(folder) / f"{name}.{kind}", save))
    plt.close(figure)
    return paths
