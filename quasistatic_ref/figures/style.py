"""The common look of all figures, and writing them."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path

import matplotlib as mpl

mpl.use("Agg", force=False)

from matplotlib import pyplot as plt
from matplotlib.figure import Figure

from quasistatic_ref.files import written_whole

STYLE = Path(__file__).parent / "paper.mplstyle"
FORMATS = ("png", "pdf")


@contextmanager
def paper_style() -> Iterator[None]:
    """Draw with the common look inside this block."""
    with plt.style.context(STYLE):
        yield


def figure_written(figure: Figure, folder: str | Path, name: str) -> list[Path]:
    """Write a figure as PNG and PDF, each whole or not at all, and close it.

    Returns
    -------
    list of Path
    """
    paths = []
    with paper_style():
        for kind in FORMATS:
            metadata = {"CreationDate": None} if kind == "pdf" else None
            save = partial(figure.savefig, format=kind, metadata=metadata)
            paths.append(written_whole(Path(folder) / f"{name}.{kind}", save))
    plt.close(figure)
    return paths
