"""The bounds in float64 are those of their formulas, term by term, with roundings made large.

Their own roundings are of 1e-16 and hidden by those of the tests. Here each operation is taken to
be off by a millionth or so, so that no term of a formula is too small to be seen.
"""

from dataclasses import dataclass

import numpy as np
import pytest
from flint import arb, arb_mat
from scipy.sparse import csc_matrix

from quasistatic_ref.optional.large import least_eigenvalues as eigenvalues
from quasistatic_ref.optional.large import rounded_bound, sparse_bound
from quasistatic_ref.optional.large.blocks import Blocks
from quasistatic_ref.optional.large.bound import opening_direction
from quasistatic_ref.optional.large.opening import NEAR, RIDGE, opening
from quasistatic_ref.optional.large.outward import down, up
from quasistatic_ref.optional.large.rounded_bound import RANGE, FloatBound
from quasistatic_ref.optional.large.sizes import LARGEST, _most_rows, sizes_of
from quasistatic_ref.optional.large.sparse_bound import (
    ENOUGH,
    LargeForm,
    Metric,
    least_way,
    sparse_error_bound,
)
from tests.helpers import in_blocks, point_on_floor, random_step, random_stiffness
from tests.optional.large.test_rounded_bound import Judged
from tests.tolerances import ROUNDING

U, TINY, MORE = 2.0**-20, 2.0**-10, 1.25


@pytest.mark.parametrize("seed", range(3))
def test_dense_bound_is_that_of_its_formula(monkeypatch, seed):
    """The error of an answer that violates rows, balances nothing and presses anywhere."""
    for name, value in (("U", U), ("UNDERFLOW", TINY), ("MORE", MORE)):
        monkeypatch.setattr(rounded_bound, name, value)
    rng = np.random.default_rng(seed)
    step = random_step(rng)
    n, m = step.n_v, int(step.offsets[-1])
    x, y = rng.standard_normal(n), rng.random(m) * (rng.random(m) < 0.5)
    judged = Judged(step, x, y)
    (S, ell, rho), (H, g, A, b) = judged.units, judged.form
    inverse, c = np.linalg.inv(H), step.contacts
    most = MORE * np.abs(inverse)
    # Sizes of what is summed.
    weight = np.column_stack([1 + c.mu_v] * 3 + [c.mu_omega * (c.rows == 6)])
    reach = (weight[:, :, None] * np.abs(c.J) * S / ell).sum(axis=1)
    target = np.abs(step.delta_q_bar_a) / (rho * S[: step.n_a])
    load = np.abs(g) + 2 * np.abs(H)[:, : step.n_a] @ target + TINY
    pressed = np.array([part.sum() for part in np.split(y, step.offsets[1:-1])])[: c.n_c] @ reach
    # What they may be off by.
    lost = U * TINY * (1 + np.abs(x).sum() + y.sum())
    balance, slack = H @ x - g - A.T @ y, A @ x - b
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


def dense_of(coordinate, radius=0.0):
    """The bound of H = h = 1 in one coordinate, from an inverse that is known to a radius."""
    inverse = arb_mat([[arb(1, radius)]])
    return FloatBound(inverse, arb(1), np.eye(1), np.array([coordinate])), inverse


def test_an_inverse_is_within_two_roundings_of_what_stands_for_its_size():
    """Of the numbers of the ball 1 +- 2^-10, the middle is within 2 u times their bound."""
    bound, _ = dense_of(1.0, 2.0**-10)
    assert bound.inverse.tolist() == [[1.0]]
    assert 2.0**-10 <= 2 * 2.0**-53 * bound.magnitude[0, 0] <= 2.0**-6


@pytest.mark.parametrize(("end", "inside"), [(RANGE[0], 1.0), (RANGE[1], 1.0)])
def test_units_at_the_ends_of_their_range_are_outside_of_it(end, inside):
    assert not dense_of(end)[0].in_range
    assert dense_of(np.nextafter(end, inside))[0].in_range
    step = point_on_floor(force=(4.0, 1.0, -2.943))
    judged = Judged(step, np.zeros(3), np.zeros(4))
    answer = judged.x, judged.y
    for units in ((end, 1.0), (1.0, end)):
        assert judged.bound.error(step, judged.form, units, *answer) is None


