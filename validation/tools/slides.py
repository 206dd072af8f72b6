"""Slides of the two lectures that docs/course/teachers.md plans, a PDF each.

Run ``python -m validation.tools.slides [a] [b] [--out FOLDER]``. What stands on them is in
``docs/slides/``: of each slide a title, the minute at which it is shown, paragraphs of which those
between dollars are equations, and the figure below them, one of the examples or of the course.
The site gives them to be downloaded.
"""

import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import IO, Any

from matplotlib import pyplot as plt
from matplotlib.backends.backend_pdf import PdfPages
from matplotlib.figure import Figure

from docs.drawings import contact_geometry, corner_loads, free_body, sliding_block, the_program
from quasistatic_ref.formats.files import written_whole
from quasistatic_ref.lab.examples.gallery import example
from quasistatic_ref.lab.figures.labels import wrapped
from quasistatic_ref.optional.show.figures import figure_style
from quasistatic_ref.optional.show.figures.style import METADATA
from validation.tools.scripts import ROOT, script_options

DRAWINGS = {
    "contact_geometry": contact_geometry,
    "corner_loads": corner_loads,
    "free_body": free_body,
    "sliding_block": sliding_block,
    "the_program": the_program,
}
"""Modules of figures that pages of the course draw; all others are examples."""
FOLDER = ROOT / "docs" / "slides"
SETS = ("a", "b")
STYLE = "slides"
SIZE = (12.6, 7.0875)
"""Of a slide [in], 16 to 9: the labels of a figure are as small as they may be."""
EDGE = 0.45
"""Around what stands on a slide [in]."""
PAGES = {"savefig.bbox": None, "pdf.fonttype": 3}
"""A slide is its whole page, also where nothing stands on its rim. And in several pages with fonts
of type 42, matplotlib 3.11 writes ligatures in the place of other signs: "fi" for a minus."""
SLIM = 0.82
"""Width of a line over the estimate by which it is broken [-]."""
TITLE, TEXT, EQUATION, MARK = 1.7, 1.35, 1.5, 0.9
"""Sizes over that of the style's text [-]."""


def slides(name: str) -> list[dict[str, Any]]:
    """The slides of a lecture, in order: ``title``, ``minute``, ``text`` and perhaps ``figure``."""
    content = tomllib.loads((FOLDER / f"{name}.toml").read_text("utf-8"))
    return list(content["slides"])


def slide_figure(slide: dict[str, Any], mark: str) -> Figure:
    """A slide in the present style, with a mark in its lower corner."""
    page = plt.figure(figsize=SIZE, layout="constrained")
    width, height = SIZE
    gap = 0.15 if "figure" in slide else 0.3
    size = MARK * float(plt.rcParams["font.size"])
    page.text(1 - EDGE / width, 0.15 / height, mark, ha="right", color="0.4", size=size)
    top = _below(page, height - EDGE, slide["title"], TITLE, weight="bold") - 0.3
    for paragraph in slide["text"]:
        top = _below(page, top, paragraph, TEXT) - gap
    if "figure" in slide:
        grid = page.add_gridspec(
            3, 3, wspace=0, hspace=0, width_ratios=(EDGE, width - 2 * EDGE, EDGE),
            height_ratios=(height - top, top - EDGE, EDGE),
        )  # fmt: skip
        name = slide["figure"]
        module = DRAWINGS[name] if name in DRAWINGS else example(name)
        module.figure(page.add_subfigure(grid[1, 1]))
    return page


def _below(page: Figure, top: float, text: str, share: float, **look: Any) -> float:
    """Write a paragraph, or an equation in the middle; where it ends [in]."""
    width, height = SIZE
    centred = text.startswith("$") and text.endswith("$")
    size = (EQUATION if centred else share) * float(plt.rcParams["font.size"])
    lines = text if centred else wrapped(text, (width - 2 * EDGE) * 72 / size / SLIM)
    across, side = (0.5, "center") if centred else (EDGE / width, "left")
    shown = page.text(across, top / height, lines, size=size, va="top", ha=side, **look)
    return top - float(shown.get_window_extent().height) / page.dpi


def pages(name: str) -> Iterator[Figure]:
    """Every slide of a lecture, closed when the next is asked for."""
    made = slides(name)
    with figure_style(STYLE), plt.rc_context(PAGES):
        for k, slide in enumerate(made, 1):
            page = slide_figure(slide, f"{k} of {len(made)}, minute {slide['minute']}")
            yield page
            plt.close(page)


def write_slides(name: str, folder: Path) -> None:
    """Write the slides of a lecture as ``lecture_NAME.pdf``."""

    def save(file: IO[bytes]) -> None:
        with PdfPages(file, metadata=METADATA["pdf"]) as document:
            for page in pages(name):
                document.savefig(page)

    written_whole(folder / f"lecture_{name}.pdf", save)


def main() -> None:
    """Write the slides of the lectures that are named, or of both."""
    options = script_options(__doc__, SETS, out=Path("slides"))
    for name in options.names or SETS:
        write_slides(name, options.out)


if __name__ == "__main__":
    main()
