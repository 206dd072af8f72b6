"""A table in Markdown."""

import re
from collections.abc import Iterable, Sequence

_TAG = re.compile(r"<(?=[A-Za-z/!?])")
"""Where Markdown begins HTML of its own."""


def markdown_table(
    columns: Sequence[str], rows: Iterable[Sequence[object]], left: int | None = None
) -> list[str]:
    """The lines of a table.

    Parameters
    ----------
    columns : sequence of str
    rows : sequence of sequence of str
    left : int, optional
        How many columns are text; the others are numbers, to the right. None: all are text.
    """
    text = len(columns) if left is None else left
    rule = ["---"] * text + ["---:"] * (len(columns) - text)
    return [_line(cells) for cells in (columns, rule, *rows)]


def _line(cells: Sequence[object]) -> str:
    return f"| {' | '.join(_escaped(str(cell)).replace('|', chr(92) + '|') for cell in cells)} |"


def _escaped(text: str) -> str:
    """Text in which a name that holds HTML, such as ``<script>``, is shown, not obeyed."""
    return _TAG.sub("&lt;", text)
