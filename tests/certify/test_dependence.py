"""Linear dependence is decided exactly."""

import numpy as np

from quasistatic_ref.exact.program import independent_rows
from tests.oracles.forms import exact_form_of


def test_independent_rows_are_the_first_of_those_that_depend():
    A = np.array([[0.0, 0], [2, 0], [1, 0], [1, 1], [0, 1]])
    form = exact_form_of(np.eye(2), np.zeros(2), A, np.zeros(5))
    assert independent_rows(form, range(5)) == (1, 3)
    assert independent_rows(form, [4, 3, 2, 1, 0]) == (4, 3)
    assert independent_rows(form, [2, 2, 4]) == (2, 4)
    assert independent_rows(form, []) == ()
