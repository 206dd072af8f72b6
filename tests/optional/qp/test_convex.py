"""Singular P, linear programs, and programs without an optimum, against Lemke's method."""

import pickle
from collections import Counter
from decimal import Decimal
from fractions import Fraction

import numpy as np
import pandas
import pytest
import scipy.optimize
import scipy.sparse

import quasistatic_ref as qr
from tests.optional.qp.test_exact import both_take, in_rows, inequalities
from tests.oracles.lemke import least_norm
from tests.oracles.random_programs import random_program
from tests.oracles.rational_kkt import exact

PARTS = [0, *(pytest.param(part, marks=pytest.mark.long) for part in range(1, 40))]


@pytest.mark.filterwarnings("ignore:.* is a number here")  # programs of any scale
@pytest.mark.parametrize("part", PARTS)
def test_2000_programs_have_the_answers_of_lemkes_method_in_fractions(part, tmp_path):
    """Both checkers judge the proofs of those without an optimum."""
    kinds = Counter()
    for seed in range(50 * part, 50 * (part + 1)):
        program = random_program(seed, singular=True)
        of, _, e = in_rows(program)
        wanted = least_norm(*inequalities(of, e))
        if wanted is None:
            with pytest.raises((qr.QPInfeasible, qr.QPUnbounded)) as caught:
                qr.exact_qp(**program)
            answer = caught.value
        else:
            answer = qr.exact_qp(**program)
            assert [float(v) for v in wanted] == answer.x.tolist(), seed
            assert answer.digits(answer.x) > 15
            # What rounding of the multipliers leaves: 13.6 digits at the least.
            assert answer.digits_of_multipliers(answer.z, answer.y, answer.z_box) > 13
            kinds["several"] += not answer.x_unique
        kinds[type(answer).__name__] += 1
        both_take(answer, tmp_path)
    assert len(+kinds) >= 3  # of optima, several, no solution, no end


def test_other_optima_have_all_digits_and_other_points_do_not():
    answer = qr.exact_qp(np.ones((2, 2)), [-2.0, -2.0], lb=[0.0, 0.0])
    assert (answer.x.tolist(), answer.obj, answer.x_unique) == ([1.0, 1.0], -2.0, False)
    assert answer.digits([0.25, 1.75]) == answer.digits([2.0, 0.0]) == 16
    assert answer.digits([0.25, 1.75 + 1e-6]) < 8
    assert answer.digits([-1.0, 3.0]) == 0  # beyond a bound
    assert answer.digits_of_multipliers() == 16
    assert 5 < answer.digits_of_multipliers(None, None, [1e-6, 0.0]) < 7


def test_a_linear_program_in_the_words_of_scipy():
    rng = np.random.default_rng(0)
    for limits in ((0, 7), [(0, None), (-2, 9), (None, 5), (np.nan, np.nan)]) * 10:
        A_ub, x, c = rng.integers(-3, 6, (5, 4)), rng.integers(0, 4, 4), rng.integers(-3, 4, 4)
        words = {"A_ub": A_ub, "b_ub": A_ub @ x + 1, "A_eq": [[1, 1, 1, 1]], "b_eq": x.sum()}
        there = scipy.optimize.linprog(c, bounds=limits, **words)
        if there.status == 3:
            with pytest.raises(qr.QPUnbounded):
                qr.exact_lp(c, bounds=limits, **words)
        else:
            here = qr.exact_lp(c, bounds=limits, **words)
            assert here.obj == pytest.approx(there.fun, abs=1e-9)
    assert qr.exact_lp([1, 2], [[-1, -1]], -1).x.tolist() == [1.0, 0.0]
    assert qr.exact_lp([1, 2], bounds=[(1, None), (np.nan, -2)], A_ub=[0, -1], b_ub=3).obj == -5
    with pytest.raises(qr.QPUnbounded):
        qr.exact_lp([1, -1])
    with pytest.raises(qr.InputError, match="integrality: is for whole numbers"):
        qr.exact_lp([1, 1], integrality=[1, 0])
    with pytest.raises(qr.InputError, match="bounds: must be a pair, or 2 pairs"):
        qr.exact_lp([1, 1], bounds=[(0, 1)] * 3)


