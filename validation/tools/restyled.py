"""Every figure in the styles of a paper in two columns, of slides and of posters, and in a grid.

Run ``python -m validation.tools.restyled [--out FOLDER] [--only NAME ...]`` (about a minute and a
half). Each figure of an example and of the tour is drawn in ``docs/styles/two_columns.mplstyle``
(3.4 inches, 8 pt), in slides and on a poster, and into one cell of a user's own grid of 2 x 2 axes,
a page wide. Exit status 1 if any of them has a fault; with --out, each is kept as a PNG.
"""

import argparse
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

from matplotlib import pyplot as plt
from matplotlib.figure import Figure

from docs.six_figures import corner_loads, the_program
from quasistatic_ref.lab.examples.gallery import EXAMPLES, example
from quasistatic_ref.optional.show.figures import figure_style
from quasistatic_ref.optional.show.figures.style import PAGE
from tests.legible import faults

ROOT = Path(__file__).parents[2]
COLUMN = ROOT / "docs" / "styles" / "two_columns.mplstyle"
GRID = (PAGE, 6.3)
"""Size of the grid [in]."""

FIGURES: dict[str, Callable[..., Figure]] = {
    "corner_loads": corner_loads.figure,
    "the_program": the_program.figure,
}


def drawer(name: str) -> Callable[..., Figure]:
    """The function that draws a figure."""
    return FIGURES[name] if name in FIGURES else example(name).figure


def in_styles(name: str) -> dict[str, tuple[Figure, list[str]]]:
    """A figure in each style, and in a cell of a grid: what it is -> the figure, its faults."""
    made: dict[str, tuple[Figure, list[str]]] = {}
    for style in (COLUMN, "slides", "poster"):
        with figure_style(style):
            page = drawer(name)()
            made[Path(style).stem] = page, faults(page, style)
    with figure_style(COLUMN):
        page, grid = plt.subplots(2, 2, figsize=GRID, layout="constrained")
        for axes in grid.flat[1:]:
            axes.plot([0, 1], [0, 1])
            axes.set(xlabel="time t [s]", ylabel="force [N]")
        assert drawer(name)(grid[0, 0]) is page
        made["grid"] = page, faults(page, COLUMN) if _fits(page) else ["it is larger"]
    return made


def _fits(page: Figure) -> bool:
    return tuple(page.get_size_inches()) == GRID


def main() -> int:
    """Draw, read, keep."""
    names = (*EXAMPLES, *FIGURES)
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=Path)
    parser.add_argument("--only", nargs="+", default=names, choices=names, metavar="NAME")
    options: Any = parser.parse_args()
    wrong = []
    for name in options.only:
        for what, (page, found) in in_styles(name).items():
            wrong += [f"{name}, {what}: {fault}" for fault in found]
            if options.out:
                options.out.mkdir(parents=True, exist_ok=True)
                page.savefig(options.out / f"{name}_{what}.png", bbox_inches=None, dpi=110)
            plt.close(page)
        print(name, flush=True)
    print("\n".join(wrong) or f"{len(options.only)} figures are legible in every style")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
