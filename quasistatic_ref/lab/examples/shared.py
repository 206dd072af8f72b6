"""What examples share: being a script."""

import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path

from quasistatic_ref.optional.show.figures import Figure
from quasistatic_ref.optional.show.figures.moments import Moment
from quasistatic_ref.optional.show.figures.style import figure_style, figure_written

Numbers = dict[str, float]
"""What an example came to: a quantity with its unit in brackets -> its value."""


def script(main: Callable[[], Mapping[str, float]], figure: Callable[..., Figure]) -> None:
    """Print the numbers of an example and write its figure to the current folder."""
    for what, value in main().items():
        print(f"{what}: {value:.6g}")
    with figure_style():
        page = figure()
    for path in figure_written(page, ".", Path(sys.argv[0]).stem):
        print(f"wrote {path}")


def only(of: Moment, words: Sequence[str], contacts: Sequence[int]) -> Moment:
    """A moment with the shapes whose names have one of some words, and with some contacts."""
    shapes = tuple(shape for shape in of.shapes if any(word in shape.name for word in words))
    return replace(of, shapes=shapes, contacts=tuple(of.contacts[j] for j in contacts))
