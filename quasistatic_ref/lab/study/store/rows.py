"""A row: what one measurement says about itself; as tables in Python, and as columns of a store."""

import json
import math
from collections.abc import Iterable, Mapping
from typing import Any

from quasistatic_ref.formats.files import json_text

Row = dict[str, Any]
SOLVED = "solved"
FAILED = "failed"
NAN = "nan"
WRONG_SHAPE = "wrong_shape"
CRASHED = "crashed"
TIMEOUT = "timeout"
MEMORY = "memory"
NOT_RUN = "not_run_budget"
REPLIED = (SOLVED, FAILED, NAN, WRONG_SHAPE)
OUTCOMES = (SOLVED, FAILED, CRASHED, TIMEOUT, MEMORY, NAN, WRONG_SHAPE, NOT_RUN)
CLOCKS = ("solver", "setup", "call", "low", "high", "first", "warm_up", "start", "spent")
"""Times of a row [s]."""
TABLES = {
    "digits": ("delta_q", "net_wrench", "multipliers"),
    "residuals": ("primal", "dual", "gap"),
    "allowed": ("primal", "dual", "gap"),
    "seconds": CLOCKS,
}
"""Fields that are tables."""
FLAGS = ("warm", "feasible", "said_optimal", "said_infeasible", "wrong",
                "wrong_multipliers", "clock_agrees", "repeats", "tuned", "present")  # fmt: skip
JSON = ("facts", "versions", "target", "options", "promise")
KEY = ("problem", "solver", "interface", "setting", "mode", "warm", "units", "repetition")
"""What makes a measurement the same one."""
MACHINE_DEPENDENT = ("seconds", "calls", "clock_agrees", "memory")
"""Fields that differ from run to run."""


def key_of(row: Row) -> tuple[Any, ...]:
    """The key of a row: equal for equal measurements, and sortable."""
    return (*(row[name] for name in KEY), row.get("machine", ""))


def label_of(row: Mapping[str, Any]) -> str:
    """A row's solver with its interface, ``interface:solver``."""
    return f"{row['interface']}:{row['solver']}"


def table(rows: Iterable[Row]) -> list[Row]:
    """Rows without what differs from run to run, sorted: equal for equal studies."""
    kept = [{k: v for k, v in row.items() if k not in MACHINE_DEPENDENT} for row in rows]
    return sorted(kept, key=key_of)


def flat(record: Mapping[str, Any]) -> Row:
    """A record as columns: tables side by side, lists and other tables as JSON."""
    columns: Row = {}
    for name, value in record.items():
        if name in TABLES and isinstance(value, dict):
            columns |= {f"{name}_{inner}": one for inner, one in value.items()}
        else:
            columns[name] = json_text(value) if name in JSON else value
    return columns


def nested(columns: Mapping[str, Any]) -> Row:
    """The record of some columns.

    Raises
    ------
    ValueError
        If a number is not finite: a study writes none in its place.
    """
    record: Row = {}
    for name, value in columns.items():
        if isinstance(value, float):
            _finite(value)
        table, _, inner = name.partition("_")
        if inner in TABLES.get(table, ()):
            record.setdefault(table, {})[inner] = value
        elif name in FLAGS and value is not None:
            record[name] = bool(value)
        else:
            record[name] = json.loads(value, parse_float=_finite) if name in JSON else value
    return record


def _finite(number: str | float) -> float:
    value = float(number)
    if not math.isfinite(value):
        raise ValueError("a number that is not finite")
    return value
