"""The guess of the active rows: independent rows that carry the same net impulse."""

import numpy as np
import pytest

from quasistatic_ref import standard_form
from quasistatic_ref.certify.warm import BLOCK, basic_rows, warm_rows
from tests.helpers import resting_point
from tests.tolerances import ROUNDING


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
