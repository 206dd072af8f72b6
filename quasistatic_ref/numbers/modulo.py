"""Independence of rows of whole numbers, proved modulo primes.

A minor that is not zero modulo a prime is not zero. So rows that are independent modulo a prime are
independent, and where some of them are, one that is no sum of these modulo the prime is none. What
depends modulo a prime is a guess: a relation in whole numbers proves it, or another prime decides.
"""

from collections.abc import Iterator, Mapping, Sequence
from itertools import count
from typing import Final, cast

from flint import fmpq_mat, fmpz, fmpz_mat, nmod, nmod_mat

LARGEST: Final = 2**61 - 1
PRIME = LARGEST
"""The prime that is asked first."""


def primes() -> Iterator[int]:
    """``PRIME`` and then others: what one divides by chance, the next does not."""
    yield PRIME
    yield from (p for p in count(LARGEST, -2) if p != PRIME and fmpz(p).is_prime())


def independent_rows(rows: Sequence[Sequence[fmpz]]) -> list[int]:
    """Places of rows that are independent, each the first that is so of those before it [-].

    Each other row is proved to be a sum of these.

    Parameters
    ----------
    rows : sequence of list of fmpz
        Of one length.
    """
    some = primes()
    while True:  # finitely many primes divide a minor
        p = next(some)
        columns, rank = _eliminated(rows, p)
        chosen = _first_places(columns, rank)
        sums = {
            place: {chosen[k]: v for k, v in enumerate(column[: len(chosen)]) if v}
            for place, column in enumerate(columns)
            if place not in {*chosen}
        }
        if all(_is_sum(rows, place, of, p) for place, of in sums.items()):
            return chosen


def _is_sum(rows: Sequence[Sequence[fmpz]], place: int, of: Mapping[int, nmod], prime: int) -> bool:
    """Whether a row is the sum of some independent ones that a prime says it is.

    The factors are the fractions of small numbers that are these modulo the prime, or, where they
    do not give the row, the only ones that may.
    """
    row = rows[place]
    if not of:
        return not any(row)
    pairs = [_fraction(int(v), prime) for v in of.values()]
    if all(pairs) and _gives(row, [rows[i] for i in of], [p for p in pairs if p]):
        return True
    held = [rows[i] for i in of]
    columns = independent_modulo([*map(list, zip(*held, strict=True))], prime)
    square = fmpz_mat([[line[t] for line in held] for t in columns])
    right = fmpz_mat(len(columns), 1, [row[t] for t in columns])
    numerators, denominator = cast("fmpq_mat", square.solve(right)).numer_denom()
    return _gives(row, held, [(v, denominator) for v in numerators.entries()])


def _gives(
    row: Sequence[fmpz], held: Sequence[Sequence[fmpz]], pairs: Sequence[tuple[fmpz, fmpz]]
) -> bool:
    """Whether a row is the sum of others, each times the fraction of a pair."""
    common = fmpz(1)
    for _, denominator in pairs:
        common = common.lcm(denominator)
    factors = [v * (common / w) for v, w in pairs]
    total = fmpz_mat(1, len(factors), factors) * fmpz_mat([[*line] for line in held])
    return bool(total == common * fmpz_mat([[*row]]))


def _fraction(v: int, prime: int) -> tuple[fmpz, fmpz] | None:
    """The fraction of numbers below the root of half a prime that is v modulo it, or None."""
    u, w, s, t = prime, v, 0, 1
    while 2 * w * w > prime:
        k = u // w
        u, w = w, u - k * w
        s, t = t, s - k * t
    if 2 * t * t > prime:
        return None
    return (fmpz(w), fmpz(t)) if t > 0 else (fmpz(-w), fmpz(-t))


def independent_modulo(rows: Sequence[Sequence[fmpz]], prime: int) -> list[int]:
    """Places of rows that are independent modulo a prime, each the first of those before it [-].

    Parameters
    ----------
    rows : sequence of list of fmpz
        Of one length.
    prime : int
    """
    return _first_places(*_eliminated(rows, prime))


def _first_places(columns: Sequence[Sequence[nmod]], rank: int) -> list[int]:
    """Places of the columns with pivots in a reduced echelon form."""
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
    columns, rank = _eliminated([*held, *rows], PRIME)
    if rank < k or not all(column[j] for j, column in enumerate(columns[:k])):
        return None
    return [
        None if any(column[k:rank]) else [j for j, v in enumerate(column[:k]) if v]
        for column in columns[k:]
    ]


def _eliminated(rows: Sequence[Sequence[fmpz]], prime: int) -> tuple[list[list[nmod]], int]:
    """Rows as columns of a matrix in reduced echelon form modulo a prime, and its rank."""
    if not (rows and rows[0]):
        return [[] for _ in rows], 0
    whole = fmpz_mat(len(rows), len(rows[0]), [v for row in rows for v in row])
    reduced, rank = nmod_mat(whole.transpose(), prime).rref()
    return reduced.transpose().tolist(), rank
