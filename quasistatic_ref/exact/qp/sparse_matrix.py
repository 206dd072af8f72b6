"""A matrix of float64 by the entries of its rows that are not zero."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from quasistatic_ref.numbers.arrays import Array, Indices


@dataclass(frozen=True, eq=False)
class SparseMatrix:
    """The entries of m rows one after another, each row's in the order of its columns.

    Parameters
    ----------
    start : ndarray of int, shape (m + 1,)
        Where the entries of each row begin, and where the last ones end.
    column : ndarray of int, shape (k,)
    value : ndarray, shape (k,)
        [Any unit.]
    n : int
        Number of columns.
    """

    start: Indices
    column: Indices
    value: Array
    n: int

    @classmethod
    def of(
        cls, row: Indices, column: Indices, value: Array, shape: tuple[int, ...]
    ) -> SparseMatrix:
        """A matrix of `shape` (m, n) from entries, in the order of their rows and columns.

        `row`, `column` and `value` [any unit] are of shape (k,).
        """
        m, n = shape
        return cls(np.searchsorted(row, np.arange(m + 1)), column, value + 0.0, n)

    @classmethod
    def of_dense(cls, matrix: Array, factor: float = 1.0) -> SparseMatrix:
        """The entries of `matrix`, shape (m, n) [any unit], each times a `factor` [-]."""
        row, column = np.nonzero(matrix)
        return cls.of(row, column, factor * matrix[row, column], matrix.shape)

    @property
    def counts(self) -> Indices:
        """How many entries each row has, (m,)."""
        return np.diff(self.start)

    @property
    def row(self) -> Indices:
        """The row of each entry, (k,)."""
        return np.repeat(np.arange(len(self.start) - 1), self.counts)

    def entries(self, i: int) -> tuple[Indices, Array]:
        """Columns and values of row i, (k,) each."""
        of_row = slice(self.start[i], self.start[i + 1])
        return self.column[of_row], self.value[of_row]

    def some(self, rows: Indices, columns: Indices) -> SparseMatrix:
        """The matrix of some `rows`, (m',), and `columns` in increasing order, (n',)."""
        counts = self.counts[rows]
        ends = np.cumsum(counts)
        at = np.repeat(self.start[rows] - (ends - counts), counts) + np.arange(counts.sum())
        place = np.full(self.n, -1)
        place[columns] = np.arange(len(columns))
        column = place[self.column[at]]
        stays = column >= 0
        row = np.repeat(np.arange(len(rows)), counts)[stays]
        shape = len(rows), len(columns)
        return SparseMatrix.of(row, column[stays], self.value[at][stays], shape)

    def dense(self) -> Array:
        """The array, zeros included, shape (m, n)."""
        whole = np.zeros((len(self.start) - 1, self.n))
        whole[self.row, self.column] = self.value
        return whole

    def sums(self, x: Array) -> Array:
        """The product with `x`, shape (n,) [any unit]: shape (m,)."""
        products = self.value * x[self.column]
        return np.bincount(self.row, products, len(self.start) - 1).astype(np.float64)


def stacked(parts: Sequence[SparseMatrix]) -> SparseMatrix:
    """The rows of matrices of as many columns, one after another."""
    counts = np.concatenate([part.counts for part in parts])
    start = np.concatenate([[0], np.cumsum(counts)])
    column = np.concatenate([part.column for part in parts])
    return SparseMatrix(start, column, np.concatenate([p.value for p in parts]), parts[0].n)
