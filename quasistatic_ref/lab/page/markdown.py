"""A report as Markdown, its figures in the folder ``figures`` next to it; and any table."""

import re
from collections.abc import Iterable, Sequence

from quasistatic_ref.lab.page.parts import Block, Code, Picture, Report, Table

_TAG = re.compile(r"<(?=[A-Za-z/!?])")
"""Where Markdown begins HTML of its own."""


def markdown_page(report: Report) -> str:
    """The page.

    Parameters
    ----------
    report : Report
    """
    lines = [f"# {_escaped(report.title)}", ""]
    for section in report.sections:
        lines += [f"## {_escaped(section.title)}", ""]
        for block in section.blocks:
            lines += [*_block(block), ""]
    return "\n".join(lines).rstrip() + "\n"


def _block(block: Block) -> list[str]:
    if isinstance(block, str):
        return [_escaped(block)]
    if isinstance(block, Picture):
        caption = _escaped(block.caption)
        return [f"![{caption}]({block.file})", "", f"{caption}{_rows(block.where)}"]
    if isinstance(block, Code):
        fence = max(["```", *(ticks + "`" for ticks in re.findall("`{3,}", block.text))], key=len)
        return [f"{fence}text", *block.text.splitlines(), fence]
    return _table(block)


def _table(table: Table) -> list[str]:
    title = f"**{_escaped(table.title)}**{_rows(table.where)}"
    return [title, "", *markdown_table(table.columns, table.rows, table.left)]


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


def _rows(where: str) -> str:
    return f" *Rows:* {_escaped(where)}." if where else ""


def _escaped(text: str) -> str:
    """Text in which a name that holds HTML, such as ``<script>``, is shown, not obeyed."""
    return _TAG.sub("&lt;", text)
