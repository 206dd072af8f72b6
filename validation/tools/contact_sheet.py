"""Every figure on one sheet, in colour and in grey; each is first read for what is not legible.

Run ``python -m validation.tools.contact_sheet [--out FOLDER]`` (about a minute and a half). These
are the figures of the examples, in both styles, those of the claims, and what is drawn from
committed results. Exit status 1 if any of them has a fault; look at the sheet for what no program
sees.
"""

from __future__ import annotations

import argparse
import io
import sys
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path

from matplotlib import pyplot as plt
from matplotlib.figure import Figure
from PIL import Image, ImageDraw

from quasistatic_ref.lab.claims.claim import finding
from quasistatic_ref.lab.claims.registry import BY_NAME
from quasistatic_ref.lab.examples.gallery import EXAMPLES, figure_of
from quasistatic_ref.lab.figures.digits import digits_of_backends
from quasistatic_ref.lab.figures.validation import PICTURES
from quasistatic_ref.optional.show.figures import figure_style
from quasistatic_ref.optional.show.figures.style import STYLES
from tests.legible import faults
from validation.make.digits_of_backends import SUBJECT, records_read

COLUMNS, CELL, HEADING = 4, (630, 470), 24
"""Of the sheet [pixels]."""


def claim_figure(name: str) -> Figure:
    """The figure of a claim, measured again."""
    evidence = finding(BY_NAME[name]).evidence
    if evidence is None:
        sys.exit(f"the claim {name} could not be measured")
    return PICTURES[name](evidence.picture)


def every_figure() -> Iterator[tuple[str, str, Callable[[], Figure]]]:
    """Title, style and maker of each figure."""
    for name in EXAMPLES:
        for style in STYLES:
            yield f"example {name}, {style}", style, partial(figure_of, name)
    for name in PICTURES:
        yield f"claim {name}", "paper", partial(claim_figure, name)
    yield "digits_of_backends", "paper", lambda: digits_of_backends(records_read(), SUBJECT)


def thumbnail(figure: Figure, title: str) -> Image.Image:
    """A figure as it is printed, in a cell of the sheet, below its title."""
    content = io.BytesIO()
    figure.savefig(content, format="png", dpi=150)
    image = Image.open(content).convert("RGB")
    image.thumbnail(CELL)
    cell = Image.new("RGB", (CELL[0] + 10, CELL[1] + HEADING + 10), "white")
    ImageDraw.Draw(cell).text((5, 5), title, fill="black")
    cell.paste(image, (5, HEADING))
    return cell


def main() -> int:
    """Make, read and lay out."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=Path, default=Path("figures"))
    folder = parser.parse_args().out
    folder.mkdir(parents=True, exist_ok=True)
    cells, wrong = [], []
    for title, style, made in every_figure():
        with figure_style(style):
            figure = made()
            wrong += [f"{title}: {fault}" for fault in faults(figure, style)]
            cells.append(thumbnail(figure, title))
        plt.close(figure)
        print(title, flush=True)
    width, height = cells[0].size
    rows = -(-len(cells) // COLUMNS)
    sheet = Image.new("RGB", (COLUMNS * width, rows * height), "white")
    for k, cell in enumerate(cells):
        sheet.paste(cell, (k % COLUMNS * width, k // COLUMNS * height))
    sheet.save(folder / "contact_sheet.png")
    sheet.convert("L").save(folder / "contact_sheet_grey.png")
    print(f"{len(cells)} figures on {folder / 'contact_sheet.png'}, and in grey next to it")
    print("\n".join(wrong), file=sys.stderr, end="\n" if wrong else "")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
