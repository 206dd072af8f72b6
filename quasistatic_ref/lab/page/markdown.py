"""A report as Markdown, its figures in the folder ``figures`` next to it; and any table."""

from collections.abc import Iterable, Sequence

from quasistatic_ref.lab.page.parts import Block, Code, Picture, Report, Table


def markdown_page(report: Report) -> str:
    """The page.

    Parameters
    ----------
    report : Report
    """
    lines = [f"# {report.title}", ""]
    for section in report.sections:
        lines += [f"## {section.title}", ""]
        for block in section.blocks:
            lines += [*_block(block), ""]
    return "\n".join(lines).rstrip() + "\n"


def _block(block: Block) -> list[str]:
    if isinstance(block, str):
        return [block]
    if isinstance(block, Picture):
        return [f"![{block.caption}]({block.file})", "", f"{block.caption}{_rows(block.where)}"]
    if isinstance(block, Code):
        return ["```text", *block.text.splitlines(), "```"]
    return _table(block)


def _table(table: Table) -> list[str]:
    title = f"**{table.title}**{_rows(table.where)}"
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
    return f"| {' | '.join(str(cell).replace('|', chr(92) + '|') for cell in cells)} |"


def _rows(where: str) -> str:
    return f" *Rows:* {where}." if where else ""
