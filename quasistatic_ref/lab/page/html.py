"""A report as one HTML file: figures inside it, nothing from elsewhere, no script but its own."""

import base64
import re
from collections.abc import Mapping, Sequence
from html import escape
from pathlib import Path

from quasistatic_ref.lab.page.parts import Block, Code, Picture, Report, Table


def sorting_script() -> str:
    """The script that sorts a table by the heading that is clicked; it loads nothing."""
    return (Path(__file__).parent / "sort.js").read_text("utf-8")


def html_page(report: Report, images: Mapping[str, bytes], script: str = "") -> str:
    """The page.

    Parameters
    ----------
    report : Report
    images : mapping of str to bytes
        Name of each picture -> its SVG.
    script : str
        What the page runs, such as :func:`sorting_script`; else nothing.
    """
    links = [f'<li><a href="#{_id(s.title)}">{escape(s.title)}</a></li>' for s in report.sections]
    style = (Path(__file__).parent / "page.css").read_text("utf-8")
    lines = [
        "<!DOCTYPE html>",
        '<html lang="en"><head><meta charset="utf-8">',
        '<meta name="viewport" content="width=device-width, initial-scale=1">',
        f"<title>{escape(report.title)}</title><style>\n{style}</style></head><body>",
        f"<h1>{escape(report.title)}</h1>",
        f"<nav><ul>{''.join(links)}</ul></nav>",
    ]
    for section in report.sections:
        lines.append(f'<h2 id="{_id(section.title)}">{escape(section.title)}</h2>')
        lines += [_block(block, images) for block in section.blocks]
    if script:
        lines.append(f"<script>\n{script}</script>")
    return "\n".join([*lines, "</body></html>", ""])


def _id(title: str) -> str:
    return re.sub(r"[^a-z0-9]+", "-", title.lower()).strip("-")


def _block(block: Block, images: Mapping[str, bytes]) -> str:
    if isinstance(block, str):
        return f"<p>{_text(block)}</p>"
    if isinstance(block, Picture):
        return _figure(block, images[block.name])
    if isinstance(block, Code):
        return f"<pre>{escape(block.text)}</pre>"
    return _table(block)


def _text(words: str) -> str:
    """Words with `code` in them."""
    return re.sub(r"`([^`]*)`", r"<code>\1</code>", escape(words))


def _figure(picture: Picture, svg: bytes) -> str:
    source = "data:image/svg+xml;base64," + base64.b64encode(svg).decode()
    return (
        f"<figure><img{' class=natural' if picture.natural else ''} "
        f'alt="{escape(picture.caption)}" src="{source}">'
        f"<figcaption>{_text(picture.caption)}{_rows(picture.where)}</figcaption></figure>"
    )


def _rows(where: str) -> str:
    return f' <span class="rows">Rows: {_text(where)}.</span>' if where else ""


def _table(table: Table) -> str:
    head = _table_row("th", table.columns, table.left)
    body = [_table_row("td", row, table.left) for row in table.rows]
    return (
        f'<div class="wide"><table><caption><b>{_text(table.title)}</b>{_rows(table.where)}'
        f"</caption><thead>{head}</thead>"
        f"<tbody>{''.join(body)}</tbody></table></div>"
    )


def _table_row(tag: str, cells: Sequence[str], left: int) -> str:
    """A row, of whose cells the first `left` are text."""
    kinds = [" class=left"] * left + [""] * (len(cells) - left)
    words = zip(kinds, cells, strict=True)
    return f"<tr>{''.join(f'<{tag}{kind}>{_text(cell)}</{tag}>' for kind, cell in words)}</tr>"
