"""Linear dependence of rows, decided exactly, by arithmetic modulo a prime first.

Rows that are independent modulo a prime are independent. The converse holds for all but
finitely many primes, so a dependence seen modulo a prime is checked in integers before it counts.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Final

from flint import fmpq, fmpz, fmpz_mat, nmod_mat

from quasistatic_ref.certify.rational import ExactForm

PRIME: Final = (1 << 61) - 1
"""The first prime tried; an unlucky one costs a retry, never a wrong answer."""

SMALL: Final = 1 << 20
"""Coefficients up to this size are guessed from their residues, then checked in integers."""


def independent_rows(form: ExactForm, candidates: Sequence[int]) -> tuple[int, ...]:
    """An independent subset of some rows of A, maximal but for an unlucky prime.

    Parameters
    ----------
    form : ExactForm
    candidates : sequence of int
        Rows in order of preference: each is kept unless those before it span it.

    Returns
    -------
    tuple of int
    """
    if not candidates:
        return ()
    echelon, rank = _columns(form, candidates, PRIME).rref()
    return tuple(candidates[j] for j in _pivots(echelon, rank))


def combinations(
    form: ExactForm, working: Sequence[int], rows: Sequence[int]
) -> list[list[fmpq] | None]:
    """How each of some rows of A is combined from the working set, decided exactly.

    Parameters
    ----------
    form : ExactForm
    working : sequence of int
        Independent rows.
    rows : sequence of int
        The rows asked about.

    Returns
    -------
    list
        For each row a the coefficients c with a = sum_j c_j A[working[j]], or None if it is
        independent of the working set.
    """
    k, n = len(working), form.n
    found: list[list[fmpq] | None] = [None] * len(rows)
    for prime in _primes():
        echelon, rank = _columns(form, [*working, *rows], prime).rref()
        if _pivots(echelon, rank)[:k] == list(range(k)):
            break
    spanned = [
        j for j in range(len(rows)) if not any(int(echelon[i, k + j]) for i in range(k, rank))
    ]
    for j in spanned:
        residues = [int(echelon[i, k + j]) for i in range(k)]
        guess = [c - prime if c > prime // 2 else c for c in residues]
        target = [form.A[rows[j], v] for v in range(n)]
        if all(abs(c) < SMALL for c in guess) and _combines(form, working, guess, target):
            found[j] = [fmpq(c) for c in guess]
        else:
            found[j] = _solved(form, working, target, prime)
    return found


def _columns(form: ExactForm, rows: Sequence[int], prime: int) -> nmod_mat:
    """Return the given rows of A as the columns of a matrix modulo a prime."""
    n = form.n
    entries = [form.A[i, v] for i in rows for v in range(n)]
    return nmod_mat(fmpz_mat(len(rows), n, entries), prime).transpose()


def _pivots(echelon: nmod_mat, rank: int) -> list[int]:
    pivots, j = [], 0
    for i in range(rank):
        while not int(echelon[i, j]):
            j += 1
        pivots.append(j)
    return pivots


def _primes() -> Iterator[int]:
    candidate = PRIME
    while True:
        if fmpz(candidate).is_prime():
            yield candidate
        candidate -= 2


def _combines(
    form: ExactForm, working: Sequence[int], c: Sequence[int], target: Sequence[fmpz]
) -> bool:
    nonzero = [(i, c_i) for i, c_i in zip(working, c, strict=True) if c_i]
    return all(
        sum((form.A[i, v] * c_i for i, c_i in nonzero), fmpz(0)) == target[v]
        for v in range(form.n)
    )


def _solved(
    form: ExactForm, working: Sequence[int], target: Sequence[fmpz], prime: int
) -> list[fmpq] | None:
    """Return the coefficients by an exact solve in k independent coordinates, checked in all."""
    k = len(working)
    by_coordinate = nmod_mat(
        fmpz_mat(k, form.n, [form.A[i, v] for i in working for v in range(form.n)]), prime
    )
    echelon, rank = by_coordinate.rref()
    chosen = _pivots(echelon, rank)
    square = fmpz_mat(k, k, [form.A[i, v] for v in chosen for i in working])
    c = square.solve(fmpz_mat(k, 1, [target[v] for v in chosen]))
    coefficients = [fmpq(c[i, 0]) for i in range(k)]
    for v in range(form.n):
        combined = sum(
            (form.A[i, v] * c_i for i, c_i in zip(working, coefficients, strict=True)), fmpq(0)
        )
        if combined != target[v]:
            return None
    return coefficients
