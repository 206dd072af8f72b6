"""A part of a program in whole numbers: its cost, its rows, and which of them are independent."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property, partial, reduce
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias, TypeVar

import numpy as np
from flint import arb, arb_mat, fmpq, fmpz

from quasistatic_ref.exact.components import connected_components
from quasistatic_ref.exact.program import EXACT, MatrixProgram, exact_matrix
from quasistatic_ref.exact.qp.sparse import first_independent, independent
from quasistatic_ref.exact.qp.sparse_matrix import stacked
from quasistatic_ref.numbers.arrays import Array, Indices
from quasistatic_ref.numbers.modulo import independent_modulo, independent_rows, primes
from quasistatic_ref.numbers.precision import working_precision

if TYPE_CHECKING:
    from quasistatic_ref.exact.qp.program import QuadraticProgram

Result = TypeVar("Result")
Sparse: TypeAlias = "dict[int, fmpz]"
"""The entries of a row that are not zero, by coordinate."""


class Unlucky(Exception):
    """A prime divides a determinant that is not zero: another prime decides."""


class Row(NamedTuple):
    """A row a x + c >= 0, or = 0, times a positive unit.

    Parameters
    ----------
    entries : dict of int to fmpz
        a; of a bound 1 or -1.
    side : fmpq
        c; a whole number but of a bound.
    unit : fmpq
        What both are multiplied by.
    """

    entries: Sparse
    side: fmpq
    unit: fmpq

    @property
    def bounded(self) -> int | None:
        """The one coordinate of a bound; None of another row."""
        return next(iter(self.entries)) if len(self.entries) == 1 else None


@dataclass(frozen=True, eq=False)
class Convex:
    """The cost of a block on the subspace that its equations leave, where it is convex.

    Parameters
    ----------
    P, q : list of dict of int to fmpz, list of fmpz
        With P positive semidefinite, times `unit`.
    unit : fmpq
    definite : bool
        Whether the block's own P is positive definite.
    """

    P: Sequence[Sparse]
    q: Sequence[fmpz]
    unit: fmpq
    definite: bool

    @property
    def balls(self) -> tuple[arb_mat, arb_mat]:
        """H, (n, n), and g, (n, 1), of 1/2 x'Hx - g'x, over the power of two next to `unit`."""
        n = len(self.q)
        with working_precision(EXACT):
            share = arb(2) ** (int(self.unit.q).bit_length() - int(self.unit.p).bit_length())
            H = arb_mat([dense(row, range(n)) for row in self.P]) * share
            return H, arb_mat(n, 1, [-v for v in self.q]) * share


class Block:
    """A part of a program that nothing couples to the rest.

    Parameters
    ----------
    program : QuadraticProgram
    coordinates, rows : ndarray of int, shapes (n,) and (m,)
        Which ones of the program these are.

    Attributes
    ----------
    n, m, equations : int
        Numbers of coordinates, of rows, and of equations, which are the first rows.
    entries : SparseMatrix
        The a, (m, n), of the rows a x + c >= 0 in float64.
    c : ndarray, shape (m,)
    P, q : list of dict of int to fmpz, list of fmpz
        The symmetric part of the cost, times `unit`.
    unit : fmpq
    is_linear : bool
        Whether P is zero.
    is_float : bool
        Whether P in float64 is symmetric, and P itself.
    """

    def __init__(self, program: QuadraticProgram, coordinates: Indices, rows: Indices) -> None:
        self.program, self.coordinates, self.rows = program, coordinates, rows
        self.n, self.m = len(coordinates), len(rows)
        self.equations = int((rows < program.rows.equations).sum())
        self.entries = program.rows.entries.some(rows, coordinates)
        self.c = program.rows.c[rows]
        n = self.n
        couplings = program.couplings.some(coordinates, coordinates)
        i, j = couplings.row, couplings.column
        self.is_linear = not len(i)
        exact_P, exact_q = (program.exact.get(name, {}) for name in ("P", "q"))
        self.is_float = not exact_P and (
            self.is_linear or np.array_equal(self.square, self.square.T)
        )
        places = [*coordinates[i] * len(program.q) + coordinates[j]] if exact_P else []
        others = {t: exact_P[k] for t, k in enumerate(places) if k in exact_P}
        others |= {len(i) + t: exact_q[k] for t, k in enumerate(coordinates) if k in exact_q}
        whole, unit = whole_numbers(np.append(couplings.value, program.q[coordinates]), others)
        square, self.q = (
            dict(zip(zip(i.tolist(), j.tolist(), strict=True), whole, strict=False)),
            whole[len(i) :],
        )
        self.P: list[Sparse] = [{} for _ in range(n)]
        for (k, t), v in square.items():
            self.P[k][t] = v if self.is_float else v + square[t, k]
        self.unit = unit
        if not self.is_float:
            self.q, self.unit = [2 * v for v in self.q], 2 * unit
        self._kept: dict[int, Row] = {}
        self._primes = primes()
        self.prime = next(self._primes)

    @property
    def square(self) -> Array:
        """P in float64, shape (n, n) [any unit]."""
        return self.program.P[np.ix_(self.coordinates, self.coordinates)]

    @cached_property
    def a(self) -> Array:
        """The rows' matrix with its zeros, shape (m, n) [any unit]."""
        return self.entries.dense()

    def lucky(self, decide: Callable[[], Result]) -> Result:
        """The answer of `decide`, called with one prime after another until it has one."""
        while True:
            try:
                return decide()
            except Unlucky:
                self.prime = next(self._primes)

    def row(self, i: int) -> Row:
        """Row i in whole numbers."""
        if i not in self._kept:
            at, values = self.entries.entries(i)
            numbers = np.append(values, self.c[i])
            others = self.program.rows.others(int(self.rows[i]), self.coordinates[at].tolist())
            (*entries, side), unit = whole_numbers(numbers, others)
            c = fmpq(side)
            if len(entries) == 1:
                size = abs(entries[0])
                entries, c, unit = [fmpz(1 if entries[0] > 0 else -1)], c / size, unit / size
            self._kept[i] = Row(dict(zip(at.tolist(), entries, strict=True)), c, unit)
        return self._kept[i]

    def combined(self, factors: Mapping[int, fmpq]) -> tuple[dict[int, fmpq], fmpq]:
        """The sum of rows a x + c, each times its factor: the entries that are left, and c."""
        total: dict[int, fmpq] = {}
        limit = fmpq(0)
        for i, v in factors.items():
            entries, side, unit = self.row(i)
            limit += v / unit * side
            for j, entry in entries.items():
                total[j] = total.get(j, fmpq(0)) + v / unit * entry
        return {j: v for j, v in total.items() if v}, limit

    def spread(self, numbers: Iterable[Any], zero: Any) -> list[Any]:
        """Numbers of the block's coordinates among zeros of all others."""
        entries = dict(zip(self.coordinates.tolist(), numbers, strict=True))
        return [entries.get(j, zero) for j in range(len(self.program.q))]

    def split(self, W: Iterable[int]) -> tuple[dict[int, int], list[int], list[int]]:
        """The bounds of some rows by coordinate, the other rows, and the other coordinates."""
        bounds: dict[int, int] = {}
        general = []
        for i in W:
            j = self.row(i).bounded
            if j is None or j in bounds:
                general.append(i)
            else:
                bounds[j] = i
        return bounds, general, [j for j in range(self.n) if j not in bounds]

    def independent(self, W: Sequence[int]) -> list[int]:
        """The rows, in order of preference, that do not depend on earlier ones."""
        some = [*W]
        if {*range(self.equations)} <= {*W}:
            some = [i for i in W if i >= self.equations or i in self.held_equations]
        if self.surely_independent(some):
            return some
        return [some[t] for t in self._first_independent(some)]

    @cached_property
    def held_equations(self) -> frozenset[int]:
        """Equations that are independent, the first ones; the others depend on these."""
        return frozenset(self._first_independent(range(self.equations)))

    def are_independent(self, W: Sequence[int]) -> bool:
        """Whether rows are independent."""
        return len(self.independent(W)) == len(W)

    def surely_independent(self, W: Sequence[int]) -> bool:
        """Whether a prime proves that rows are independent."""
        _, general, rest = self.split(W)
        return independent([self.row(i).entries for i in general], rest, self.prime)

    def _first_independent(self, W: Iterable[int]) -> list[int]:
        """Places of rows that are independent, each the first of those before it."""
        return first_independent([self.row(i).entries for i in W], range(self.n), independent_rows)

    def free_coordinates(self, W: Sequence[int], P: Sequence[Sparse]) -> list[int]:
        """One coordinate for each direction that P and the rows W leave free, modulo a prime."""
        _, general, rest = self.split(W)
        lines = [row for j in rest if (row := P[j])] + [self.row(i).entries for i in general]
        columns: dict[int, Sparse] = {j: {} for j in rest}
        for t, line in enumerate(lines):
            for j, v in line.items():
                if j in columns:
                    columns[j][t] = v
        if independent([*columns.values()], range(len(lines)), self.prime):
            return []
        choose = partial(independent_modulo, prime=self.prime)
        held = {rest[t] for t in first_independent([*columns.values()], range(len(lines)), choose)}
        return [j for j in rest if j not in held]

    @cached_property
    def form(self) -> MatrixProgram:
        """The program for the dual method, where P is positive definite."""
        H, g = Convex(self.P, self.q, self.unit, definite=True).balls
        return matrix_form(H, g, self.exact_rows, self.equations)

    @cached_property
    def exact_rows(self) -> list[list[arb]]:
        """All rows [a, c], each times its `row_units`."""
        rows = exact_matrix(np.column_stack([self.a, self.c])).tolist()
        for i in self.row_units:
            entries, side, _ = self.row(i)
            rows[i] = [arb(v * side.q) for v in dense(entries, range(self.n))] + [arb(side.p)]
        return rows

    @cached_property
    def row_units(self) -> dict[int, fmpq]:
        """The factors by which `exact_rows` multiplies rows that float64 does not hold."""
        others = self.program.rows.others
        odd = (i for i, k in enumerate(self.rows.tolist()) if others(k, self.coordinates.tolist()))
        return {i: self.row(i).unit * self.row(i).side.q for i in odd}


