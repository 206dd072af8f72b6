"""Linear dependence of rows, decided exactly, by arithmetic modulo a prime first.

Rows that are independent modulo a prime are independent. The converse holds for all but
finitely many primes, so a dependence seen modulo a prime is checked in integers before it counts,
and another prime is taken if it was an accident.
"""

from collections.abc import Iterator, Sequence
from typing import Final

from flint import arb, fmpq, fmpz, fmpz_mat, nmod_mat

from quasistatic_ref.certify.form import ExactForm

PRIME: Final = (1 << 61) - 1
"""The first prime tried; an unlucky one costs a retry, never a wrong answer."""

SMALL: Final = 1 << 20
"""Coefficients up to this size are guessed from their residues, then checked in integers.

Within a contact of the pyramid they are -1, 0 and 1."""

Row = list[fmpz] | list[int]


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
    pivots, _ = _echelon(form.rows(candidates), PRIME)
    return tuple(candidates[j] for j in pivots)


def tight_rows(
    form: ExactForm, working: Sequence[int], slack: Sequence[arb]
) -> tuple[list[int], list[int]]:
    """Rows outside of the working set whose slack is zero: those that it implies, and the others.

    Parameters
    ----------
    form : ExactForm
    working : sequence of int
        Independent rows.
    slack : sequence of arb, length m
        Exact ones of the minimiser on them [any unit].
    """
    tight = [i for i, s in enumerate(slack) if s.is_zero() and i not in working]
    spans = follow(form.equations(working), form.equations(tight)) if tight else []
    at = dict(zip(tight, spans, strict=True))
    return [i for i in tight if at[i]], [i for i in tight if not at[i]]


def follow(held: Sequence[Row], rows: Sequence[Row]) -> list[bool]:
    """Which equations [a, b] follow from those that are `held`, whose left sides are independent.

    Raises
    ------
    AssertionError
        Never: some prime decides.
    """
    for guess in _guesses(held, rows):
        guessed = [row for row, seen in zip(rows, guess, strict=True) if seen]
        if not guessed or fmpz_mat([*held, *guessed]).rank() == len(held):
            return guess
    raise AssertionError("there are infinitely many primes")


def _guesses(held: Sequence[Row], rows: Sequence[Row]) -> Iterator[list[bool]]:
    """Which of the rows follow modulo a prime, one prime after another."""
    k = len(held)
    for prime in _primes():
        pivots, echelon = _echelon([*held, *rows], prime)
        if pivots[:k] == list(range(k)):
            yield [not any(column[k : len(pivots)]) for column in echelon[k:]]


def combination(form: ExactForm, working: Sequence[int], p: int) -> list[fmpq] | None:
    """How a row of A is combined from the rows of a working set, decided exactly.

    Parameters
    ----------
    form : ExactForm
    working : sequence of int
        Independent rows.
    p : int

    Returns
    -------
    list of fmpq or None
        c with a_p = sum_j c_j A[working[j]]; None if a_p is independent of them.
    """
    k = len(working)
    *held, target = form.rows([*working, p])
    for prime in _primes():
        pivots, echelon = _echelon([*held, target], prime)
        if pivots == list(range(k + 1)):
            return None
        if pivots == list(range(k)):
            break
    residues = echelon[k][:k]
    guess = [c - prime if c > prime // 2 else c for c in residues]
    guessed = [fmpq(c) for c in guess]
    if all(abs(c) < SMALL for c in guess) and _combines(held, guessed, target):
        return guessed
    # Exactly in k coordinates in which the rows are independent, then checked in all.
    chosen, _ = _echelon([list(column) for column in zip(*held, strict=True)], prime)
    square = fmpz_mat([[row[v] for row in held] for v in chosen])
    solution = square.solve(fmpz_mat([[target[v]] for v in chosen]))
    exact = [fmpq(solution[j, 0]) for j in range(k)]
    return exact if _combines(held, exact, target) else None


def _combines(rows: Sequence[Row], c: Sequence[fmpq], target: Row) -> bool:
    used = [(c_j, row) for c_j, row in zip(c, rows, strict=True) if c_j]
    return all(sum((c_j * row[v] for c_j, row in used), fmpq(0)) == a for v, a in enumerate(target))


def _echelon(columns: Sequence[Row], prime: int) -> tuple[list[int], list[list[int]]]:
    """Return the pivots among some columns modulo a prime, and the reduced columns."""
    if not columns or not columns[0]:
        return [], [[] for _ in columns]
    reduced, rank = nmod_mat(fmpz_mat(list(columns)).transpose(), prime).rref()
    table = [[int(x) for x in column] for column in reduced.transpose().tolist()]
    pivots = []
    j = 0
    for i in range(rank):
        while not table[j][i]:
            j += 1
        pivots.append(j)
    return pivots, table


def _primes() -> Iterator[int]:
    candidate = PRIME
    while True:
        if fmpz(candidate).is_prime():
            yield candidate
        candidate -= 2
