"""The walk: which row enters, which leaves, exact ties included, and that it ends."""

import numpy as np
import pytest

from quasistatic_ref import standard_form
from quasistatic_ref.certify.active_set import (
    BLOCK,
    basic_rows,
    dual_active_set,
    least_index,
    most_violated,
    warm_rows,
)
from quasistatic_ref.certify.minimiser import Minimiser
from tests.helpers import resting_point
from tests.oracles.forms import exact_form_of
from tests.tolerances import ROUNDING


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
    assert 0 < end.walks <= form.m


def test_a_row_that_balls_show_to_be_violated_enters_before_any_zero_is_decided():
    """x_0 >= 1 is held; 2 x_0 >= 2 follows from it, and (1 - 2^-53) x_0 >= 1 misses by 2^-53."""
    minimiser = Minimiser(program([[1, 0], [2, 0], [1 - 2.0**-53, 0]], [1, 2, 1]), (0,))
    assert minimiser.open_rows == [1, 2]
    assert not minimiser.lowest_shown
    assert most_violated(minimiser) == least_index(minimiser) == 2
    fresh = minimiser.on((0,))
    assert most_violated(fresh) == 2
    assert "null_space" not in vars(fresh)


def test_open_rows_are_left_out_and_the_most_pressed_comes_first():
    lam = np.array([1e-9, 2.0, 1.0, 1e-12])
    slack = np.array([1.0, 1e-9, 1e-12, 3.0])
    assert warm_rows(np.eye(4), lam, slack) == [1, 2]
    assert basic_rows(np.array([0.0, 1.0, 1.0, 3.0, -2.0])) == [3, 1, 2]
    for m in (0, 3):  # a row without coefficients depends on none
        assert warm_rows(np.zeros((m, 4)), np.ones(m), np.zeros(m)) == []


RNG = np.random.default_rng(0)
DRAWN = [RNG.integers(-2, 3, (m, 3)) for m in (1, 2, 3, 5, 8) * 3]
SCALED = [2.0**20 * DRAWN[-1], 2.0**-20 * DRAWN[-1]]
OPPOSITE = np.array([[3.0, -1.0], [-3.0, 1.0]])


@pytest.mark.parametrize(
    "A", [standard_form(resting_point()).A, *DRAWN, *SCALED, OPPOSITE, -OPPOSITE]
)
def test_independent_rows_are_kept_that_carry_the_same_impulse(A):
    """Of the six rows of a sticking contact at most four, of whole numbers at most three."""
    pressed = np.sqrt(np.arange(2.0, len(A) + 2))
    rows = warm_rows(A, pressed, np.zeros(len(A)))
    assert np.linalg.matrix_rank(A[rows]) == len(rows)
    lam = np.linalg.lstsq(A[rows].T, A.T @ pressed)[0]
    assert (lam > 0).all()
    off = A[rows].T @ lam - A.T @ pressed
    assert np.abs(off).max(initial=0.0) <= ROUNDING * np.abs(A).max()


def test_rows_of_a_patch_of_very_many_points_are_reduced_block_by_block(monkeypatch):
    """All dependences at once would be a matrix of (rows x rows), and hours for a large patch."""
    decomposed = []
    svd = np.linalg.svd
    monkeypatch.setattr(np.linalg, "svd", lambda a: decomposed.append(max(a.shape)) or svd(a))
    A = np.random.default_rng(1).integers(-2, 3, (5 * BLOCK, 3))
    lam = np.ones(len(A))
    rows = warm_rows(A, lam, np.zeros(len(A)))
    assert max(decomposed) <= BLOCK + 3
    assert len(rows) == np.linalg.matrix_rank(A[rows]) == 3
    carried = np.linalg.solve(A[rows].T, A.sum(axis=0))
    assert (carried > 0).all()  # a cone holds what is carried
