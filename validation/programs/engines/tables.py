"""The page of results, phenomena.md."""

from typing import Any

from quasistatic_ref.lab.page.markdown import markdown_table
from validation.programs.engines.phenomena import PHENOMENA

MARK = {"holds": "{}", "differs": "**{}** ✗", "-": "({})"}


def phenomena_page(records: dict[str, Any]) -> str:
    """Engine, setting and phenomenon; what is asked; causes that were tried."""
    head = [f"{p['title']} [{p['unit']}]" for p in PHENOMENA.values()]
    table = [("*the answer*", "", *map(answer, PHENOMENA.values()))]
    for record in records.values():
        for setting, cells in record["settings"].items():
            words = [
                "(not asked)"
                if cell["verdict"] == "-" and cell["value"] is None
                else MARK[cell["verdict"]].format(cell["words"])
                for cell in cells
            ]
            table.append((record["version"], setting, *words))
    asked = [
        (p["title"], p["answer"].strip(), f"{p['tolerance']:g}", p["reason"].strip())
        for p in PHENOMENA.values()
    ]
    return "\n".join([
        "<!-- Written by python -m validation.make.engines. -->", "",
        *cells_of(range(SLIDING), head, table), "",
        *cells_of(range(SLIDING, len(head)), head, table), "",
        "## What is asked", "",
        *markdown_table(("phenomenon", "the answer", "tolerance", "its reason"), asked), "",
        "## Causes, tried", "",
        "One setting of a row above is changed in what may be the cause, and its phenomenon asked "
        "again.", "",
        *markdown_table(("engine", "setting", "phenomenon", "is", "changed", "becomes"),
                        causes(records)), "",
    ])  # fmt: skip


SLIDING = 4
"""Phenomena of a body that slides, in a table of their own: both can be read on a page."""


def cells_of(columns: range, head: list[str], table: list[tuple[str, ...]]) -> list[str]:
    """A table of some phenomena: engine, setting, and their cells."""
    rows = [(*row[:2], *(row[2 + k] for k in columns)) for row in table]
    return markdown_table(("engine", "setting", *(head[k] for k in columns)), rows)


def causes(records: dict[str, Any]) -> list[tuple[str, ...]]:
    """Rows on what becomes of cells, by what was changed."""
    rows = []
    for record in records.values():
        for one in record.get("tried", ()):
            asked = PHENOMENA[one["phenomenon"]]
            cells = {cell["phenomenon"]: cell for cell in record["settings"][one["setting"]]}
            what = f"{asked['title']} [{asked['unit']}]"
            was = cells[one["phenomenon"]]["words"]
            rows.append((record["version"], one["setting"], what, was, one["changed"],
                         one["words"]))  # fmt: skip
    return rows


def answer(phenomenon: dict[str, Any]) -> str:
    """What is expected, in a cell."""
    if "cones" in phenomenon:
        return " or ".join(f"{x:.2f}" for x in phenomenon["expected"])
    return f"{phenomenon['expected']:.3g}"
