"""Linear dependence of rows, decided by elimination in whole numbers."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

from flint import fmpq, fmpz, fmpz_mat

Row = Sequence[fmpz]


class ExactRows(Protocol):
    """Rows without rounding, such as those of an exact form."""

    def integers(self, some: Sequence[int]) -> Sequence[Row]:
        """Some rows [a, c] of the form, all multiplied by one power of two, as integers."""


def implied(held: Sequence[Row], rows: Sequence[Row]) -> list[bool]:
    """Which rows are combinations of those that are `held`, which are independent."""
    columns, _, rank = _eliminated([*held, *rows])
    k = len(held)
    return [not any(column[k:rank]) for column in columns[k:]]


def null_space(rows: Sequence[Row], size: int) -> fmpz_mat:
    """A basis of all z with row z = 0 for each row, as columns, shape (size, d).

    Whatever the rows imply holds for it: a row is a combination of them if and only if it vanishes
    on the basis.

    Parameters
    ----------
    rows : sequence of list of fmpz
    size : int
        Of a row.
    """
    matrix = fmpz_mat(len(rows), size, [v for row in rows for v in row])
    basis, d = matrix.nullspace()
    return fmpz_mat(size, d, [v for row in basis.tolist() for v in row[:d]])


def independent_rows(form: ExactRows, candidates: Sequence[int]) -> tuple[int, ...]:
    """The rows of A, in order of preference, that do not depend on earlier ones."""
    columns, _, rank = _eliminated([row[:-1] for row in form.integers(candidates)])
    chosen: list[int] = []
    for i, column in zip(candidates, columns, strict=True):
        if len(chosen) < rank and column[len(chosen)]:
            chosen.append(i)
    return tuple(chosen)


def combination(form: ExactRows, working: Sequence[int], p: int) -> list[fmpq] | None:
    """The c of a_p = sum_j c_j A[working[j]]; None if a_p is independent of these rows.

    Parameters
    ----------
    form : ExactRows
    working : sequence of int
        Independent rows.
    p : int
    """
    columns, denominator, rank = _eliminated([row[:-1] for row in form.integers([*working, p])])
    if rank > len(working):
        return None
    return [fmpq(v, denominator) for v in columns[-1][:rank]]


def _eliminated(rows: Sequence[Row]) -> tuple[list[list[fmpz]], fmpz, int]:
    """Rows as columns of a matrix in reduced echelon form, times a denominator; and its rank."""
    if not (rows and rows[0]):
        return [[] for _ in rows], fmpz(1), 0
    matrix = fmpz_mat(len(rows), len(rows[0]), [v for row in rows for v in row])
    reduced, denominator, rank = matrix.transpose().rref()
    return reduced.transpose().tolist(), denominator, rank
