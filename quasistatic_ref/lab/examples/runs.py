"""What examples share: being a script."""

import sys
from collections.abc import Callable, Mapping
from pathlib import Path

from quasistatic_ref.figures import Figure
from quasistatic_ref.figures.style import figure_written

Numbers = dict[str, float]
"""What an example came to: a quantity with its unit in brackets -> its value."""


def script(main: Callable[[], Mapping[str, float]], figure: Callable[[], Figure]) -> None:
    """Print the numbers of an example and write its figure to the current folder."""
    for what, value in main().items():
        print(f"{what}: {value:.6g}")
    for path in figure_written(figure(), ".", Path(sys.argv[0]).stem):
        print(f"wrote {path}")
