"""Linear dependence is decided exactly, however unlucky the prime is."""

import numpy as np
import pytest
from flint import fmpq

from quasistatic_ref.certify import dependence
from quasistatic_ref.certify.dependence import SMALL, combination, follow, independent_rows
from quasistatic_ref.lab.vectors.exact.forms import exact_form_of

UNLUCKY = 101


def rows(*A, b=None):
    """A form whose rows are integers."""
    A = np.array(A, dtype=float)
    right = np.zeros(len(A)) if b is None else np.array(b, dtype=float)
    form = exact_form_of(np.eye(A.shape[1]), np.zeros(A.shape[1]), A, right)
    assert [[float(a) for a in row] for row in form.A.tolist()] == A.tolist()
    return form


@pytest.fixture(params=[dependence.PRIME, UNLUCKY])
def prime(request, monkeypatch):
    """The usual first prime, and one that these rows are unlucky with."""
    monkeypatch.setattr(dependence, "PRIME", request.param)


@pytest.mark.usefixtures("prime")
def test_sets_dependent_modulo_the_prime_alone_are_independent():
    """(2, 101) = 2 (1, 0) + 101 (0, 1)."""
    form = rows([1, 0], [1, UNLUCKY], [2, UNLUCKY], [0, 1])
    assert combination(form, [0, 1], 2) == [1, 1]
    assert combination(form, [0, 1], 3) == [fmpq(-1, UNLUCKY), fmpq(1, UNLUCKY)]
    assert follow(form.equations([0, 1]), form.equations([2, 3])) == [True, True]
    assert follow(form.equations([0]), form.equations([1])) == [False]


@pytest.mark.usefixtures("prime")
def test_combinations_may_be_large_or_fractions():
    form = rows([3, 0, 0], [0, 7, 0], [5, 1, 0], [3 << 30, -7, 0], [3 << 20, 7, 0], [0, 0, 1])
    assert combination(form, [0, 1], 2) == [fmpq(5, 3), fmpq(1, 7)]
    assert combination(form, [0, 1], 3) == [1 << 30, -1]
    assert combination(form, [1, 0], 4) == [1, 1 << 20]
    assert combination(form, [0, 1], 5) is None
    assert combination(form, [], 0) is None


@pytest.mark.usefixtures("prime")
def test_equations_are_implied_only_with_their_right_side():
    """With x = 1 and y = 2 comes x + y = 3, but neither x + y = 4 nor anything about z."""
    form = rows(
        [1, 0, 0], [0, 1, 0], [1, 1, 0], [1, 1, 0], [1, 1, 1], [0, 0, 1], b=[1, 2, 3, 4, 3, 0]
    )
    held = form.equations([0, 1])
    others = form.equations([2, 3, 4, 5, 0])
    assert follow(held, others) == [True, False, False, False, True]
    assert follow(held, others[1:4]) == [False, False, False]
    assert follow(held, []) == []
    assert follow([], others[:1]) == [False]


def test_independent_rows_are_the_first_of_those_that_depend():
    form = rows([0, 0], [2, 0], [1, 0], [1, 1], [0, 1])
    assert independent_rows(form, range(5)) == (1, 3)
    assert independent_rows(form, [4, 3, 2, 1, 0]) == (4, 3)
    assert independent_rows(form, [2, 2, 4]) == (2, 4)
    assert independent_rows(form, []) == ()


def test_zero_row_is_the_empty_combination():
    form = rows([0, 0], [1, 0])
    assert combination(form, [], 0) == []
    assert combination(form, [1], 0) == [0]


@pytest.mark.parametrize(
    ("c", "eliminations"),
    [((1, -1), 1), ((0, 1 - SMALL), 1), ((SMALL, 0), 2), ((-SMALL, 1), 2)],
)
def test_small_coefficients_are_read_from_their_residues(monkeypatch, c, eliminations):
    """One elimination modulo the prime shows them; others take a second one, and fractions."""
    calls = []
    echelon = dependence._echelon
    monkeypatch.setattr(dependence, "_echelon", lambda *a: calls.append(a) or echelon(*a))
    assert combination(rows([3, 0], [0, 7], [3 * c[0], 7 * c[1]]), [0, 1], 2) == list(c)
    assert len(calls) == eliminations
