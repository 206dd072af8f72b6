"""Tables of measurements: CSV files with named columns, read with plain errors."""

import csv
import io
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from quasistatic_ref.errors import InputError
from quasistatic_ref.formats.files import bytes_read, text_of
from quasistatic_ref.formats.quoting import suggestion
from quasistatic_ref.step.data import Array, Indices

PAIR: Mapping[str, str] = {"surface": "what is pushed on", "shape": "name in shapes.json"}
"""The columns that name the object-surface pair of a row."""


@dataclass(frozen=True, eq=False)
class Table:
    """The rows of a CSV file.

    Parameters
    ----------
    pairs : tuple of str
        surface/shape of each row.
    numbers : dict of str to ndarray, each of shape (n,)
        Column by column [the column's unit].
    """

    pairs: tuple[str, ...]
    numbers: dict[str, Array]

    def rows(self, pair: str) -> Indices:
        """The rows of a pair."""
        return np.flatnonzero(np.array([name == pair for name in self.pairs]))

    def array(self, rows: Indices, *columns: str) -> Array:
        """Some columns of some rows, shape (rows, columns)."""
        return np.column_stack([self.numbers[name][rows] for name in columns])

    def __contains__(self, column: str) -> bool:
        return column in self.numbers


def table_read(path: Path, columns: Mapping[str, str], optional: Mapping[str, str]) -> Table:
    """A CSV file with a line of names and one row a line.

    Parameters
    ----------
    path : Path
    columns, optional : mapping of str to str
        Name -> unit and meaning of columns that must, and may, be there, next to those of PAIR.

    Raises
    ------
    InputError
        Naming file, line and column of what is missing, unknown or no finite number.
    """
    lines = list(csv.reader(io.StringIO(text_of(bytes_read(path), path))))
    if len(lines) < 2:
        raise InputError("must have a line of column names and a row", file=path)
    head = lines[0]
    for name in (*PAIR, *columns):
        if name not in head:
            raise InputError("is missing", file=path, field=f"column {name}")
    known = {*PAIR, *columns, *optional}
    for name in head:
        if name not in known:
            problem = f"is unknown{suggestion(name, known)}"
            raise InputError(problem, file=path, field=f"column {name}")
        if head.count(name) > 1:
            raise InputError("is given twice", file=path, field=f"column {name}")
    for number, line in enumerate(lines[1:], start=2):
        if len(line) != len(head):
            problem = f"must have {len(head)} entries"
            raise InputError(problem, file=path, field=f"line {number}", value=len(line))
    texts = dict(zip(head, zip(*lines[1:], strict=True), strict=True))
    pairs = tuple("/".join(words) for words in zip(*(texts[name] for name in PAIR), strict=True))
    numbers = {name: _column(path, name, texts[name]) for name in head if name not in PAIR}
    return Table(pairs, numbers)


def _column(path: Path, name: str, texts: tuple[str, ...]) -> Array:
    values = np.empty(len(texts))
    for k, text in enumerate(texts):
        try:
            values[k] = float(text)
        except ValueError:
            values[k] = np.nan
        if not np.isfinite(values[k]):
            where = f"line {k + 2}, column {name}"
            raise InputError("must be a finite number", file=path, field=where, value=text)
    return values
