"""The report on a sweep of simulation parameters: a table and a figure for each."""

from collections.abc import Mapping, Sequence
from typing import Any

from quasistatic_ref.lab.page.parts import Block, Picture, Report, Section, Table
from quasistatic_ref.lab.study.report.studied import place_tables
from quasistatic_ref.lab.study.report.words import sentences
from quasistatic_ref.lab.study.store.rows import Row

UNITS = {"h": "s", "mu_omega": "m", "K_width": "N/m", "mu_v": "-", "k": "-"}
"""Of axes that are well known by their names."""
OTHER = "the scenario's unit"
LAYER = "boundary_layer_um"


def sweep_report(study: Mapping[str, Any], rows: Sequence[Row]) -> Report:
    """The report on a store of sweeps.

    Parameters
    ----------
    study : mapping
        As a store has it.
    rows : sequence of dict

    Returns
    -------
    Report
    """
    sections = [
        Section(sweep["name"], tuple(_blocks(sweep, [r for r in rows if r["sweep"] == name], k)))
        for k, (sweep, name) in enumerate((s, s["name"]) for s in study["sweeps"])
    ]
    return Report(
        "Simulation parameters swept over scenarios",
        (*sections, Section("Method and limitations", tuple(sentences("sweep"))),
         Section("Machine and versions", tuple(place_tables(study)))),
    )  # fmt: skip


def _blocks(sweep: Mapping[str, Any], rows: Sequence[Row], number: int) -> list[Block]:
    axes = list(rows[0]["values"]) if rows else []
    names = list(dict.fromkeys(name for row in rows for name in row["measures"]))
    ordered = sorted(rows, key=lambda row: [_sort_key(v) for v in row["values"].values()])
    cells = tuple(
        (*(_cell(v) for v in row["values"].values()), row["reason"] or row["outcome"],
         *(_cell(row["measures"].get(key)) for key in names))
        for row in ordered
    )  # fmt: skip
    where = f"sweep = {sweep['name']}"
    columns = (*(_axis(a, rows) for a in axes), "outcome", *names)
    blocks: list[Block] = [
        Table(f"{sweep['scenario']}.", where, columns, cells, left=len(axes) + 1)
    ]
    whole = [row for row in ordered if row["outcome"] == "done"]
    if whole and len(axes) <= 2:
        drawn = _line_data(axes, whole, (names[0], LAYER))
        words = f"{names[0]} and {LAYER}, {sweep['scenario']}."
        blocks.insert(0, Picture(f"sweep_{number + 1}", "sweep", drawn, words,
                                 f"{where}, outcome = done"))  # fmt: skip
    return blocks


def _line_data(axes: Sequence[str], rows: Sequence[Row], shown: tuple[str, str]) -> dict[str, Any]:
    """Lines of two measures against the first axis, one a value of the second."""
    lines: dict[str, list[tuple[Any, float, float]]] = {}
    for row in rows:
        first, *rest = row["values"].values()
        key = f"{axes[1]} = {_cell(rest[0])} {UNITS.get(axes[1], '')}".strip() if rest else ""
        lines.setdefault(key, []).append((first, *(row["measures"][name] for name in shown)))
    return {"axis": _axis(axes[0], rows), "panels": shown, "lines": lines}


def _axis(name: str, rows: Sequence[Row]) -> str:
    """An axis with its unit; one of words has none."""
    if any(isinstance(row["values"][name], str) for row in rows):
        return name
    return f"{name} [{UNITS.get(name, OTHER)}]"


def _sort_key(value: object) -> tuple[int, float, str]:
    return (0, float(value), "") if isinstance(value, int | float) else (1, 0.0, str(value))


def _cell(value: object) -> str:
    if value is None:
        return "-"
    return f"{value:.4g}" if isinstance(value, int | float) else str(value)
