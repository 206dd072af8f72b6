"""A report as one HTML file: figures inside it, nothing from elsewhere, no scripts."""

from __future__ import annotations

import base64
import re
from collections.abc import Mapping
from html import escape

from quasistatic_ref.lab.study.page import Block, Picture, Report, Table

STYLE = """
body { font: 16px/1.5 system-ui, sans-serif; color: #111; background: #fff;
       max-width: 62rem; margin: 2rem auto; padding: 0 1rem; }
h1, h2 { line-height: 1.2; } h2 { margin-top: 2.5rem; border-bottom: 1px solid #999; }
nav ul { columns: 2; padding-left: 1.2rem; } a { color: #00508a; }
figure { margin: 1.5rem 0; } img { display: block; width: 100%; max-width: 50rem; height: auto; }
.wide { overflow-x: auto; margin: 1.2rem 0; }
table { border-collapse: collapse; font-size: 0.86rem; font-variant-numeric: tabular-nums; }
caption, figcaption { text-align: left; font-size: 0.9rem; margin-bottom: 0.4rem; }
.rows { color: #444; } th { border-bottom: 2px solid #333; }
th, td { padding: 0.2rem 0.6rem; text-align: right; vertical-align: top; }
th.left, td.left { text-align: left; } tbody tr:nth-child(even) { background: #f1f1f1; }
code { background: #f1f1f1; padding: 0 0.2em; overflow-wrap: break-word; }
@media print { h2 { break-after: avoid; } figure, tr { break-inside: avoid; } }
"""


def html_page(report: Report, images: Mapping[str, bytes]) -> str:
    """The page.

    Parameters
    ----------
    report : Report
    images : mapping of str to bytes
        Name of each picture -> its SVG.
    """
    links = [f'<li><a href="#{_id(s.title)}">{escape(s.title)}</a></li>' for s in report.sections]
    lines = [
        "<!DOCTYPE html>",
        '<html lang="en"><head><meta charset="utf-8">',
        '<meta name="viewport" content="width=device-width, initial-scale=1">',
        f"<title>{escape(report.title)}</title><style>{STYLE}</style></head><body>",
        f"<h1>{escape(report.title)}</h1>",
        f"<nav><ul>{''.join(links)}</ul></nav>",
    ]
    for section in report.sections:
        lines.append(f'<h2 id="{_id(section.title)}">{escape(section.title)}</h2>')
        lines += [_block(block, images) for block in section.blocks]
    return "\n".join([*lines, "</body></html>", ""])


def _id(title: str) -> str:
    return re.sub(r"[^a-z0-9]+", "-", title.lower()).strip("-")


def _block(block: Block, images: Mapping[str, bytes]) -> str:
    if isinstance(block, str):
        return f"<p>{_text(block)}</p>"
    if isinstance(block, Picture):
        return _figure(block, images[block.name])
    return _table(block)


def _text(words: str) -> str:
    """Words with `code` in them."""
    return re.sub(r"`([^`]*)`", r"<code>\1</code>", escape(words))


def _figure(picture: Picture, svg: bytes) -> str:
    source = "data:image/svg+xml;base64," + base64.b64encode(svg).decode()
    return (
        f'<figure><img alt="{escape(picture.caption)}" src="{source}">'
        f'<figcaption>{_text(picture.caption)} <span class="rows">Rows: '
        f"{_text(picture.where)}.</span></figcaption></figure>"
    )


def _table(table: Table) -> str:
    head = "".join(_cell("th", c, k < table.left) for k, c in enumerate(table.columns))
    body = [
        "<tr>" + "".join(_cell("td", c, k < table.left) for k, c in enumerate(row)) + "</tr>"
        for row in table.rows
    ]
    return (
        f'<div class="wide"><table><caption><b>{_text(table.title)}</b> <span class="rows">Rows: '
        f"{_text(table.where)}.</span></caption><thead><tr>{head}</tr></thead>"
        f"<tbody>{''.join(body)}</tbody></table></div>"
    )


def _cell(tag: str, words: str, left: bool) -> str:
    return f"<{tag}{' class=left' if left else ''}>{_text(words)}</{tag}>"
