"""What a prime proves of independence, against elimination in fractions."""

import random

import pytest
from flint import fmpq_mat, fmpz

from quasistatic_ref.numbers import modulo
from quasistatic_ref.numbers.modulo import (
    PRIME,
    independent_modulo,
    independent_rows,
    supports_modulo,
)


def rank(rows):
    return fmpq_mat(len(rows), len(rows[0]), [v for row in rows for v in row]).rref()[1]


def drawn_rows(rng):
    """Rows of a few short sums of others, and of numbers as large as a step's."""
    width = rng.randint(1, 6)
    most = rng.choice([1, 2, 2**150])
    rows = [[fmpz(rng.randint(-most, most)) for _ in range(width)]]
    for _ in range(rng.randint(0, 7)):
        one, other = rng.choice(rows), rng.choice(rows)
        of_others = [2 * v - w for v, w in zip(one, other, strict=True)]
        new = [fmpz(rng.randint(-most, most)) for _ in range(width)]
        rows.append(rng.choice([new, new, of_others]))
    return rows


def test_rows_are_independent_and_supports_are_those_of_fractions():
    rng = random.Random(0)
    for _ in range(300):
        rows = drawn_rows(rng)
        chosen = independent_modulo(rows, PRIME)
        before = [rank([[fmpz(0)] * len(rows[0]), *rows[:k]]) for k in range(len(rows) + 1)]
        assert chosen == [k for k in range(len(rows)) if before[k + 1] > before[k]]
        held = [rows[k] for k in chosen]
        for row, support in zip(rows, supports_modulo(held, rows), strict=True):
            assert rank([*[held[j] for j in support], row]) == rank([row]) * len(support)
        if len(held) < len(rows):
            assert supports_modulo(rows, rows) is None


@pytest.mark.parametrize("prime", [PRIME, 2, 3, 5, 7])
def test_what_depends_is_proved_to_whatever_prime_is_asked_first(prime, monkeypatch):
    """Small primes divide minors of most rows here, and the last rows have a minor of PRIME."""
    monkeypatch.setattr(modulo, "PRIME", prime)
    rng = random.Random(prime)
    drawn = [drawn_rows(rng) for _ in range(200)]
    of_minor = [[[fmpz(PRIME)]], [[fmpz(2**31), fmpz(1)], [fmpz(1), fmpz(2**30)]]]
    for rows in drawn + of_minor:
        before = [rank([[fmpz(0)] * len(rows[0]), *rows[:k]]) for k in range(len(rows) + 1)]
        assert independent_rows(rows) == [k for k in range(len(rows)) if before[k + 1] > before[k]]


def test_a_row_that_the_prime_shows_to_be_independent_has_no_support():
    held = [[fmpz(1), fmpz(2), fmpz(0)], [fmpz(0), fmpz(1), fmpz(0)]]
    assert supports_modulo(held, [[fmpz(0), fmpz(0), fmpz(1)], [fmpz(3), fmpz(1), fmpz(0)]]) == [
        None,
        [0, 1],
    ]
    assert supports_modulo(held, [[fmpz(0), fmpz(0), fmpz(PRIME)]]) == [[]]  # a guess, and wrong
    assert supports_modulo([[fmpz(PRIME)]], [[fmpz(1)]]) is None
