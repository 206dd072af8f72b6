"""Points in the rows of a table, ascii or binary, under a header of lines: PLY and PCD."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import count

import numpy as np

from quasistatic_ref.errors import ModelError, about_field
from quasistatic_ref.model.readers.text import check_points, number_or_nan, point_lines
from quasistatic_ref.step.arrays import Array

LARGEST_HEADER = 2**20
"""Bytes in which a header must end."""


@dataclass(frozen=True)
class PointTable:
    """What a header says of the points, and what follows it.

    Parameters
    ----------
    columns : tuple of (str, str, int)
        Name, NumPy type and number of entries of each field of a point. Names are not unique: PCL
        pads with fields that are all called ``_``.
    count : int
        Number of points.
    ascii : bool
        Whether a point is a line of words; otherwise it is as many bytes as its columns have.
    body : bytes
        What follows the header.
    line : int
        Line number at which the body starts.
    """

    columns: tuple[tuple[str, str, int], ...]
    count: int
    ascii: bool
    body: bytes
    line: int

    @property
    def names(self) -> list[str]:
        """Names of the columns."""
        return [name for name, _, _ in self.columns]


def header_lines(content: bytes, last: str) -> Iterator[tuple[int, list[str], int]]:
    """Number and words of each line, and where the next one starts; ModelError after the last."""
    start = 0
    for number in count(1):
        end = content.find(b"\n", start, LARGEST_HEADER)
        if end < 0:
            raise ModelError(f"must end with {last}, within 1 MiB", field="header")
        words = content[start:end].decode("ascii", errors="replace").split()
        start = end + 1
        yield number, words, start


def table_points(table: PointTable, field: str, what: str) -> Array:
    """Positions of the points, shape (count, 3) [m], from the columns x, y and z.

    Parameters
    ----------
    table : PointTable
        With one column of each of these names.
    field, what : str
        What the format calls the table and its points, for messages.

    Raises
    ------
    ModelError
        If there are fewer points, or a line has another number of words or no numbers.
    """
    at = [table.names.index(name) for name in "xyz"]
    points = _ascii(table, at) if table.ascii else _binary(table, at)
    if len(points) < table.count:
        raise ModelError(f"must contain {table.count} {what}", field=field, value=len(points))
    return points


def _binary(table: PointTable, at: Sequence[int]) -> Array:
    point = np.dtype([(f"{i}", kind, (n,)) for i, (_, kind, n) in enumerate(table.columns)])
    held = min(len(table.body) // point.itemsize, table.count)
    check_points(held, "points")
    rows = np.frombuffer(table.body, dtype=point, count=held)
    with np.errstate(invalid="ignore"):  # of a signalling NaN, which is left out later
        return np.stack([rows[str(i)][:, 0].astype(np.float64) for i in at], axis=1)


def _ascii(table: PointTable, at: Sequence[int]) -> Array:
    *starts, width = np.cumsum([0, *(n for _, _, n in table.columns)]).tolist()
    points: list[list[float]] = []
    lines = point_lines(table.body.decode("ascii", errors="replace"))
    for number, line in enumerate(lines, start=table.line):
        if len(points) == table.count:
            break
        words = line.split()
        if words and len(words) != width:
            raise ModelError(f"must be {width} numbers", field=f"line {number}", value=line)
        if words:
            with about_field(f"line {number}"):
                points.append([number_or_nan(words[starts[i]]) for i in at])
    return np.array(points, dtype=np.float64).reshape(-1, 3)
