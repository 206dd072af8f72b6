"""A report as Markdown, its figures in the folder ``figures`` next to it."""

from quasistatic_ref.lab.page.parts import Block, Picture, Report, Table


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
    return _table(block)


def _table(table: Table) -> list[str]:
    rule = ["---"] * table.left + ["---:"] * (len(table.columns) - table.left)
    lines = [f"**{table.title}**{_rows(table.where)}", ""]
    for cells in (table.columns, tuple(rule), *table.rows):
        lines.append(f"| {' | '.join(c.replace('|', chr(92) + '|') for c in cells)} |")
    return lines


def _rows(where: str) -> str:
    return f" *Rows:* {where}." if where else ""