def test_a_bound_is_of_one_hessian_in_one_set_of_units():
    bound, inverse = dense_of(1.0)
    assert bound.serves(inverse, bound.coordinate)
    assert not bound.serves(inverse, bound.coordinate.copy())
    assert not bound.serves(dense_of(1.0)[1], bound.coordinate)


def test_an_energy_that_rounding_uses_up_decides_nothing(monkeypatch):
    judged = Judged(point_on_floor(force=(4.0, 1.0, -2.943)), np.zeros(3), np.zeros(4))
    assert judged.error is not None
    monkeypatch.setattr(FloatBound, "energy", lambda *_: 0.0)
    assert judged.bound.error(*judged.given, judged.y) is None


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
    return LargeForm(Metric(csc_matrix(H)), g, csc_matrix(A), b, Sizes(A, 2 * np.abs(g)))


@pytest.mark.parametrize("seed", range(3))
def test_sparse_bound_is_that_of_its_formula(monkeypatch, seed):
    rng = np.random.default_rng(seed)
    H, g, A = random_stiffness(rng, 4, 2.0), rng.standard_normal(4), rng.random((5, 4))
    x, y = rng.standard_normal(4), rng.random(5)
    b = A @ x - [-0.3, *rng.standard_normal(4)]
    form, least = large(H, g, A, b), Metric(csc_matrix(H)).least
    monkeypatch.setattr(sparse_bound, "rounding", loose)
    slack, off = A @ x - b, loose(3, np.abs(A) @ np.abs(x) + np.abs(b))
    d = opening(csc_matrix(A), slack)
    opens, off_d = A @ d, loose(3, np.abs(A) @ np.abs(d))
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


def test_numbers_as_large_as_allowed_have_a_bound_and_larger_ones_none(monkeypatch):
    beyond, row = np.nextafter(LARGEST, np.inf), np.ones((1, 1))
    for most, bounded in ((LARGEST, True), (beyond, False)):
        far = np.array([most])
        opened = large(row, [1.0], row, [1.0])
        monkeypatch.setattr(sparse_bound, "opening", lambda *_, d=far: d)
        found = [
            sparse_error_bound(large(row, [1.0], np.zeros((0, 1)), []), far, np.zeros(0)),  # x
            sparse_error_bound(large(row, [1.0], row, [-1.0]), np.zeros(1), far),  # y
            sparse_error_bound(large(row, [1.0], row, -far), np.zeros(1), np.zeros(1)),  # b
            sparse_error_bound(large(row, far, row, [-1.0]), np.zeros(1), np.zeros(1)),  # H^-1 g
            sparse_error_bound(opened, np.zeros(1), np.zeros(1)),  # d
        ]
        assert (np.array(found) < np.inf).tolist() == [bounded] * 5


def test_what_is_not_shown_to_be_definite_has_no_bound():
    """The eigenvalues are 3 and -1."""
    form = large([[1.0, 2.0], [2.0, 1.0]], [1.0, 1.0], np.zeros((0, 2)), [])
    assert sparse_error_bound(form, np.zeros(2), np.zeros(0)) == np.inf


def test_a_wedged_body_that_violates_nothing_has_a_bound():
    form = large(np.eye(1), [1.0], [[1.0], [-1.0]], [-0.5, -0.5])
    assert opening(form.A, np.full(2, 0.5)) is None
    assert sparse_error_bound(form, np.zeros(1), np.zeros(2)) < np.inf


def test_a_direction_that_closes_what_it_should_open_gives_no_bound(monkeypatch):
    monkeypatch.setattr(sparse_bound, "opening", lambda *_: -np.ones(1))
    form = large(np.eye(1), [1.0], [[1.0]], [1.0])
    assert sparse_error_bound(form, np.zeros(1), np.ones(1)) == np.inf


