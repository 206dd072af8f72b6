"""Points in a text of columns: which columns are x, y and z, and in which unit.

What could be read as another cloud is refused: numbers of the lines before the points, decimal
commas between commas, rows of another separator than their names.
"""

from array import array
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from quasistatic_ref.errors import ModelError, about_field
from quasistatic_ref.files.rows import (
    BLANKS,
    check_decimal_point,
    check_separator,
    names_of,
    separator_of,
    words_of,
)
from quasistatic_ref.files.text import check_equal, check_points, number_or_nan, point_lines
from quasistatic_ref.numbers.arrays import Array

UNITS = {"m": 1.0, "cm": 1e-2, "mm": 1e-3, "in": 0.0254}
"""[m]"""
BRACKETS = {"]": "[", ")": "("}
"""The end of a unit behind a name, and its beginning."""
LONGEST_COUNT = 18
"""Most digits of the number of points in a first line."""


@dataclass(frozen=True)
class Columns:
    """Where the rows of a text have x, y and z.

    Parameters
    ----------
    separator : str
        Of the words in a row.
    width : int
        How many columns there are.
    places : sequence of int
        Columns of x, y and z.
    is_sure : bool
        Whether names say so that cannot be parted otherwise, as "Point ID" between blanks can.
    unit : str or None
        That the names state.
    """

    separator: str
    width: int
    places: Sequence[int] = (0, 1, 2)
    is_sure: bool = False
    unit: str | None = None

    def point(self, row: str) -> list[float]:
        """The coordinates in a row, [x, y, z]; ModelError if it has other columns."""
        check_separator(row, self.separator, ModelError)
        words = words_of(row, self.separator)
        if len(words) < 3:
            raise ModelError("must be three numbers, x y z", value=row)
        if len(words) != self.width:
            problem = f"must have {self.width} columns, as the first row has"
            raise ModelError(problem, value=row)
        point = [_number(words[place]) for place in self.places]
        if not self.is_sure and self.places[0] > 0:
            for word in words:  # such as two words of a name, which would move the columns
                _number(word)
        return point


def text_points(text: str) -> tuple[Array, str | None]:
    """Points of a text of columns, (N, 3) [the unit], and the unit that its names state, or None.

    Raises
    ------
    ModelError
        Naming the line that is no point, or that leaves open which numbers are x, y and z.
    """
    lines = point_lines(text)
    rows = _rows(lines)
    number, row = next(rows, (1, ""))
    stated = None
    if row.isascii() and row.isdecimal() and len(row) <= LONGEST_COUNT:
        stated = int(row)
        number, row = next(rows, (1, ""))
    with about_field(f"line {number}"):
        columns = _named(row)
    if columns is not None:
        number, row = next(rows, (1, ""))
    elif row:
        columns = _of_comment(lines[: number - 1], row)
    points = np.zeros((0, 3))
    if columns is not None and row:
        points = _points(columns, lines, number)
        _check_places(columns, points, lines, number)
    check_points(len(points))
    check_equal("points", len(points), len(points) if stated is None else stated)
    return points, None if columns is None else columns.unit


def _rows(lines: Sequence[str], first: int = 1) -> Iterator[tuple[int, str]]:
    """Numbers and contents of the lines that hold more than a comment, from a line on."""
    for number, line in enumerate(lines[first - 1 :], start=first):
        if row := line.split("#", 1)[0].strip():
            yield number, row


def _number(word: str) -> float:
    check_decimal_point(word, ModelError)
    return number_or_nan(word)


def _named(row: str) -> Columns | None:
    """The columns that a row of names has; None of a row of numbers."""
    row = row.removeprefix("//").strip()
    separator = separator_of(row)
    names, units = _names_and_units(names_of(row, separator))
    if not any(axis in names for axis in "xyz"):
        if len(names) >= 3 and all(name[:1].isalpha() and name != "nan" for name in names):
            raise ModelError("must be numbers, or names, among them x, y and z", value=row)
        return None
    for axis in "xyz":
        if names.count(axis) != 1:
            raise ModelError(f"must name the column {axis} once", value=row)
    places = [names.index(axis) for axis in "xyz"]
    unit, *others = [units[place] for place in places]
    if others != [unit, unit]:
        raise ModelError("must have one unit, behind each of x, y and z", value=row)
    if unit is not None and unit not in UNITS:
        raise ModelError(f"must have one of the units {', '.join(UNITS)}", value=row)
    is_sure = separator != BLANKS or "\t" in row or '"' in row
    return Columns(separator, len(names), places, is_sure, unit)


def _names_and_units(words: Sequence[str]) -> tuple[list[str], list[str | None]]:
    """Of words such as ``X [mm]``: the names in small letters, and the units in brackets."""
    names: list[str] = []
    units: list[str | None] = []
    for word in words:
        begin = BRACKETS.get(word[-1:])
        name, bracket, unit = word[:-1].partition(begin) if begin else (word, "", "")
        names.append((name if bracket else word).strip().lower())
        units.append(unit.strip().lower() if bracket else None)
    return names, units


def _of_comment(above: Sequence[str], row: str) -> Columns:
    """The columns of rows without names: as a comment above them names all, or the first three."""
    separator = separator_of(row)
    width = len(words_of(row, separator))
    for number, line in reversed(list(enumerate(above, start=1))):
        comment = line.strip().removeprefix("#").strip()
        names, _ = _names_and_units(names_of(comment, separator_of(comment)))
        if any(names.count(axis) != 1 for axis in "xyz"):
            continue
        with about_field(f"line {number}"):
            named = _named(comment) if len(names) == width else None
            if named is not None:
                return replace(named, separator=separator)
            if width > 3:
                raise ModelError(f"must name each of the {width} columns, or none", value=comment)
    return Columns(separator, width)


def _points(columns: Columns, lines: Sequence[str], first: int) -> Array:
    """The points of all lines from one on, (N, 3)."""
    table = _table(lines[first - 1 :], columns.separator)
    if table is not None and table.shape[1] == columns.width >= 3:
        return np.asarray(table[:, columns.places])
    numbers = array("d")
    for number, row in _rows(lines, first):
        with about_field(f"line {number}"):
            numbers.extend(columns.point(row))
    return np.array(numbers).reshape(-1, 3)


def _table(lines: Sequence[str], separator: str) -> Array | None:
    """Numbers in equal columns, which NumPy reads at once; None where a line is something else."""
    try:
        table = np.loadtxt(lines, delimiter=None if separator == BLANKS else separator, ndmin=2)
    except ValueError:
        return None
    return None if np.isinf(table).any() else table


def _check_places(columns: Columns, points: Array, lines: Sequence[str], first: int) -> None:
    """Refuse columns that may not be x, y and z where no names say surely that they are."""
    if columns.width == 3 or columns.is_sure:
        return
    problem = ""
    rows = (row.split(",", 3)[:3] for _, row in _rows(lines, first))
    if columns.separator == "," and not any("." in word for row in rows for word in row):
        problem = "may have decimal commas, since x, y and z have no decimal point"
    elif _counts(points[:, 0]):
        problem = "has a number that counts the rows in the place of x; leave that out"
    if problem:
        problem += '; or name the columns in a first row, as "x","y","z","red"'
        raise ModelError(problem, field=f"line {first}", value=lines[first - 1])


def _counts(numbers: Array) -> bool:
    """Whether numbers are whole and count by one, from 0 or 1 on if there is but one."""
    is_counted = bool((np.diff(numbers) == 1).all() and numbers[0] % 1 == 0)
    return is_counted and (len(numbers) > 1 or numbers[0] in (0, 1))
