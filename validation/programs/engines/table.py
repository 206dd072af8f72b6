"""The page of what engines answered."""

import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from quasistatic_ref.lab.markdown import markdown_table
from validation.programs.engines.phenomena import PHENOMENA

CROSSES = tomllib.loads((Path(__file__).parent / "crosses.toml").read_text("utf-8"))
"""Why cells have a cross: engine and phenomenon -> sentences, each of some settings."""
NOT_ASKED = {"not_meaningful": "not asked: measured before this question existed"}
SLIDING = 5
"""Phenomena of a body that slides, in a table of their own: both can be read on a page."""


def is_wrong(phenomenon: str, cell: dict[str, Any]) -> bool:
    """Whether a cell has a value, which is not the answer: it gets a cross."""
    return "value" in cell and not PHENOMENA[phenomenon].holds(cell["value"])


def settings(record: dict[str, Any]) -> dict[str, dict[str, dict[str, Any]]]:
    """Setting -> phenomenon -> cell."""
    table: dict[str, dict[str, dict[str, Any]]] = {}
    for cell in record["cells"]:
        row = table.setdefault(cell["setting"], dict.fromkeys(PHENOMENA, NOT_ASKED))
        row[cell["phenomenon"]] = cell
    return table


def crosses(record: dict[str, Any]) -> Iterator[tuple[str, str]]:
    """Setting and phenomenon of each cross."""
    for setting, row in settings(record).items():
        yield from ((setting, name) for name, cell in row.items() if is_wrong(name, cell))


def reason(engine: str, setting: str, phenomenon: str) -> str:
    """The sentence on a cross.

    Raises
    ------
    KeyError
        If there is none.
    """
    for entry in CROSSES[engine]:
        if phenomenon in entry["phenomena"] and setting in entry.get("settings", [setting]):
            return str(entry["why"])
    raise KeyError(f"no sentence on {phenomenon} of {engine}, {setting}")


def number(value: float) -> str:
    """A value of a cell."""
    if abs(value) < 1e-9:
        return "0"
    return f"{value:,.0f}" if 1000 <= abs(value) < 1e6 else f"{value:.3g}"


def page(records: dict[str, dict[str, Any]]) -> str:
    """The tables, what is asked, and the reasons of cells without a value and of crosses."""
    head = [f"{p.title} [{p.unit}]" for p in PHENOMENA.values()]
    answers = [number(p.answer) if p.tolerance < float("inf") else "" for p in PHENOMENA.values()]
    rows = [("*the answer*", "", *answers)]
    notes: list[str] = []
    marks: list[tuple[str, str, str, str]] = []
    for engine, record in records.items():
        for setting, row in settings(record).items():
            words = [words_of(name, cell, notes) for name, cell in row.items()]
            rows.append((record["name"], setting, *words))
        marks += [
            (record["name"], setting, PHENOMENA[name].title, reason(engine, setting, name))
            for setting, name in crosses(record)
        ]
    asked = [
        (p.title, p.formula, f"{p.tolerance:g} {p.unit}" if p.tolerance < float("inf") else "none",
         p.reason)
        for p in PHENOMENA.values()
    ]  # fmt: skip
    dates = [f"{r['name']}: {r['measured']}." for r in records.values() if "measured" in r]
    besides = [(r["name"], r["not_default"]) for r in records.values() if "not_default" in r]
    return "\n".join([
        "<!-- Written by python -m validation.make.engines. -->", "",
        *columns(range(SLIDING), head, rows), "",
        *columns(range(SLIDING, len(head)), head, rows), "",
        *(f"{k}. {note}." for k, note in enumerate(notes, 1)), "", *dates, "",
        "## Settings that rows do not name", "",
        *markdown_table(("engine", "what its adapter sets"), besides), "",
        "## What is asked", "",
        *markdown_table(("phenomenon", "the answer", "tolerance", "its reason"), asked), "",
        "## Why a cell has a cross", "",
        *markdown_table(("engine", "settings", "phenomena", "why"), merged(marks)), "",
    ])  # fmt: skip


def words_of(phenomenon: str, cell: dict[str, Any], notes: list[str]) -> str:
    """A cell in words; the reason of one without a value becomes a note."""
    if "value" in cell:
        text = number(cell["value"])
        return f"**{text}** ✗" if is_wrong(phenomenon, cell) else text
    note = cell.get("not_meaningful") or f"no answer: {cell['failed']}"
    if note not in notes:
        notes.append(note)
    return f"not meaningful ({notes.index(note) + 1})"


def columns(chosen: range, head: list[str], rows: list[tuple[str, ...]]) -> list[str]:
    """A table of some phenomena: engine, setting, and their cells."""
    cells = [(*row[:2], *(row[2 + k] for k in chosen)) for row in rows]
    return markdown_table(("engine", "setting", *(head[k] for k in chosen)), cells)


def merged(marks: list[tuple[str, str, str, str]]) -> list[tuple[str, str, str, str]]:
    """A row an engine and a sentence, with all settings and phenomena that it explains."""
    rows: dict[tuple[str, str], tuple[dict[str, None], dict[str, None]]] = {}
    for engine, setting, title, why in marks:
        names, titles = rows.setdefault((engine, why), ({}, {}))
        names[setting] = titles[title] = None
    return [
        (engine, "; ".join(names), "; ".join(titles), why)
        for (engine, why), (names, titles) in rows.items()
    ]
