"""Sparse systems in whole numbers: what has one entry is substituted, a nucleus is left."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import NamedTuple, cast

from flint import fmpq, fmpq_mat, fmpz, fmpz_mat

from quasistatic_ref.exact.time_limit import check_time
from quasistatic_ref.numbers.modulo import independent_modulo

Line = Mapping[int, fmpz]
"""The entries of a row that are not zero, by column."""


class Peeled(NamedTuple):
    """The order in which rows and columns with one entry leave a matrix.

    Parameters
    ----------
    first : list of (int, int)
        Row and column of each entry that is the only one of its row once those before have left.
    last : list of (int, int)
        Of each that is the only one of its column; the one that left last comes first.
    rows, columns : list of int
        Of the nucleus: what is left, in order.
    """

    first: list[tuple[int, int]]
    last: list[tuple[int, int]]
    rows: list[int]
    columns: list[int]


def peeled(lines: Sequence[Line], columns: Iterable[int], *, by_rows: bool = True) -> Peeled:
    """What is left of a matrix without rows and columns of one entry.

    Parameters
    ----------
    lines : sequence of dict of int to fmpz
        Its rows; entries of other columns do not count.
    columns : iterable of int
    by_rows : bool
        Whether rows of one entry leave, too.
    """
    lines_of: dict[int, set[int]] = {j: set() for j in columns}
    columns_of: list[set[int]] = [{j for j in line if j in lines_of} for line in lines]
    for i, some in enumerate(columns_of):
        for j in some:
            lines_of[j].add(i)
    left = dict.fromkeys(range(len(lines)))
    first: list[tuple[int, int]] = []
    last: list[tuple[int, int]] = []
    single_rows = [i for i, some in enumerate(columns_of) if by_rows and len(some) == 1]
    single_columns = [j for j, some in lines_of.items() if len(some) == 1]
    while single_rows or single_columns:
        if single_rows:
            i = single_rows.pop()
            if i not in left or len(columns_of[i]) != 1:
                continue
            (j,) = columns_of[i]
            first.append((i, j))
        else:
            j = single_columns.pop()
            if j not in lines_of or len(lines_of[j]) != 1:
                continue
            (i,) = lines_of[j]
            last.append((i, j))
        del left[i]
        for k in lines_of.pop(j):
            columns_of[k].discard(j)
            if by_rows and len(columns_of[k]) == 1:
                single_rows.append(k)
        for k in columns_of[i]:
            lines_of[k].discard(i)
            if len(lines_of[k]) == 1:
                single_columns.append(k)
    return Peeled(first, last[::-1], [*left], [*lines_of])


def independent(lines: Sequence[Line], columns: Sequence[int], prime: int) -> bool:
    """Whether a prime proves that rows are independent on some columns."""
    nucleus = peeled(lines, columns)
    matrix = _dense([lines[i] for i in nucleus.rows], nucleus.columns)
    return len(independent_modulo(matrix, prime)) == len(matrix)


def first_independent(
    lines: Sequence[Line],
    columns: Sequence[int],
    choose: Callable[[list[list[fmpz]]], list[int]],
) -> list[int]:
    """Places of rows that are independent, each the first of those before it.

    A row with a column of its own is independent of all others; `choose` has those of the rest.
    """
    nucleus = peeled(lines, columns, by_rows=False)
    matrix = _dense([lines[i] for i in nucleus.rows], nucleus.columns)
    held = [nucleus.rows[t] for t in choose(matrix)]
    return sorted([*held, *(i for i, _ in nucleus.last)])


def solution(
    lines: Sequence[Line], columns: Sequence[int], sides: Sequence[Sequence[fmpz]]
) -> tuple[list[list[fmpz]], fmpz]:
    """The x of a regular square system for each right side, times a common denominator, and that.

    Parameters
    ----------
    lines : sequence of dict of int to fmpz
        n rows; entries of other columns do not count.
    columns : sequence of int
        n of them.
    sides : sequence of list of fmpz
        n numbers each.

    Raises
    ------
    ZeroDivisionError
        If the system is singular.
    """
    check_time()
    nucleus = peeled(lines, columns)
    size = len(nucleus.rows)
    if size != len(nucleus.columns):
        raise ZeroDivisionError
    solutions: list[dict[int, fmpq]] = [{} for _ in sides]
    for i, j in nucleus.first:
        _substitute(lines[i], i, j, sides, solutions)
    if size:
        right = [
            [_rest(lines[i], side[i], x) for i in nucleus.rows]
            for side, x in zip(sides, solutions, strict=True)
        ]
        numerators, common = fmpq_mat([*right]).transpose().numer_denom()
        matrix = fmpz_mat(_dense([lines[i] for i in nucleus.rows], nucleus.columns))
        of_nucleus = cast("fmpq_mat", matrix.solve(numerators)).transpose().tolist()
        for x, numbers in zip(solutions, of_nucleus, strict=True):
            x |= {j: v / common for j, v in zip(nucleus.columns, numbers, strict=True) if v}
    for i, j in nucleus.last:
        _substitute(lines[i], i, j, sides, solutions)
    denominator = fmpz(1)
    for x in solutions:
        for v in x.values():
            denominator = denominator.lcm(v.q)
    zero = fmpq(0)
    return [[(x.get(j, zero) * denominator).p for j in columns] for x in solutions], denominator


def _substitute(
    line: Line,
    i: int,
    j: int,
    sides: Sequence[Sequence[fmpz]],
    solutions: Sequence[dict[int, fmpq]],
) -> None:
    """x_j by row i, where all other columns of it are known."""
    for side, x in zip(sides, solutions, strict=True):
        value = _rest(line, side[i], x) / line[j]
        if value:
            x[j] = value


def _rest(line: Line, side: fmpz, x: Mapping[int, fmpq]) -> fmpq:
    """What known columns leave of a right side; those that are zero are left out."""
    return side - sum((v * x[k] for k, v in line.items() if k in x), fmpq(0))


def _dense(lines: Iterable[Line], columns: Sequence[int]) -> list[list[fmpz]]:
    zero = fmpz(0)
    return [[line.get(j, zero) for j in columns] for line in lines]
