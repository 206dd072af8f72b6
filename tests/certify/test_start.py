"""The rows from which the exact method starts: those that a solver's answer shows to be active."""

import itertools

import numpy as np
import pytest

from quasistatic_ref import Extra, StepNotSolved, solve_step, standard_form, verify
from quasistatic_ref.certify import optimum
from quasistatic_ref.certify.third_pairs import PAIRS, third_pair_rows
from quasistatic_ref.exact import active_set, minimiser, refined, working_set
from quasistatic_ref.exact.active_set import BLOCK, basic_rows, warm_rows
from quasistatic_ref.numbers import modulo
from tests.closeness import assert_same
from tests.helpers import resting_point
from tests.made import actuated_step, no_contacts
from tests.oracles.random_steps import drawn
from tests.tolerances import ROUNDING


def test_open_rows_are_left_out_and_the_most_pressed_comes_first():
    lam = np.array([1e-9, 2.0, 1.0, 1e-12])
    slack = np.array([1.0, 1e-9, 1e-12, 3.0])
    assert warm_rows(np.eye(4), lam, slack) == [1, 2]
    assert basic_rows(np.array([0.0, 1.0, 1.0, 3.0, -2.0, 1e-17])) == [3, 1, 2]
    assert basic_rows(np.zeros(2)) == []
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


def test_where_two_pairs_bear_the_violated_row_of_the_third_is_named():
    """However little it is violated; of a contact that turns freely, or bears otherwise, none."""
    step = resting_point(contacts=2)
    A = standard_form(step).A
    coordinate = [0, 1, 3]  # of each pair: slips along x and y, and the turn about z
    for whole, other, third in itertools.permutations(range(3)):
        for row, s in itertools.product(PAIRS[other], (1e-17, -1e-17)):
            lam = np.zeros(12)
            lam[[*PAIRS[whole], row]] = 1.0
            x = s * np.eye(4)[coordinate[third]]
            (named,) = third_pair_rows(step, A, x, lam)
            assert named in PAIRS[third]
            assert A[named] @ x < 0
            assert not third_pair_rows(step, A, 0 * x, lam).size
            lam[PAIRS[third, 0]] = 1.0
            assert not third_pair_rows(step, A, x, lam).size
    four = resting_point().contacts.with_fields(rows=np.array([4]))
    free = resting_point().with_fields(contacts=four)
    assert not third_pair_rows(
        free, standard_form(free).A, np.ones(4), np.array([1.0, 1.0, 1.0, 0.0])
    ).size


def outcome(step):
    """The bits of an exact answer and of A'lam, or the proof that there is none."""
    try:
        solution = solve_step(step, "none")
    except StepNotSolved as failure:
        return type(failure)
    assert verify(solution)
    return solution.delta_q.tobytes(), solution.certificate.multipliers_unique


PARTS = [0, *(pytest.param(part, marks=pytest.mark.long) for part in range(1, 34))]


@pytest.mark.parametrize("prime", [3, 5, 7])
@pytest.mark.parametrize("part", PARTS)
def test_a_step_has_the_same_answer_whatever_prime_is_asked_first(part, prime, monkeypatch):
    """Where even few rows are asked whether they depend modulo it, as many are."""
    for seed in range(20 * part, 20 * (part + 1)):
        step = drawn(seed)
        usual = outcome(step)
        for module in (modulo, minimiser, working_set):
            monkeypatch.setattr(module, "PRIME", prime)
        for module in (active_set, minimiser, optimum, refined):
            monkeypatch.setattr(module, "LARGE", 0)
        assert outcome(step) == usual, seed
        monkeypatch.undo()


def test_forty_rows_of_which_two_have_the_prime_as_their_minor_bear():
    """x_0 2^31 + x_1 = 1, x_0 + x_1 2^30 = 1 and x_k = 1; two more rows touch, and bear nothing."""
    n, bear = 44, 40
    rows = np.vstack([np.eye(n)[: bear + 2], np.ones(n)])
    rows[:2, :2] = [[2.0**31, 1.0], [1.0, 2.0**30]]
    sides = np.r_[np.ones(bear), 0.0, 0.0, -1e6]
    extra = Extra([f"r{i}" for i in range(bear + 3)], rows, sides)
    zero = np.zeros(n)
    step = actuated_step(np.eye(n), zero, zero, no_contacts(n), 1.0).replace(extra=extra)
    solution = solve_step(step, "none")
    assert solution.certificate.multipliers_unique
    assert verify(solution)
    assert_same(solution.delta_q[2:bear], np.ones(bear - 2))
