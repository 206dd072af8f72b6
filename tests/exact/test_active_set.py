"""The walk: which row enters, which leaves, exact ties included, and that it ends."""

import numpy as np
import pytest

from quasistatic_ref.exact.active_set import dual_active_set, least_index, most_violated
from quasistatic_ref.exact.minimiser import Minimiser
from tests.oracles.forms import exact_form_of


def program(A, b, g=None):
    """Nearest x to g with A x >= b."""
    A = np.array(A, dtype=float)
    n = A.shape[1]
    return exact_form_of(np.eye(n), np.zeros(n) if g is None else g, A, np.array(b, dtype=float))


def lifted_corner(seed):
    """A start at a corner, x_i >= 1, that sums of its rows lift: x = (10, 10, 10, 10, 0).

    All multipliers at the corner are one, so all leave at once when the sum of four rows comes
    in. Every row is there twice; the sums of two are without slack at the end and depend on it.
    """
    rng = np.random.default_rng(seed)
    each = np.eye(5)[:4]
    pairs = [each[i] + each[j] for i in range(4) for j in range(i)]
    rows = np.vstack([each, each, [each.sum(axis=0)] * 2, pairs, pairs])
    b = np.array([1] * 8 + [40] * 2 + [20] * 12)
    order = rng.permutation(len(b))
    start = rng.permutation(np.flatnonzero(order < 8)).tolist()
    return program(rows[order], b[order]), start


@pytest.mark.parametrize("seed", range(8))
def test_exactly_tied_duplicated_and_dependent_rows_end(seed):
    form, warm = lifted_corner(seed)
    end = dual_active_set(form, warm)
    assert isinstance(end, Minimiser)
    assert end.fractions.exact_x == [10, 10, 10, 10, 0]
    assert 0 < end.iterations <= form.m


def test_a_row_that_balls_show_to_be_violated_enters_before_any_zero_is_decided():
    """x_0 >= 1 is held; 2 x_0 >= 2 follows from it, and (1 - 2^-53) x_0 >= 1 misses by 2^-53."""
    minimiser = Minimiser(program([[1, 0], [2, 0], [1 - 2.0**-53, 0]], [1, 2, 1]), (0,))
    assert minimiser.open_rows == [1, 2]
    assert not minimiser.perhaps_most_violated
    assert most_violated(minimiser) == least_index(minimiser) == 2
    fresh = minimiser.on((0,))
    assert most_violated(fresh) == 2
    assert "null_space" not in vars(fresh)


@pytest.mark.parametrize("t", [2.0**-60, 2.0**-900])
def test_of_rows_that_float64_does_not_show_the_most_violated_enters(t):
    """At x = (1, -t) the row x_0 + c x_1 >= 1 misses by c t; balls show the larger t alone."""
    rows = [[1, 0], [1, 1], [1, 3], [1, 2], [1, 3]]
    minimiser = Minimiser(program(rows, np.ones(5), np.array([0.0, -t])), (0,))
    assert not minimiser.perhaps_most_violated
    assert any(ball < 0 for ball in minimiser.slack_balls.values()) == (t > 2.0**-300)
    assert least_index(minimiser) == 1
    assert most_violated(minimiser) == 2
