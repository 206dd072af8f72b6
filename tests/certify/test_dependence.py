"""Linear dependence is decided exactly."""

import numpy as np
from flint import fmpq, fmpz_mat

from quasistatic_ref.certify.dependence import (
    combination,
    implied,
    independent_rows,
    null_space,
)
from quasistatic_ref.lab.vectors.exact.forms import exact_form_of

LARGE = (1 << 61) - 1
"""A prime, modulo which the rows of a test depend on each other."""


def rows(*A, b=None):
    """A form whose rows are integers."""
    A = np.array(A, dtype=float)
    right = np.zeros(len(A)) if b is None else np.array(b, dtype=float)
    form = exact_form_of(np.eye(A.shape[1]), np.zeros(A.shape[1]), A, right)
    assert [[float(a) for a in row] for row in form.A.tolist()] == A.tolist()
    return form


def test_sets_dependent_modulo_a_prime_alone_are_independent():
    """The power of two next to it is a float64; the prime is its difference from one."""
    form = rows([1, 0], [1 << 61, 1], [1, 1], [0, 1])
    assert combination(form, [0, 2], 1) == [fmpq(LARGE), fmpq(1)]
    assert combination(form, [1, 2], 0) == [fmpq(1, LARGE), fmpq(-1, LARGE)]
    assert implied(form.integers([1, 2]), form.integers([0, 3])) == [True, True]
    assert implied(form.integers([2]), form.integers([1])) == [False]
    assert independent_rows(form, [1, 2]) == (1, 2)


def test_equations_are_implied_only_with_their_right_side():
    """With x = 1 and y = 2 comes x + y = 3, but neither x + y = 4 nor anything about z."""
    form = rows(
        [1, 0, 0], [0, 1, 0], [1, 1, 0], [1, 1, 0], [1, 1, 1], [0, 0, 1], b=[1, 2, 3, 4, 3, 0]
    )
    held = form.integers([0, 1])
    others = form.integers([2, 3, 4, 5, 0])
    assert implied(held, others) == [True, False, False, False, True]
    assert implied(held, others[1:4]) == [False, False, False]
    assert implied(held, []) == []
    assert implied([], others[:1]) == [False]


def test_independent_rows_are_the_first_of_those_that_depend():
    form = rows([0, 0], [2, 0], [1, 0], [1, 1], [0, 1])
    assert independent_rows(form, range(5)) == (1, 3)
    assert independent_rows(form, [4, 3, 2, 1, 0]) == (4, 3)
    assert independent_rows(form, [2, 2, 4]) == (2, 4)
    assert independent_rows(form, []) == ()


def test_what_vanishes_on_the_null_space_of_rows_is_what_they_imply():
    """With x = 1 and y = 2: [x; y; z; 1] has two directions left, z and the scale."""
    form = rows([1, 0, 0], [0, 1, 0], [1, 1, 0], [1, 1, 0], [0, 0, 1], b=[1, 2, 3, 4, 0])
    basis = null_space(form.integers([0, 1]), 4)
    assert (basis.nrows(), basis.ncols(), basis.rank()) == (4, 2, 2)
    values = (fmpz_mat(form.integers(range(5))) * basis).tolist()
    assert [not any(row) for row in values] == [True, True, True, False, False]
    assert null_space([], 4).rank() == 4
