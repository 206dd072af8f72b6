"""The two pages of results: layers.md, and phenomena.md."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from validation.engines.phenomena import PHENOMENA
from validation.engines.reproduce import of_cell

HERE = Path(__file__).parent
HEAD = "| engine | layer | passed | acceptable | failed | left out | worst digits | first failure |"
MARK = {"holds": "{}", "differs": "**{}** ✗", "-": "({})"}


def layers_page(records: dict[str, Any]) -> str:
    """Each engine on each layer, and what was found."""
    lines = [HEAD, "|" + "---|" * 8]
    for record in records.values():
        for row in record["layers"]:
            counts = [row[key] for key in ("passed", "acceptable", "failed", "missing")]
            digits = "-" if row["worst digits"] is None else row["worst digits"]
            first = f"`{row['first failure']}`" if row["first failure"] else "-"
            cells = [row["engine"], row["layer"], *counts, digits, first]
            lines.append(f"| {' | '.join(map(str, cells))} |")
    return (HERE / "layers_template.md").read_text("utf-8").replace("TABLE", "\n".join(lines))


def phenomena_page(records: dict[str, Any]) -> str:
    """Engine, setting and phenomenon; what is asked; which reproduction shows which cell."""
    names = list(PHENOMENA)
    head = [f"{p['title']} [{p['unit']}]" for p in PHENOMENA.values()]
    table = [
        f"| engine | setting | {' | '.join(head)} |",
        "|" + "---|" * (len(names) + 2),
        f"| *the answer* | | {' | '.join(map(answer, PHENOMENA.values()))} |",
    ]
    shown: dict[str, list[str]] = {}
    for name, record in records.items():
        for setting, cells in record["settings"].items():
            words = [
                "(not asked)"
                if cell["verdict"] == "-" and cell["value"] is None
                else MARK[cell["verdict"]].format(cell["words"])
                for cell in cells
            ]
            table.append(f"| {record['version']} | {setting} | {' | '.join(words)} |")
            for cell in cells:
                if cell["verdict"] == "differs":
                    what = f"{setting}: {PHENOMENA[cell['phenomenon']]['title']}"
                    shown.setdefault(of_cell(name, setting, cell["phenomenon"]), []).append(what)
    asked = [
        f"| {p['title']} | {p['answer'].strip()} | {p['tolerance']:g} | {p['reason'].strip()} |"
        for p in PHENOMENA.values()
    ]
    programs = [f"| `{file}` | {'; '.join(cells)} |" for file, cells in sorted(shown.items())]
    return "\n".join([
        "<!-- Written by python -m validation.engines. -->", "",
        *table, "",
        "## What is asked", "",
        "| phenomenon | the answer | tolerance | its reason |", "|---|---|---|---|", *asked, "",
        "## Reproductions", "",
        "| program in `validation/engines/reproductions/` | red cells that it shows |", "|---|---|",
        *programs, "",
    ])  # fmt: skip


def answer(phenomenon: dict[str, Any]) -> str:
    """What is expected, in a cell."""
    if "cones" in phenomenon:
        return (
            ", ".join(f"{x:.2f} or" for x in phenomenon["expected"])
            .removesuffix(" or")
            .replace(" or,", " or")
        )
    return f"{phenomenon['expected']:.3g}"
