"""Whether a matrix of integers is positive definite, against Sylvester's criterion."""

from itertools import permutations
from math import prod

import numpy as np
import pytest
from flint import fmpz_mat

from quasistatic_ref.certify import point


def determinant(H):
    """The sum over permutations of their signs times products of entries (Leibniz)."""
    n = len(H)
    return sum(
        prod(H[i][p[i]] for i in range(n))
        * (-1) ** sum(p[i] > p[j] for i in range(n) for j in range(i + 1, n))
        for p in permutations(range(n))
    )


def by_minors(H):
    """Every leading principal minor is positive."""
    return all(determinant([row[:k] for row in H[:k]]) > 0 for k in range(1, len(H) + 1))


def symmetric(rng, n, least, most):
    """Integers, shifted by a multiple of the identity, so that either answer is met."""
    half = np.tril(rng.integers(least, most, (n, n)))
    return (half + np.tril(half, -1).T + rng.integers(0, 12) * np.eye(n, dtype=int)).tolist()


def test_definiteness_is_what_the_leading_minors_say():
    rng = np.random.default_rng(0)
    said = []
    for _ in range(300):
        H = symmetric(rng, int(rng.integers(1, 5)), -4, 5)
        said.append(point.positive_definite(fmpz_mat(H)))
        assert said[-1] == by_minors(H)
    assert {True, False} == set(said)


@pytest.mark.parametrize(
    ("H", "definite"),
    [
        ([[-3]], False),
        ([[0]], False),
        ([[4, 2], [2, 1]], False),  # singular: 4 - 4
        ([[4, 2], [2, 2]], True),
        ([[1, 2], [2, 1]], False),  # 1 - 4
        # The second pivot is 1, -1 or 0: the precision of balls is less than 400 bits.
        ([[1 << 400, 1 << 400], [1 << 400, (1 << 400) + 1]], True),
        ([[1 << 400, 1 << 400], [1 << 400, (1 << 400) - 1]], False),
        ([[1 << 400, 1 << 400], [1 << 400, 1 << 400]], False),
    ],
)
def test_pivots_that_balls_leave_open_are_decided_by_minors(H, definite):
    assert point.positive_definite(fmpz_mat(H)) == definite