def matrix_form(
    H: arb_mat, g: arb_mat, rows: Sequence[Sequence[arb]], equations: int
) -> MatrixProgram:
    """A program of exact numbers; it may have no rows [a, c]."""
    n = H.nrows()
    return MatrixProgram(H, g, arb_mat([*rows]) if rows else arb_mat(0, n + 1), equations=equations)


def dense(entries: Mapping[int, fmpz], columns: Iterable[int]) -> list[fmpz]:
    """Some entries of a sparse row, zeros included."""
    return [entries.get(j, fmpz(0)) for j in columns]


def whole_numbers(numbers: Array, others: Mapping[int, Fraction]) -> tuple[list[fmpz], fmpq]:
    """Numbers times the positive unit that makes them whole, and that unit.

    Parameters
    ----------
    numbers : ndarray, shape (k,)
        [Any unit.]
    others : mapping of int to Fraction
        Those that float64 does not hold, by place.
    """
    if others:
        pairs = [v.as_integer_ratio() for v in numbers.tolist()]
        pairs = [others[k].as_integer_ratio() if k in others else v for k, v in enumerate(pairs)]
        common = reduce(lambda u, v: u.lcm(v[1]), pairs, fmpz(1))
        return [fmpz(p) * (common / q) for p, q in pairs], fmpq(common)
    part, power = np.frexp(numbers)
    m = np.ldexp(part, 53).astype(np.int64)
    zeros = np.maximum(np.frexp((m & -m).astype(np.float64))[1] - 1, 0)
    m, power = m >> zeros, power - 53 + zeros
    least = int(power[m != 0].min(initial=2000)) if m.any() else 0
    shift = np.where(m != 0, power - least, 0)
    whole = [fmpz(v << k) for v, k in zip(m.tolist(), shift.tolist(), strict=True)]
    return whole, fmpq(2) ** -least


def along(entries: Sparse, x: Any) -> Any:
    """The product of a sparse row with numbers by coordinate; those that are missing are zero."""
    if isinstance(x, dict):
        return sum((v * x[j] for j, v in entries.items() if j in x), fmpz(0))
    return sum((v * x[j] for j, v in entries.items()), fmpz(0))


def shortest(v: Sequence[fmpz]) -> list[fmpz]:
    """Whole numbers without a common factor; not all are zero."""
    content = reduce(lambda a, b: a.gcd(b), v, fmpz(0))
    return [(fmpq(a) / content).p for a in v]


def blocks_of(program: QuadraticProgram) -> list[Block]:
    """The blocks of a program, in the order of their first coordinates."""
    n = len(program.q)
    every = stacked([program.couplings, program.rows.entries])
    itself = np.arange(n)
    pairs = np.append(every.row, itself), np.append(every.column, itself)
    coordinate, group = connected_components(*pairs, (len(every.counts), n))
    row = group[n:]
    return [
        Block(program, np.flatnonzero(coordinate == first), np.flatnonzero(row == first))
        for first in np.unique(coordinate)
    ]
