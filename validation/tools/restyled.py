"""Every figure in every style and in a grid, read for what is not legible.

Run ``python -m validation.tools.restyled [NAME ...] [--out FOLDER]`` (some three minutes). These
are the figures of the examples, of the course and of the claims, in the style of paper. Those of
examples and course are also drawn in ``docs/styles/two_columns.mplstyle`` (3.4 inches, 8 pt), in
slides, on a poster, and into one cell of a user's own grid of 2 x 2 axes, a page wide. Exit status
1 if any of them has a fault; with --out each is kept as a PNG: look at them for what no program
sees.
"""

import sys
from collections.abc import Callable, Collection, Iterator
from pathlib import Path

from matplotlib import pyplot as plt
from matplotlib.figure import Figure

from docs.drawings import contact_geometry, corner_loads, free_body, sliding_block, the_program
from quasistatic_ref.lab.claims.claim import finding
from quasistatic_ref.lab.claims.registry import BY_NAME
from quasistatic_ref.lab.examples.gallery import EXAMPLES, example
from quasistatic_ref.lab.figures.validation import PICTURES
from quasistatic_ref.optional.show.figures import figure_style
from quasistatic_ref.optional.show.figures.style import PAGE
from tests.legible import faults
from validation.tools.scripts import ROOT, script_options

COLUMN = ROOT / "docs" / "styles" / "two_columns.mplstyle"
GRID = (PAGE, 6.3)
"""Size of the grid [in]."""

FIGURES = {
    "contact_geometry": contact_geometry.figure,
    "corner_loads": corner_loads.figure,
    "free_body": free_body.figure,
    "sliding_block": sliding_block.figure,
    "the_program": the_program.figure,
}
"""Those that pages of the course draw."""


def drawer(name: str) -> Callable[..., Figure]:
    """The function that draws a figure of an example or of the course."""
    return FIGURES[name] if name in FIGURES else example(name).figure


def on_paper() -> Iterator[tuple[str, Figure]]:
    """The figures of claims, each measured again."""
    for name, draw in PICTURES.items():
        evidence = finding(BY_NAME[name]).evidence
        assert evidence is not None, f"the claim {name} could not be measured"
        yield f"claim_{name}", draw(evidence.picture)


def in_styles(name: str) -> dict[str, tuple[Figure, list[str]]]:
    """A figure in each style, and in a cell of a grid: what it is -> the figure, its faults."""
    made = {}
    for style in ("paper", COLUMN, "slides", "poster"):
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


def every_figure(names: Collection[str]) -> Iterator[tuple[str, str, Figure, list[str]]]:
    """Name, style, figure and faults of the figures that are named, or of all."""
    for name in names or (*EXAMPLES, *FIGURES):
        for style, (page, found) in in_styles(name).items():
            yield name, style, page, found
    if not names:
        with figure_style("paper"):
            for name, page in on_paper():
                yield name, "paper", page, faults(page, "paper")


def main() -> int:
    """Draw, read, keep."""
    options = script_options(__doc__, (*EXAMPLES, *FIGURES), out=Path)
    wrong = []
    for name, style, page, found in every_figure(options.names):
        wrong += [f"{name}, {style}: {fault}" for fault in found]
        if options.out:
            options.out.mkdir(parents=True, exist_ok=True)
            page.savefig(options.out / f"{name}_{style}.png", bbox_inches=None, dpi=110)
        plt.close(page)
        print(f"{name}, {style}", flush=True)
    print("\n".join(wrong) or "every figure is legible in every style")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
