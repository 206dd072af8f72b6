"""Programs in ``.qps`` files, the MPS format with a quadratic cost, read as decimals.

Where readers differ, this one does as follows, or refuses: a right-hand side of the objective is
minus its constant; a range on an equation goes to the side of its sign; QUADOBJ and QSECTION hold
one triangle of P, QMATRIX all of it; MAX negates the cost; entries that come twice are added up; of
several sets of right-hand sides, ranges or bounds the first is taken, and a warning says so; names
may have blanks if all fields are in the fixed columns.
"""

from __future__ import annotations

import math
import re
import warnings
from collections import defaultdict
from collections.abc import Callable, Container, Iterator, Sequence
from fractions import Fraction
from itertools import count, pairwise
from typing import Final, TypeVar

import numpy as np

from quasistatic_ref.errors import InputError
from quasistatic_ref.exact.qp.program import QuadraticProgram, check_symmetric
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.numbers.precision import nearest

Result = TypeVar("Result")

DECIMAL: Final = re.compile(r"([+-]?(?:\d+\.?\d*|\.\d+))(?:[eEdD]([+-]?\d{1,3}))?", re.ASCII)
MOST_DIGITS: Final = 800
"""Characters of a number: float64's own have 767 digits at most."""
INFINITE: Final = re.compile(r"([+-]?)inf(?:inity)?", re.IGNORECASE)
COLUMNS: Final = ((1, 3), (4, 12), (14, 22), (24, 36), (39, 47), (49, 61))
"""Where the six fields stand."""
SIF: Final = {"GROUPS", "VARIABLES", "CONSTANTS", "ELEMENT", "GROUP", "OBJECT", "CONSTRAINTS"}
SECTIONS: Final = ("NAME", "ROWS", "COLUMNS", "RHS", "RANGES", "BOUNDS", "ENDATA")
QUADRATIC: Final = ("QUADOBJ", "QSECTION", "QMATRIX")
WHOLE: Final = {"BV", "LI", "UI", "SC", "SI"}