def test_a_cost_by_factors_is_formed_without_rounding():
    X = np.random.default_rng(0).normal(size=(3, 6)).round(3)
    rows = {"A": np.ones(6), "b": [1.0], "lb": np.zeros(6)}
    with pytest.raises(qr.QPNotConvex):
        qr.exact_qp(X.T @ X, np.zeros(6), **rows)
    answer = qr.exact_ls(X, np.zeros(3), **rows)
    assert qr.verify(answer)
    R, s, W = [["0.1", 2], [3, "1/3"], [0, 1]], [1, "0.7", 2], np.diag([1.0, 2.0, 0.5])
    q, D, x = [Fraction(1, 7), 0], [0, Decimal("0.01")], exact([1, 2])
    whole = qr.exact_ls(R, s, W=W, q=q, D=D, A=np.eye(2), b=[1, 2])
    R = exact([[Fraction(v) for v in row] for row in R])
    r = R @ x - exact([Fraction(v) for v in s])
    wanted = r @ exact(W) @ r / 2 + x[0] / 7 + x[1] ** 2 * Fraction(1, 200)
    assert whole.obj == pytest.approx(float(wanted), rel=1e-15)
    assert qr.exact_ls([[2.0]], [3.0], D=[[5.0]]).x.tolist() == [6 / 9]
    with pytest.raises(qr.InputError, match="s or W: must be of 3 residuals"):
        qr.exact_ls(np.eye(3), [1.0, 2.0])


BIG = 2**53


@pytest.mark.parametrize(
    "b",
    [[BIG, BIG + 1], np.array([BIG, BIG + 1]), [Fraction(1, 3), 1 / 3], ["0.1", 0.1],
     np.array([1, 1 + np.finfo(np.longdouble).eps], dtype=np.longdouble), ["1e-3", "1/1001"]],
)  # fmt: skip
def test_numbers_that_float64_does_not_hold_are_taken_as_they_are(b, tmp_path):
    with pytest.raises(qr.QPInfeasible) as caught:
        qr.exact_qp([[1.0]], [0.0], A=[[1.0], [1.0]], b=b)
    both_take(caught.value, tmp_path)
    same = qr.exact_qp([[1.0]], [0.0], A=[[1.0], [1.0]], b=[b[0], b[0]])
    both_take(same, tmp_path)
    assert pickle.loads(pickle.dumps(same)) == same


def test_a_multiplier_beyond_2_to_the_53_and_decimals_that_fit(tmp_path):
    assert qr.exact_qp([[1]], [BIG + 1], lb=[-BIG]).z_box.tolist() == [-1.0]
    fits = qr.exact_qp(np.eye(1), [0.0], G=[["0.55"]], h=["0.22"], lb=["0.4"])
    assert (fits.x.tolist(), fits.problem.h.tolist()) == ([0.4], [0.22])
    both_take(fits, tmp_path)
    with pytest.raises(qr.QPInfeasible, match=r"by 2.9e-17, 0.13 ulps of 1: decimals, as texts"):
        qr.exact_qp(np.eye(1), [0.0], G=[[0.55]], h=[0.22], lb=[0.4])


@pytest.mark.parametrize("rows", [{"G": np.eye(2), "h": [1e20, 2.0]}, {"ub": [1e30, 2.0]}])
def test_a_number_that_others_take_for_infinite_is_said_where_it_bears(rows):
    with pytest.warns(UserWarning, match=r"1e\+?[23]0 is a number here; write inf"):
        answer = qr.exact_qp(np.zeros((2, 2)), [-1.0, 0.0], **rows)
    assert answer.x[0] >= 1e20
    assert qr.exact_qp(np.eye(2), [-1.0, 0.0], **rows).x.tolist() == [1.0, 0.0]


@pytest.mark.filterwarnings("ignore:the matrix subclass")
def test_forms_of_peers_are_the_same_program():
    P, q, G, h = [[2.0, 1.0], [1.0, 3.0]], [-3.0, -1.0], [[1.0, 1.0], [0.5, 2.0]], [1.0, 0.5]
    answer = qr.exact_qp(P, q, G, h)
    forms = [np.array, np.matrix, pandas.DataFrame, scipy.sparse.csc_matrix, scipy.sparse.coo_array]
    for form in forms:
        assert qr.exact_qp(form(P), q, form(G), h) == answer
    assert qr.exact_qp(P, pandas.Series(q), G, np.reshape(h, (2, 1)), [], []) == answer
    for one in (np.float16, np.float32, int):
        eye = np.eye(2, dtype=one)
        assert qr.exact_qp(eye, [-1, 0], eye[0], 2) == qr.exact_qp(np.eye(2), [-1, 0], eye[0], 2)
    assert qr.exact_qp(2.0, -1.0).x.tolist() == [0.5]
    answer.problem.P[0, 0] = 5.0  # arrays can be handed on to solvers that want to write
    assert not qr.verify(answer)
