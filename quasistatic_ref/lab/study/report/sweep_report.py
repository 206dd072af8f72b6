"""The report on a sweep of simulation parameters: a table and a figure for each."""

from collections.abc import Mapping, Sequence
from typing import Any

from quasistatic_ref.lab.page.parts import Block, Picture, Report, Section, Table
from quasistatic_ref.lab.study.report.tables import place_tables
from quasistatic_ref.lab.study.report.words import sentences
from quasistatic_ref.lab.study.store.rows import Row

MEASURES = (
    ("rotation_deg", "largest rotation [deg]"),
    ("rise_mm", "rise [mm]"),
    ("travel_mm", "travel [mm]"),
    ("deepest_um", "deepest penetration [um]"),
    ("boundary_layer_um", "boundary layer [um]"),
    ("quasi_dynamic_number", "quasi-dynamic number [-]"),
    ("steps", "steps"),
    ("exact", "exact steps [-]"),
)
UNITS = {"h": "s", "mu_omega": "m", "K_width": "N/m", "mu_v": "-", "k": "-"}
"""Of axes that are well known by their names."""
OTHER = "the scenario's unit"


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
    names = [(key, words) for key, words in MEASURES if any(key in r["measures"] for r in rows)]
    ordered = sorted(rows, key=lambda row: [_sortable(v) for v in row["values"].values()])
    cells = tuple(
        (*(_cell(v) for v in row["values"].values()), row["reason"] or row["outcome"],
         *(_cell(row["measures"].get(key)) for key, _ in names))
        for row in ordered
    )  # fmt: skip
    where = f"sweep = {sweep['name']}"
    since = f"{sweep['link']} in {sweep['scenario']}, since {sweep['since']:g} s"
    columns = (*(_axis(a, rows) for a in axes), "outcome", *(words for _, words in names))
    blocks: list[Block] = [Table(f"{since}.", where, columns, cells, left=len(axes) + 1)]
    whole = [row for row in ordered if row["outcome"] == "done"]
    if whole and len(axes) <= 2:
        words = f"Rotation and boundary layer, {since}."
        blocks.insert(0, Picture(f"sweep_{number + 1}", "sweep", _drawn(axes, whole), words,
                                 f"{where}, outcome = done"))  # fmt: skip
    return blocks


def _drawn(axes: Sequence[str], rows: Sequence[Row]) -> dict[str, Any]:
    """Lines of the two measures against the first axis, one a value of the second."""
    lines: dict[str, list[tuple[Any, float, float]]] = {}
    for row in rows:
        first, *rest = row["values"].values()
        key = f"{axes[1]} = {_cell(rest[0])} {UNITS.get(axes[1], '')}".strip() if rest else ""
        measures = row["measures"]
        lines.setdefault(key, []).append(
            (first, measures["rotation_deg"], measures["boundary_layer_um"])
        )
    return {"axis": _axis(axes[0], rows), "lines": lines}


def _axis(name: str, rows: Sequence[Row]) -> str:
    """An axis with its unit; one of words has none."""
    if any(isinstance(row["values"][name], str) for row in rows):
        return name
    return f"{name} [{UNITS.get(name, OTHER)}]"


def _sortable(value: object) -> tuple[int, float, str]:
    return (0, float(value), "") if isinstance(value, int | float) else (1, 0.0, str(value))


def _cell(value: object) -> str:
    if value is None:
        return "-"
    return f"{value:.4g}" if isinstance(value, int | float) else str(value)