class _Qps:
    """What the lines of a file have said so far."""

    def __init__(self) -> None:
        self.section, self.maximise = "", False
        self.kinds: dict[str, str] = {}
        self.objective: str | None = None
        self.columns: dict[str, dict[str, Fraction]] = {}
        self.sides: dict[str, Fraction] = {}
        self.ranges: dict[str, Fraction] = {}
        self.low: dict[str, Fraction | None] = {}
        self.high: dict[str, Fraction | None] = {}
        self.costs: defaultdict[tuple[str, str], Fraction] = defaultdict(Fraction)
        self.quadratic = ""
        self.sets: dict[str, str] = {}
        self.others: dict[str, str] = {}

    def take(self, fields: list[str]) -> None:
        """One line of data."""
        section = self.section
        if section == "OBJSENSE":
            self._sense(fields[0])
        elif section == "ROWS":
            kind, name = fields
            if name in self.kinds:
                raise InputError("is declared twice; leave one out", field=name)
            if kind.upper() not in ("N", "E", "L", "G"):
                raise InputError("must be N, E, L or G", field=name, value=kind)
            self.kinds[name] = kind.upper()
            if self.objective is None and kind.upper() == "N":
                self.objective = name
        elif section == "COLUMNS":
            if "'MARKER'" in fields:
                problem = "begins or ends whole numbers, which are not solved for; leave it out"
                raise InputError(problem, field=fields[0])
            entries = self.columns.setdefault(fields[0], {})
            for row, v in _pairs(fields[1:]):
                self._known(row, self.kinds)
                entries[row] = entries.get(row, Fraction(0)) + v
        elif section in ("RHS", "RANGES"):
            into = self.sides if section == "RHS" else self.ranges
            named = len(fields) % 2
            first = self._is_first(fields[0] if named else "")
            for row, v in _pairs(fields[named:]):
                self._known(row, self.kinds)
                if first:
                    into[row] = v
        elif section == "BOUNDS":
            self._bound(fields)
        elif section in QUADRATIC:
            for column, v in _pairs(fields[1:]):
                self._known(fields[0], self.columns)
                self._known(column, self.columns)
                self.costs[fields[0], column] += v
        else:
            problem = "stands in no section; a section comes first, as ROWS"
            raise InputError(problem, field=section or "a line")

    def head(self, words: list[str]) -> bool:
        """One line that begins a section; whether it is the last."""
        word = words[0].upper()
        if word in SIF:
            raise InputError("is in CUTEst's SIF language: decode it first", field=word)
        if word in QUADRATIC:
            if self.quadratic not in ("", word):
                raise InputError(f"stands beside {self.quadratic}; leave one out", field=word)
            self.quadratic = word
        elif word in ("OBJSENSE", "MAX", "MIN"):
            self._sense(words[-1])
        elif word not in SECTIONS:
            known = ", ".join((*SECTIONS, *QUADRATIC))
            raise InputError(f"is no known section; known are {known}", field=word)
        self.section = word
        return word == "ENDATA"

    def _sense(self, word: str) -> None:
        sense = word.upper()[:3]
        if sense not in ("MAX", "MIN", "OBJ"):
            raise InputError("must be MAX or MIN", field="OBJSENSE", value=word)
        self.maximise = sense == "MAX"

    def _is_first(self, name: str) -> bool:
        """Whether a line is of the first set of its section, by the name of its set."""
        first = self.sets.setdefault(self.section, name)
        if name != first:
            self.others.setdefault(self.section, name)
        return name == first

    def _warn_of_sets(self) -> None:
        """Say which set of a section is taken, where there are several."""
        for section, other in self.others.items():
            first, left = (f"{name!r}" if name else "one without a name"
                           for name in (self.sets[section], other))  # fmt: skip
            problem = f"{section} has several sets: the first, {first}, is taken, {left} left out"
            warnings.warn(problem, stacklevel=2)

    def _known(self, name: str, names: Container[str]) -> None:
        if name not in names:
            raise InputError("is declared in no section ROWS or COLUMNS; declare it", field=name)

    def _bound(self, fields: list[str]) -> None:
        kind, free = fields[0].upper(), fields[0].upper() in ("FR", "MI", "PL")
        if kind in WHOLE:
            problem = "is a bound of whole or semi-continuous variables; use LO, UP or FX"
            raise InputError(problem, field=kind)
        if len(fields) > 4:
            problem = "has too many fields; give at most four"
            raise InputError(problem, field=kind, value=" ".join(fields))
        unnamed = len(fields) == (2 if free else 3)
        name = fields[1] if unnamed else fields[2]
        self._known(name, self.columns)
        v = None if free else _number(fields[-1])
        if v is None and not free:  # infinite
            sign = "-" if fields[-1].startswith("-") else "+"
            if kind == "FX" or (kind, sign) in (("LO", "+"), ("UP", "-")):
                problem = "must be a finite number, or infinite the other way"
                raise InputError(problem, field=f"{kind} {name}", value=fields[-1])
        if not self._is_first("" if unnamed else fields[1]):
            return
        if kind in ("LO", "FX", "FR", "MI"):
            self.low[name] = v
        if kind in ("UP", "FX", "FR", "PL"):
            self.high[name] = v
        if kind not in ("LO", "UP", "FX", "FR", "MI", "PL"):
            raise InputError("must be one of LO, UP, FX, FR, MI and PL", field="bound", value=kind)

    def limits(self) -> Iterator[tuple[str, str, Fraction]]:
        """Each row's name with ``=``, ``<=`` or ``>=`` and a side; one with a range comes twice."""
        for row, kind in self.kinds.items():
            side, size = self.sides.get(row, Fraction(0)), self.ranges.get(row)
            low = high = side
            if size is not None and kind != "N":
                high += abs(size) if kind == "G" or (kind == "E" and size > 0) else 0
                low -= abs(size) if kind == "L" or (kind == "E" and size < 0) else 0
            if kind == "E" and not size:
                yield row, "=", side
            elif kind != "N":
                if kind != "G" or size is not None:
                    yield row, "<=", high
                if kind != "L" or size is not None:
                    yield row, ">=", low

    def program(self, check_size: Callable[..., None]) -> QuadraticProgram:
        """The program of all lines."""
        self._warn_of_sets()
        names = {name: j for j, name in enumerate(self.columns)}
        n = len(names)
        if not n:
            raise InputError("has no columns; add one", field="COLUMNS")
        for name, v in self.high.items():
            if v is not None and v < 0 and name not in self.low:
                problem = "is below 0 without a lower bound: readers differ; add LO, or MI for none"
                raise InputError(
                    problem, field=f"UP {name}", value=nearest(v.numerator, v.denominator)
                )
        by_row: dict[str, dict[int, Fraction]] = {row: {} for row in self.kinds}
        for name, entries in self.columns.items():
            for row, v in entries.items():
                by_row[row][names[name]] = v
        G, A = _Rows(), _Rows()
        for row, sense, side in self.limits():
            if sense == "=":
                A.add(by_row[row], side, 1)
            else:
                G.add(by_row[row], side, 1 if sense == "<=" else -1)
        check_size(n, len(G.sides) + len(A.sides), linear=not any(self.costs.values()))
        way = -1 if self.maximise else 1
        P: defaultdict[int, Fraction] = defaultdict(Fraction)
        for (one, other), v in self.costs.items():
            i, j = names[one], names[other]
            P[i * n + j] += way * v
            if i != j and self.quadratic != "QMATRIX":
                if (other, one) in self.costs:
                    problem = f"has both triangles at {one}, {other}; QMATRIX is for all of P"
                    raise InputError(problem, field=self.quadratic)
                P[j * n + i] += way * v
        linear = by_row[self.objective] if self.objective else {}
        constant = -way * self.sides.get(self.objective or "", Fraction(0))
        least = {j: self.low.get(name, Fraction(0)) for name, j in names.items()}
        parts = {
            "P": _filled((n, n), P),
            "q": _filled((n,), {j: way * v for j, v in linear.items()}),
            "G": _filled((len(G.sides), n), G.entries(n)),
            "h": _filled((len(G.sides),), dict(enumerate(G.sides))),
            "A": _filled((len(A.sides), n), A.entries(n)),
            "b": _filled((len(A.sides),), dict(enumerate(A.sides))),
            "lb": _filled((n,), {j: v for j, v in least.items() if v is not None}, -np.inf),
            "ub": _filled(
                (n,), {names[k]: v for k, v in self.high.items() if v is not None}, np.inf
            ),
            "constant": _filled((1,), {0: constant}),
        }
        arrays = {name: array for name, (array, _) in parts.items()}
        check_symmetric(arrays["P"])
        number = float(arrays.pop("constant")[0])
        exact = {name: others for name, (_, others) in parts.items() if others}
        return QuadraticProgram(**arrays, constant=number, exact=exact)


