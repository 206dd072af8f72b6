"""The bounds in float64 are those of their formulas, term by term, with roundings made large.

Their own roundings are of 1e-16 and hidden by those of the tests. Here each operation is taken to
be off by a millionth or so, so that no term of a formula is too small to be seen.
"""

from dataclasses import dataclass

import numpy as np
import pytest
from scipy.sparse import csc_matrix

from quasistatic_ref.optional.large import least_eigenvalues as eigenvalues
from quasistatic_ref.optional.large import rounded_bound, sparse_bound
from quasistatic_ref.optional.large.bound import opening_direction
from quasistatic_ref.optional.large.opening import opening
from quasistatic_ref.optional.large.sparse_bound import (
    ENOUGH,
    LargeForm,
    SparseHessian,
    sparse_error_bound,
)
from tests.helpers import random_step, random_stiffness
from tests.optional.large.test_rounded_bound import Judged
from tests.tolerances import ROUNDING

U = 2.0**-20
TINY = 2.0**-10
MORE = 1.25


@pytest.mark.parametrize("seed", range(3))
def test_dense_bound_is_that_of_its_formula(monkeypatch, seed):
    """The error of an answer that violates rows, balances nothing and presses anywhere."""
    for name, value in (("U", U), ("UNDERFLOW", TINY), ("MORE", MORE)):
        monkeypatch.setattr(rounded_bound, name, value)
    rng = np.random.default_rng(seed)
    step = random_step(rng)
    n = step.n_v
    m = int(step.offsets[-1])
    x = rng.standard_normal(n)
    y = rng.random(m) * (rng.random(m) < 0.5)
    judged = Judged(step, x, y)
    S, ell, rho = judged.units
    H, g, A, b = judged.form
    inverse = np.linalg.inv(H)
    c = step.contacts
    most = MORE * np.abs(inverse)
    # Sizes of what is summed.
    weight = np.column_stack([1 + c.mu_v] * 3 + [c.mu_omega * (c.rows == 6)])
    reach = (weight[:, :, None] * np.abs(c.J) * S / ell).sum(axis=1)
    target = np.abs(step.delta_q_bar_a) / (rho * S[: step.n_a])
    load = np.abs(g) + 2 * np.abs(H)[:, : step.n_a] @ target + TINY
    pressed = np.array([part.sum() for part in np.split(y, step.offsets[1:-1])])[: c.n_c] @ reach
    # What they may be off by.
    lost = U * TINY * (1 + np.abs(x).sum() + y.sum())
    balance = H @ x - g - A.T @ y
    slack = A @ x - b
    off_slack = U * (n + 8) * (reach @ np.abs(x)).max() + lost
    off_balance = lost + U * (
        (n + 4) * (np.abs(H) @ np.abs(x) + load)
        + np.abs(balance)
        + (np.count_nonzero(y) + 8) * pressed
    )
    free = g @ inverse @ g - MORE * U * (4 * n + 8) * load @ most @ load
    # The way along d to where all rows surely hold, and the theorem.
    d = opening_direction(step) / S
    off = U * (n + 8) * (reach @ np.abs(d)).max() + TINY
    t = (off_slack - slack.min()) / ((A @ d).min() - off)
    way = t * MORE * np.sqrt(np.abs(d) @ np.abs(H) @ np.abs(d))
    work = y @ np.maximum(slack, 0) + t * y @ A @ d + (off_slack + t * off) * y.sum()
    rest = np.abs(balance) + off_balance
    length = way + np.sqrt((np.sqrt(rest @ most @ rest) + way) ** 2 + 2 * work)
    assert slack.min() < 0
    assert judged.error == pytest.approx(MORE * length / np.sqrt(free), rel=ROUNDING)


def loose(terms, sizes):
    """In place of the rounding of sums."""
    return U * (terms + 1) * np.asarray(sizes)


@dataclass
class Sizes:
    """Of a dense A."""

    A: np.ndarray
    load: np.ndarray
    row_terms: int = 3
    column_terms: int = 7
    usable: bool = True

    def rows(self, x):
        """Of A x."""
        return np.abs(self.A) @ np.abs(x)

    def columns(self, lam):
        """Of A'lam."""
        return np.abs(self.A).T @ lam


def large(H, g, A, b):
    H, g, A, b = (np.array(v, dtype=np.float64) for v in (H, g, A, b))
    return LargeForm(SparseHessian(csc_matrix(H)), g, csc_matrix(A), b, Sizes(A, 2 * np.abs(g)))


@pytest.mark.parametrize("seed", range(2))
def test_sparse_bound_is_that_of_its_formula(monkeypatch, seed):
    rng = np.random.default_rng(seed)
    H = random_stiffness(rng, 4, 2.0)
    g = rng.standard_normal(4)
    A = rng.random((5, 4))
    x = rng.standard_normal(4)
    y = rng.random(5)
    b = A @ x - [-0.3, *rng.standard_normal(4)]
    form = large(H, g, A, b)
    least = SparseHessian(csc_matrix(H)).least
    monkeypatch.setattr(sparse_bound, "rounding", loose)
    slack = A @ x - b
    off = loose(3, np.abs(A) @ np.abs(x) + np.abs(b))
    d = opening(csc_matrix(A), slack)
    opens = A @ d
    off_d = loose(3, np.abs(A) @ np.abs(d))
    short = slack - off < 0
    t = ENOUGH * ((off - slack) / (opens - off_d))[short].max()
    sums = np.abs(H).sum(axis=1)
    way = t * np.sqrt(d * d @ (sums + loose(4, sums)))
    work = y @ (slack + off) + t * y @ (opens + off_d)
    sizes = np.abs(H) @ np.abs(x) + 2 * np.abs(g) + np.abs(A).T @ y
    rest = np.abs(H @ x - g - A.T @ y) + loose(7, sizes)
    length = way + np.sqrt((np.sqrt((rest**2 / least).sum()) + way) ** 2 + 2 * work)
    z = np.linalg.solve(H, g)
    along = g @ z - loose(7, 2 * np.abs(g)) @ np.abs(z)
    free = along / np.sqrt(z @ H @ z + loose(4, np.abs(H) @ np.abs(z)) @ np.abs(z))
    assert short.any()
    assert work > 0
    assert sparse_error_bound(form, x, y) == pytest.approx(length / free, rel=ROUNDING)


def test_eigenvalues_are_bounded_by_their_formula(monkeypatch):
    """Of [[2, 1], [1, 2]], c = 1/2; L L' = H - c I has no negative entries, so sizes are 2 H."""
    monkeypatch.setattr(eigenvalues, "rounding", loose)
    off = 2 * 3 * 3 * U
    expected = 0.5 - (off + 3 * U * off)
    found = eigenvalues.least_eigenvalues(csc_matrix([[2.0, 1.0], [1.0, 2.0]]))
    np.testing.assert_allclose(found, expected, rtol=ROUNDING)
