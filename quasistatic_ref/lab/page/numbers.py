"""The tables of a report as one long table, a line for each cell: CSV, and Parquet."""

import csv
import io
from collections.abc import Iterator
from importlib import import_module
from typing import Any, Final

from quasistatic_ref.errors import InputError
from quasistatic_ref.lab.page.parts import Report, Table

COLUMNS: Final = ("section", "table", "rows", "line", "of", "column", "text", "value")


def cells(report: Report) -> Iterator[tuple[Any, ...]]:
    """Every cell of every table that holds a result.

    Parameters
    ----------
    report : Report

    Yields
    ------
    tuple
        As ``COLUMNS`` names them: the heading, the table's title and its filter, the number of
        the line from 0 on and its first columns as ``name = text``, the column, the text of the
        cell, and its value [the unit of the column], None where that is no number.
    """
    for section in report.sections:
        for table in (block for block in section.blocks if isinstance(block, Table)):
            for line, row in enumerate(table.rows):
                named = zip(table.columns[: table.left], row, strict=False)
                of = ", ".join(f"{name} = {text}" for name, text in named)
                head = (section.title, table.title, table.where, line, of)
                for column, text in list(zip(table.columns, row, strict=True))[table.left :]:
                    yield (*head, column, text, _value(text))


def csv_text(report: Report) -> str:
    """The cells as comma-separated values, names first."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(COLUMNS)
    writer.writerows(cells(report))
    return text.getvalue()


def parquet_bytes(report: Report) -> bytes:
    """The cells as a Parquet file.

    Raises
    ------
    InputError
        If pyarrow is not installed.
    """
    try:
        pyarrow, parquet = import_module("pyarrow"), import_module("pyarrow.parquet")
    except ImportError:
        words = "needs pyarrow, which is not installed; pip install 'quasistatic-ref[parquet]'"
        raise InputError(words, value="report.parquet") from None
    kinds = dict.fromkeys(COLUMNS, pyarrow.string())
    kinds |= {"line": pyarrow.int32(), "value": pyarrow.float64()}
    lines = list(cells(report))
    arrays = [
        pyarrow.array([line[k] for line in lines], kind) for k, kind in enumerate(kinds.values())
    ]
    out = io.BytesIO()
    parquet.write_table(pyarrow.table(arrays, list(COLUMNS)), out)
    return out.getvalue()


def _value(text: str) -> float | None:
    try:
        return float(text)
    except ValueError:
        return None