class _Rows:
    """Rows a x <= side."""

    def __init__(self) -> None:
        self.lines: list[dict[int, Fraction]] = []
        self.sides: list[Fraction] = []

    def add(self, line: dict[int, Fraction], side: Fraction, way: int) -> None:
        self.lines.append({j: way * v for j, v in line.items()})
        self.sides.append(way * side)

    def entries(self, n: int) -> dict[int, Fraction]:
        return {i * n + j: v for i, line in enumerate(self.lines) for j, v in line.items()}


def _filled(
    shape: tuple[int, ...], entries: dict[int, Fraction], other: float = 0.0
) -> tuple[Array, dict[int, Fraction]]:
    """An array of the nearest float64 numbers, and what float64 does not hold."""
    flat = np.full(math.prod(shape), other) if other else np.zeros(math.prod(shape))
    exact = {}
    for place, v in entries.items():
        flat[place] = nearest(v.numerator, v.denominator)
        if abs(flat[place]) == np.inf or (v and not flat[place]):
            problem = "is beyond the range of float64; use other units"
            raise InputError(problem, value=_near(v))
        if flat[place] != v:
            exact[place] = v
    return flat.reshape(shape), exact


def _near(v: Fraction) -> float | str:
    """A number for a sentence, or where float64 has none its size."""
    number = nearest(v.numerator, v.denominator)
    if number and abs(number) < np.inf:
        return number
    power = (v.numerator.bit_length() - v.denominator.bit_length()) * math.log10(2)
    return f"{'-' if v < 0 else ''}1e{power:.0f}, about"


