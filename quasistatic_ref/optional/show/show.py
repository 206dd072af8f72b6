"""Objects shown in a terminal and in a notebook: few lines, no line too long, names escaped."""

from collections.abc import Iterable, Sequence
from html import escape
from numbers import Real

from quasistatic_ref import quoting
from quasistatic_ref.quoting import aligned, one_line

WIDTH, LINES = 100, 20
"""Most columns and lines of a text."""
MOST_SHOWN = 12
"""Most rows of a table in a text."""
MOST_IN_HTML = 50
NAME = 32
"""Most columns of a name in a table."""
CELL = "padding:0 0.6em;text-align:right"
FIRST = "padding:0 0.6em;text-align:left"

Row = Sequence[str]
Page = tuple[str, Sequence[str], Row, Sequence[Row]]
"""A title, facts, and a table: its header and its rows."""


def clipped(text: str) -> str:
    """Text on one line of at most WIDTH columns."""
    line = one_line(text)
    return line if len(line) <= WIDTH else f"{line[: WIDTH - 3]}..."


def number(x: object) -> str:
    """A number to four digits; a dash for anything else, such as None."""
    return f"{float(x) + 0.0:.4g}" if isinstance(x, Real) else "-"


def direction(n: Iterable[float]) -> str:
    """A unit vector to three decimals, e.g. ``(0.000, 0.707, -0.707)``."""
    return f"({', '.join(f'{x + 0.0:.3f}' for x in n)})"


def text_page(page: Page) -> str:
    """Title, facts, and the first rows of the table, as at most LINES lines of WIDTH columns."""
    title, facts, header, rows = page
    lines = [title, *(f"  {fact}" for fact in facts)][: LINES - MOST_SHOWN - 2]
    if rows:
        cells = [
            [quoting.clipped(one_line(cell), NAME) for cell in row]
            for row in [header, *rows[:MOST_SHOWN]]
        ]
        lines += [f"  {line}" for line in aligned(cells)]
        if len(rows) > MOST_SHOWN:
            lines.append(f"  ... and {len(rows) - MOST_SHOWN} more")
    return "\n".join(clipped(line) for line in lines)


def html_page(page: Page) -> str:
    """Title, facts and rows of a page as one HTML element that loads nothing."""
    title, facts, header, rows = page
    parts = [f"<div><p><strong>{_safe(title)}</strong></p>"]
    if facts:
        parts.append(f"<p>{'<br>'.join(map(_safe, facts))}</p>")
    if rows:
        head = _cells(header, "th", ' scope="col"')
        body = "".join(_cells(row, "td") for row in rows[:MOST_IN_HTML])
        parts.append(f"<table><thead>{head}</thead><tbody>{body}</tbody></table>")
        if len(rows) > MOST_IN_HTML:
            parts.append(f"<p>and {len(rows) - MOST_IN_HTML} more</p>")
    return "".join([*parts, "</div>"])


def _cells(row: Row, tag: str, more: str = "") -> str:
    styled = [(CELL if i else FIRST, _safe(cell)) for i, cell in enumerate(row)]
    cells = [f'<{tag}{more} style="{style}">{cell}</{tag}>' for style, cell in styled]
    return f"<tr>{''.join(cells)}</tr>"


def _safe(text: str) -> str:
    return escape(one_line(text))
