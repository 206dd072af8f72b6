"""Independence of rows of whole numbers, proved modulo one prime.

A minor that is not zero modulo a prime is not zero. So rows that are independent modulo a prime are
independent, and where some of them are, one that is no sum of these modulo the prime is none. What
depends modulo the prime is a guess, which elimination in whole numbers proves for few rows.
"""

from collections.abc import Iterator, Sequence
from itertools import count
from typing import Final

from flint import fmpz, fmpz_mat, nmod, nmod_mat

PRIME: Final = 2**61 - 1


def primes() -> Iterator[int]:
    """``PRIME`` and ever smaller primes: what one divides by chance, the next does not."""
    return (p for p in count(PRIME, -2) if fmpz(p).is_prime())


def independent_modulo(rows: Sequence[Sequence[fmpz]], prime: int = PRIME) -> list[int]:
    """Places of rows that are independent, each the first that is so of those before it [-].

    Parameters
    ----------
    rows : sequence of list of fmpz
        Of one length.
    prime : int
    """
    columns, rank = _eliminated(rows, prime)
    chosen: list[int] = []
    for place, column in enumerate(columns):
        if len(chosen) < rank and column[len(chosen)]:
            chosen.append(place)
    return chosen


def supports_modulo(
    held: Sequence[Sequence[fmpz]], rows: Sequence[Sequence[fmpz]]
) -> list[list[int] | None] | None:
    """For each row, places of those `held` whose sum it is modulo the prime.

    Parameters
    ----------
    held, rows : sequence of list of fmpz
        Of one length.

    Returns
    -------
    list of (list of int or None), or None
        None of a row that is independent of those held, which is proved. None in place of all if
        those held are not shown to be independent.
    """
    k = len(held)
    columns, rank = _eliminated([*held, *rows])
    if rank < k or not all(column[j] for j, column in enumerate(columns[:k])):
        return None
    return [
        None if any(column[k:rank]) else [j for j, v in enumerate(column[:k]) if v]
        for column in columns[k:]
    ]


def _eliminated(rows: Sequence[Sequence[fmpz]], prime: int = PRIME) -> tuple[list[list[nmod]], int]:
    """Rows as columns of a matrix in reduced echelon form modulo a prime, and its rank."""
    if not (rows and rows[0]):
        return [[] for _ in rows], 0
    whole = fmpz_mat(len(rows), len(rows[0]), [v for row in rows for v in row])
    reduced, rank = nmod_mat(whole.transpose(), prime).rref()
    return reduced.transpose().tolist(), rank
