"""Linear dependence is decided exactly."""

import numpy as np

from quasistatic_ref.certify.dependence import (
    implied,
    independent_rows,
)
from quasistatic_ref.lab.vectors.exact.forms import exact_form_of


def rows(*A, b=None):
    """A form whose rows are integers."""
    A = np.array(A, dtype=float)
    right = np.zeros(len(A)) if b is None else np.array(b, dtype=float)
    form = exact_form_of(np.eye(A.shape[1]), np.zeros(A.shape[1]), A, right)
    assert [[float(a) for a in row] for row in form.A.tolist()] == A.tolist()
    return form


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