def test_a_slack_of_the_rounding_of_the_way_is_enough():
    """The sum and the product are each moved down by the least float64, 2^-1074."""
    assert least_way(np.array([2 * 5e-324]), np.zeros(1)) == 0.0
    assert least_way(np.array([5e-324]), np.zeros(1)) == np.inf


def test_eigenvalues_are_bounded_by_their_formula(monkeypatch):
    """Of [[2, 1], [1, 2]], c = 1/2; L L' = H - c I has no negative entries, so sizes are 2 H."""
    monkeypatch.setattr(eigenvalues, "rounding", loose)
    off = 2 * 3 * 3 * U
    expected = 0.5 - (off + 3 * U * off)
    found = eigenvalues.least_eigenvalues(csc_matrix([[2.0, 1.0], [1.0, 2.0]]))
    np.testing.assert_allclose(found, expected, rtol=ROUNDING)


@pytest.mark.parametrize(("move", "neighbour"), [(up, 1 + 2.0**-52), (down, 1 - 2.0**-53)])
def test_numbers_are_moved_to_their_neighbours(move, neighbour):
    assert move(1.0) == neighbour
    assert move(-1.0) == -(up if move is down else down)(1.0)


def test_sizes_are_usable_up_to_the_largest_number_that_is():
    """Of a unit S, or of h, where no force makes the load larger."""
    rng = np.random.default_rng(2)
    still = random_step(rng).replace(
        tau_a=np.zeros(3), tau_u=np.zeros(4), delta_q_bar_a=np.zeros(3)
    )
    for most, usable in ((LARGEST, True), (np.nextafter(LARGEST, np.inf), False)):
        assert sizes_of(in_blocks(still), np.full(7, most), 1.0, 1.0).usable == usable
        slow = in_blocks(still.replace(h=float(most)))
        assert sizes_of(slow, np.ones(7), 1.0, 1.0).usable == usable


def test_contacts_that_move_less_than_others_count_for_no_coordinate():
    """Two contacts of four rows move 0 and 1, a third moves 0 alone: 2 stands for none."""
    blocks = Blocks(np.array([[0, 2], [1, 2], [0, 2]]), np.zeros((3, 4, 2)), 2)
    assert _most_rows(blocks, np.array([4, 4, 4])) == 8
    assert _most_rows(blocks, np.array([1, 4, 2])) == 4


def test_rows_are_opened_up_to_a_slack_of_one():
    """Two walls that face each other cannot both be opened."""
    A = csc_matrix([[1.0], [-1.0]])
    assert opening(A, np.array([0.0, NEAR])) is None
    assert opening(A, np.array([0.0, np.nextafter(NEAR, 2.0)])) is not None


@pytest.mark.parametrize("scale", [1.0, 4.0])
def test_a_row_alone_is_opened_by_one_but_for_the_ridge(scale):
    """(1 + RIDGE) d = 1 of the row divided by its length; what touches nothing stays."""
    d = opening(csc_matrix([[scale, 0.0]]), np.zeros(1))
    np.testing.assert_allclose(d, [1 / (1 + RIDGE), 0.0], rtol=ROUNDING)


def test_a_row_of_bodies_is_opened_by_accelerated_least_squares():
    """Each of 160 bodies has to move farther than the last; B has lines of length one.

    u_(k+1) = d_k + N^-1 B'(1 - B d_k)_+ with N = B'B + RIDGE, d_k = u_k + (k - 1) / (k + 2)
    (u_k - u_(k-1)), till no row is short of 1 by half.
    """
    n = 160
    A = np.eye(n) - np.eye(n, k=-1)
    B = A / np.linalg.norm(A, axis=1)[:, None]
    inverse, rounds = np.linalg.inv(B.T @ B + RIDGE * np.eye(n)), 0
    d = last = np.zeros(n)
    while (1 - B @ d).max() >= 0.5:
        u = d + inverse @ B.T @ np.maximum(1 - B @ d, 0)
        rounds += 1
        d, last = u + (rounds - 1) / (rounds + 2) * (u - last), u
    assert rounds > 5
    np.testing.assert_allclose(opening(csc_matrix(A), np.zeros(n)), d, rtol=ROUNDING)
