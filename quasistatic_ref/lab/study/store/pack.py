"""A store made small enough to keep in a repository: the same tables, shorter numbers."""

import math
import sqlite3
from contextlib import closing
from pathlib import Path
from typing import Any

from quasistatic_ref.formats.files import bytes_written, writable_folder
from quasistatic_ref.lab.study.store.rows import TABLES as PARTS
from quasistatic_ref.lab.study.store.rows import Row, flat
from quasistatic_ref.lab.study.store.store import (
    PACKED,
    STORE,
    TABLES,
    contents,
    packed_tables,
    records_of,
)

FIGURES = 3
"""Significant figures of times and residuals: their noise is larger."""
DECIMALS = 3
"""Of digits, which are rounded down, so that no threshold is passed that was not."""


def packed_store(folder: str | Path, out: str | Path) -> Path:
    """Write a store again, packed; ``study report`` reads it as it reads the other.

    Parameters
    ----------
    folder : str or Path
        A store; one that is packed is copied.
    out : str or Path

    Returns
    -------
    Path
        What was written. A packed store is not continued: ``study run`` starts a new one.
    """
    contents(folder)  # refuses what no study has written
    if not (Path(folder) / STORE).exists():
        return bytes_written(writable_folder(out) / PACKED, (Path(folder) / PACKED).read_bytes())
    with closing(sqlite3.connect(Path(folder) / STORE)) as store:
        tables = {name: _columns(store, name) for name in TABLES}
    return bytes_written(writable_folder(out) / PACKED, packed_tables(tables))


def shorter(row: Row) -> Row:
    """A row with its numbers shortened; twice shortened is once shortened."""
    short = dict(row)
    for part in PARTS:
        cut = _down if part == "digits" else _figures
        short[part] = {k: None if v is None else cut(v) for k, v in row[part].items()}
    return short


def _columns(store: sqlite3.Connection, name: str) -> dict[str, list[Any]]:
    """A table column by column, the numbers of its measurements shortened."""
    records = [shorter(one) if name == "rows" else one for one in records_of(store, name)]
    lines = [flat(record) for record in records]
    return {column: [line[column] for line in lines] for column in lines[0]} if lines else {}


def _down(value: float) -> float:
    scale = 10.0**DECIMALS
    return math.floor(round(value * scale, 6)) / scale


def _figures(value: float) -> float:
    return float(f"{value:.{FIGURES}g}")
