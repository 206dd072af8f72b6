"""The report on a sweep of simulation parameters: its table, and a figure of two measures."""

import csv
import io
import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from quasistatic_ref.errors import InputError
from quasistatic_ref.formats.files import LARGEST_TEXT, bytes_read, text_of
from quasistatic_ref.lab.page.parts import Block, Picture, Report, Section, Table
from quasistatic_ref.lab.study.report.words import sentences
from quasistatic_ref.lab.sweep import DONE, LAYER

OTHER = "the scenario's unit"
UNITS = {"h": "s", "mu_omega": "m", "mu_v": "-", "steps": "-"}
"""Of fields that are well known by their last names."""
Columns = Mapping[str, Sequence[str]]
Points = list[tuple[Any, ...]]


def sweep_report(path: Path) -> Report:
    """The report on the table of a sweep.

    Parameters
    ----------
    path : Path
        Of ``runs.csv``.

    Returns
    -------
    Report

    Raises
    ------
    InputError
        If no sweep has written it.
    """
    text = text_of(bytes_read(path, largest=LARGEST_TEXT), path)
    try:
        head, *lines = csv.reader(io.StringIO(text))
        table = dict(zip(head, zip(*lines, strict=True), strict=True))
        end = head.index("outcome")
        axes = head[1:end]
        measures = head[end + 2 :]
        ends = [why or how for how, why in zip(table["outcome"], table["reason"], strict=True)]
        shown = measures[0], measures[measures.index(LAYER)]
        points = _points(table, axes[:2], shown)
    except (csv.Error, ValueError, LookupError):
        raise InputError("is no table of a sweep; run the sweep again", file=path) from None
    columns = [*(table[name] for name in axes), ends, *(table[name] for name in measures)]
    cells = tuple(tuple(map(_cell, line)) for line in zip(*columns, strict=True))
    units = [_with_unit(name, table[name]) for name in axes]
    names = (*units, "outcome", *measures)
    blocks: list[Block] = [Table("The runs.", path.name, names, cells, left=end)]
    if len(axes) <= 2 and points:
        drawn = {"axis": units[0], "panels": shown, "lines": points}
        where = f"{path.name}, outcome = {DONE}"
        blocks.insert(0, Picture("sweep", "sweep", drawn, f"{' and '.join(shown)}.", where))
    return Report(
        "Simulation parameters swept over a scenario",
        (Section("The runs", tuple(blocks)),
         Section("Method and limitations", tuple(sentences("sweep")))),
    )  # fmt: skip


def _points(table: Columns, axes: Sequence[str], shown: tuple[str, str]) -> dict[str, Points]:
    """Two measures of runs that were done, against the first parameter, by the second one."""
    first, *others = axes
    words = _has_words(table[first])
    lines: dict[str, Points] = {}
    for k, outcome in enumerate(table["outcome"]):
        numbers = [_number(table[name][k]) for name in shown]
        if outcome == DONE and None not in numbers:
            key = ", ".join(f"{name} = {_cell(table[name][k])}" for name in others)
            value = table[first][k]
            lines.setdefault(key, []).append((value if words else _number(value), *numbers))
    return {key: sorted(points) for key, points in lines.items()}


def _has_words(values: Sequence[str]) -> bool:
    return any(_number(text) is None for text in values)


def _with_unit(name: str, values: Sequence[str]) -> str:
    """A parameter with its unit; one of words has none."""
    if _has_words(values):
        return name
    units = {UNITS.get(field.split(".")[-1], OTHER) for field in name.split(",")}
    return f"{name} [{units.pop() if len(units) == 1 else OTHER}]"


def _number(text: str) -> float | None:
    try:
        value = float(text)
    except ValueError:
        return None
    return value if math.isfinite(value) else None


def _cell(text: str) -> str:
    value = _number(text)
    return (text or "-") if value is None else f"{value:.4g}"