def _number(text: str) -> Fraction | None:
    """A decimal, or None of an infinite number."""
    if len(text) > MOST_DIGITS:
        problem = f"has more than {MOST_DIGITS} characters, which no number of float64 needs"
        raise InputError(problem, value=f"{text[:20]}...")
    if found := DECIMAL.fullmatch(text):
        return Fraction(found[1]) * Fraction(10) ** int(found[2] or 0)
    if INFINITE.fullmatch(text):
        return None
    raise InputError("must be a number", value=text)


def _pairs(fields: Sequence[str]) -> Iterator[tuple[str, Fraction]]:
    if len(fields) not in (2, 4):
        raise InputError("must be a name and a number, once or twice", value=" ".join(fields))
    for name, text in zip(fields[::2], fields[1::2], strict=True):
        v = _number(text)
        if v is None:
            raise InputError("must be a finite number", field=name, value=text)
        yield name, v


def qps_program(text: str, check_size: Callable[..., None]) -> QuadraticProgram:
    """The program of a file's text.

    Parameters
    ----------
    text : str
    check_size : callable
        Of numbers of variables and rows, and ``linear``; it refuses what is too large.

    Raises
    ------
    InputError
        Naming the line and what is wrong with it.
    """
    return _taken(text, lambda read: read.program(check_size))


def qps_names(text: str) -> dict[str, str]:
    """What a file calls the rows of its program, by the names that answers have for them.

    ``G[2]`` is ``R7 <=``, ``lb[0]`` is ``X1 >=``, and an equation its name alone.

    Raises
    ------
    InputError
        As of :func:`qps_program`.
    """

    def names(read: _Qps) -> dict[str, str]:
        counts = {"A": count(), "G": count()}
        by_name = {}
        for row, sense, _ in read.limits():
            kind = "A" if sense == "=" else "G"
            by_name[f"{kind}[{next(counts[kind])}]"] = f"{row} {sense}".removesuffix(" =")
        for j, column in enumerate(read.columns):
            by_name |= {f"lb[{j}]": f"{column} >=", f"ub[{j}]": f"{column} <="}
        return by_name

    return _taken(text, names)


def _taken(text: str, take: Callable[[_Qps], Result]) -> Result:
    """What is taken of a file, whose fields are apart by blanks, or else in the fixed columns."""
    try:
        return take(_read(text, _free_fields))
    except InputError:
        try:  # names with blanks
            read = _read(text, _fixed_fields)
        except InputError:
            read = None
        if read is None:
            raise
        return take(read)


def _read(text: str, fields_of: Callable[[str], list[str]]) -> _Qps:
    read = _Qps()
    for k, line in enumerate(text.splitlines(), 1):
        if not line.strip() or line.startswith("*"):
            continue
        try:
            if line[0].isspace():
                if fields := fields_of(line):
                    read.take(fields)
            elif read.head(line.split()):
                return read
        except InputError as error:
            error.field = f"line {k}" + (f", {error.field}" if error.field else "")
            raise
        except (ValueError, IndexError):
            problem = "must have as many fields as lines of its section"
            raise InputError(problem, field=f"line {k}") from None
    raise InputError("ends without ENDATA; add this line, if nothing is cut off")


def _free_fields(line: str) -> list[str]:
    fields = line.split()
    comment = next((k for k, field in enumerate(fields) if field.startswith("$")), None)
    return fields[:comment]


def _fixed_fields(line: str) -> list[str]:
    between = [line[b:c] for (_, b), (c, _) in pairwise([(0, 0), *COLUMNS, (len(line), 0)])]
    if any(text.strip() for text in between[: 1 + len(COLUMNS)]):
        raise ValueError  # not in the columns
    fields = [line[a:b].strip() for a, b in COLUMNS]
    comment = next((k for k in (2, 4) if fields[k].startswith("$")), None)
    return [field for field in fields[:comment] if field]
