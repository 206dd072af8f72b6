"""The table of steps that were solved in order: what a start from the step before is worth."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from quasistatic_ref.lab.page.parts import Block, Table
from quasistatic_ref.lab.study.calling.sessions import COLD
from quasistatic_ref.lab.study.measuring.grade import SOLVED
from quasistatic_ref.lab.study.report.numbers import digits, milliseconds
from quasistatic_ref.lab.study.store.rows import Row, label_of


def sequence_tables(rows: Sequence[Row], facts: Sequence[Mapping[str, Any]]) -> list[Block]:
    """A line for each solver, setting and mode, on all steps but the first of each sequence.

    Parameters
    ----------
    rows : sequence of dict
    facts : sequence of mapping
        Of the problems.
    """
    later = {fact["id"] for fact in facts if fact["place"]}
    groups: dict[tuple[str, ...], dict[str, list[Row]]] = {}
    for row in rows:
        if row["mode"] and row["problem"] in later:
            who = "@".join(filter(None, [label_of(row), row.get("machine")]))
            modes = groups.setdefault((who, row["setting"], row["units"]), {})
            modes.setdefault(row["mode"], []).append(row)
    lines = []
    for key, modes in groups.items():
        cold = _median_call(modes.get(COLD, []))
        for mode, own in modes.items():
            known = [row["iterations"] for row in own if row["iterations"] is not None]
            call = _median_call(own)
            lines.append((
                *key, mode, str(len(own)), str(sum(row["outcome"] == SOLVED for row in own)),
                digits(min(map(_delivered, own))), f"{np.median(known):g}" if known else "-",
                "-" if call is None else milliseconds(call),
                "-" if call is None or cold is None else f"{call / cold:.2f}",
            ))  # fmt: skip
    if not lines:
        return []
    names = ("solver", "setting", "units", "mode", "problems", "solved", "digits, worst",
             "iterations, median", "time, median [ms]", "over cold")  # fmt: skip
    title = "Steps of sequences, each from what the solver kept of the step before."
    return [Table(title, "mode is given, place > 0", names, tuple(lines), left=4)]


def _delivered(row: Row) -> float:
    return (row["digits"]["delta_q"] or 0.0) if row["outcome"] == SOLVED else 0.0


def _median_call(rows: Sequence[Row]) -> float | None:
    times = [row["seconds"]["call"] for row in rows if row["seconds"]["call"] is not None]
    return float(np.median(times)) if times else None
