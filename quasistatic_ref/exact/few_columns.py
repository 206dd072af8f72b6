"""A null space that lives on few columns: of rows under which most coordinates rest.

Let k independent rows be given, and let S be some columns. If the other columns M have rank
k - |S|, then, as all have rank k, those of S are independent, and no sum of them but zero is one of
those of M. So each z with row z = 0 for each row vanishes on S: M alone has its null space.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import compress
from typing import Final, NamedTuple

from flint import fmpz, fmpz_mat, nmod_mat

from quasistatic_ref.numbers.modulo import PRIME

MOST: Final = 24
"""Dimensions of a null space above which products with it cost more than they spare."""
SHARE: Final = 1.5
"""Columns over those of M, at least: else elimination costs what it spares [-]."""


class FewColumns(NamedTuple):
    """All z with row z = 0 for each of some rows.

    Parameters
    ----------
    columns : list of int
        M, where some z is not zero.
    basis : fmpz_mat
        The z there, shape (columns, d).
    """

    columns: list[int]
    basis: fmpz_mat

    def vanish(self, rows: Sequence[Sequence[fmpz]]) -> list[bool]:
        """Which further rows vanish on all z: those that are sums of the rows."""
        some = [row[j] for row in rows for j in self.columns]
        values = fmpz_mat(len(rows), len(self.columns), some) * self.basis
        return [not any(value) for value in values.tolist()]


def few_columns(rows: Sequence[Sequence[fmpz]], size: int) -> FewColumns | None:
    """The null space of independent rows; None where a prime does not show that it is on few.

    Parameters
    ----------
    rows : sequence of list of fmpz
        k of them.
    size : int
        Of a row.
    """
    k, d = len(rows), size - len(rows)
    if d > MOST:
        return None
    whole = fmpz_mat(k, size, [v for row in rows for v in row])
    modulo, of_prime = nmod_mat(whole, PRIME).nullspace()
    if of_prime != d:
        return None
    moves = [any(int(v) for v in row[:d]) for row in modulo.tolist()]
    columns = [*compress(range(size), moves)]
    if SHARE * len(columns) > size:
        return None
    some = fmpz_mat(k, len(columns), [row[j] for row in rows for j in columns])
    basis, nullity = some.nullspace()
    rank = len(columns) - nullity
    if rank != k - (size - len(columns)):
        return None
    entries = [v for row in basis.tolist() for v in row[:nullity]]
    return FewColumns(columns, fmpz_mat(len(columns), nullity, entries))
