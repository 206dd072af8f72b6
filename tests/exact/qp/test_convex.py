"""Singular P, linear programs, costs by factors, objectives, digits, and ends of float64."""

import pickle
from dataclasses import replace
from decimal import Decimal
from fractions import Fraction
from functools import partial

import numpy as np
import pandas
import pytest
import scipy.optimize
import scipy.sparse
from flint import fmpq, fmpz

import quasistatic_ref as qr
from quasistatic_ref.exact.qp import substitution
from quasistatic_ref.exact.qp.face import Face
from quasistatic_ref.exact.qp.program import program_of
from quasistatic_ref.exact.qp.uniqueness import Witness
from quasistatic_ref.numbers import modulo
from tests.exact.qp.test_exact import both_take
from tests.oracles.random_programs import program_on_equations, random_program
from tests.oracles.rational_kkt import exact


def answered(program):
    """What a program has: its optimum, or the proof of none, as it stands in a file."""
    try:
        return vars(qr.exact_qp(**program)) | {"problem": None}
    except (qr.QPInfeasible, qr.QPUnbounded, qr.QPNotConvex) as proof:
        return proof.claims


MAKERS = [random_program, partial(random_program, singular=True), program_on_equations]


@pytest.mark.filterwarnings("ignore:.* is a number here")
@pytest.mark.parametrize("prime", [3, 5, 7])
@pytest.mark.parametrize(
    "part", [0, *(pytest.param(k, marks=pytest.mark.long) for k in range(1, 28))]
)
def test_an_answer_is_the_same_whatever_prime_is_asked_first(part, prime, monkeypatch):
    """Small primes divide minors of most of these programs, and of their rows."""
    for seed in range(8 * part, 8 * (part + 1)):
        for make in MAKERS:
            program = make(seed)
            usual = answered(program)
            monkeypatch.setattr(modulo, "PRIME", prime)
            other = answered(program)
            monkeypatch.undo()
            assert usual.keys() == other.keys()
            for name, value in usual.items():
                if name not in ("least_norm", "active", "direction"):  # others may be as right
                    assert np.array_equal(value, other[name]), (seed, name)


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


ENDS = {
    # c, b: x, where costs, limits or x are near the ends of float64; None is beyond them.
    "small costs": (([-1e-300, 0.0], [[1.0, 1.0], [1.0, -1.0]], [1e30, 1e30]), [1e30, 0.0]),
    "smallest costs": (([-5e-324, 0.0], [[1.0, 1.0], [1.0, -1.0]], [1e300, 1e300]), [1e300, 0.0]),
    "small limits": (([-1e300, 0.0], [[1.0, 1.0], [1.0, -1.0]], [1e-300, 1e-300]), [1e-300, 0.0]),
    "an x beyond": (([1.0, 1.0], [[-0.3, -0.7]], [-1.79e308]), None),
}


@pytest.mark.filterwarnings("ignore:.* is a number here")
@pytest.mark.parametrize("name", ENDS)
def test_a_linear_program_near_the_ends_of_float64_has_its_answer_or_a_sentence(name):
    (c, A, b), x = ENDS[name]
    bounds = (None, None) if x else (0, None)
    if x is None:
        with pytest.raises(qr.InputError, match="beyond the range of float64; choose other units"):
            qr.exact_lp(c, A_ub=A, b_ub=b, bounds=bounds)
        return
    answer = qr.exact_lp(c, A_ub=A, b_ub=b, bounds=bounds)
    assert answer.x.tolist() == x
    assert qr.verify(answer)


def line_fit():
    """A line through three points 1e-4 off it, and half the square of their distance to it.

    That is half of det [R, s]^2 / det R'R.
    """
    R = [[Fraction(v) for v in row] for row in (("0.1", "0.3"), ("0.7", "0.2"), ("0.5", "0.9"))]
    off = Fraction(1, 10**4)
    s = [1800 + off, 3100 - off, 6000 + off]
    u, v = zip(*R, strict=True)

    def dot(a, b):
        return sum(k * m for k, m in zip(a, b, strict=True))

    def triple(a, b, c):
        x = (b[1] * c[2] - b[2] * c[1], b[2] * c[0] - b[0] * c[2], b[0] * c[1] - b[1] * c[0])
        return dot(a, x)

    normal = dot(u, u) * dot(v, v) - dot(u, v) ** 2
    return qr.exact_ls(R, s), triple(u, v, s) ** 2 / normal / 2


HS35 = program_of(
    [[4.0, 2.0, 2.0], [2.0, 4.0, 0.0], [2.0, 0.0, 2.0]], [-8.0, -6.0, -4.0],
    [[1.0, 1.0, 2.0]], [3.0], None, None, np.zeros(3), None, constant=9.0,
)  # fmt: skip
THIRDS = {"A": [[3.0, 0.0], [0.0, 3.0]], "b": [1.0, 1.0]}
OBJECTIVES = {
    "a line through points": line_fit,
    "HS35, by its authors": lambda: (qr.exact_qp(HS35), Fraction(1, 9)),
    "blocks that cancel": lambda: (
        qr.exact_qp(np.zeros((2, 2)), [1e8, -1e8 - 1], **THIRDS),  # of x = [1, 1] / 3
        Fraction(-1, 3),
    ),
    "less than the least number": lambda: (
        qr.exact_lp([1e-200], bounds=(1e-200, None)),
        Fraction(1e-200) ** 2,
    ),
}


@pytest.mark.parametrize("name", OBJECTIVES)
def test_the_objective_is_rounded_once(name):
    answer, wanted = OBJECTIVES[name]()
    assert answer.obj == float(wanted)
    assert abs(Fraction(answer.obj) - wanted) <= answer.obj_error
    assert qr.verify(answer)


PRODUCT = {"P": [[0.0, 1.0], [1.0, 0.0]], "q": [0.0, -1.0]}  # x_0 x_1 - x_1: zero where x_0 = 1
SQUARES = {"P": np.diag([1.0, -1.0]), "q": [-1.0, 1.0]}  # zero where x_0 + x_1 = 2
MOVED = {
    # program, x, and [y, z_box] of P x + q + A'y + z_box = 0
    "a fixed variable": (
        PRODUCT | {"lb": [1.0, 2.0], "ub": [1.0, np.inf]},
        [1.0, 2.0],
        [[], [-2.0, 0.0]],
    ),
    "the same beside zero": (
        PRODUCT | {"lb": [1.0, -np.inf], "ub": [1.0, np.inf]},
        [1.0, 0.0],
        [[], [0.0, 0.0]],
    ),
    "an equation": (
        PRODUCT | {"A": [[1.0, 0.0]], "b": [1.0], "lb": [-np.inf, 2.0]},
        [1.0, 2.0],
        [[-2.0], [0.0, 0.0]],
    ),
    "an equation twice": (
        PRODUCT | {"A": [[1.0, 0.0], [2.0, 0.0]], "b": [1.0, 2.0], "ub": [np.inf, -1.0]},
        [1.0, -1.0],
        [[1.0, 0.0], [0.0, 0.0]],
    ),
    "an equation of both": (
        SQUARES | {"A": [[1.0, 1.0]], "b": [2.0], "lb": [3.0, -np.inf]},
        [3.0, -1.0],
        [[-2.0], [0.0, 0.0]],
    ),
}


@pytest.mark.parametrize("name", MOVED)
def test_multipliers_are_those_of_the_optimum_of_least_norm(name, tmp_path):
    """The cost is zero on a line, along which multipliers move with x."""
    program, x, multipliers = MOVED[name]
    answer = qr.exact_qp(**program)
    assert (answer.x.tolist(), answer.obj, answer.x_unique) == (x, 0.0, False)
    assert [answer.y.tolist(), answer.z_box.tolist()] == multipliers
    both_take(answer, tmp_path)


def test_a_search_that_leaves_multipliers_where_x_came_from_is_not_believed(monkeypatch):
    program, *_ = MOVED["a fixed variable"]
    monkeypatch.setattr(Face, "_multipliers", lambda *_: {})
    answer = qr.exact_qp(**program)
    assert answer.z_box.tolist() == [0.0, 0.0]
    assert "z_box[0]" in qr.verify(answer).reason


ONE, TWO = {"lb": [0.0]}, {"lb": [0.0], "G": [[-1.0]], "h": [0.0]}  # x >= 0, and twice
FALSE = [
    # the cost of x, rows, a false claim, and a false witness of it
    (1.0, ONE, {"multipliers_unique": False}, Witness(False, {}, [])),
    (1.0, TWO, {"multipliers_unique": True}, Witness(True, {}, [])),
    (1.0, TWO, {"multipliers_unique": True}, Witness(True, {}, [fmpz(1)])),
    (0.0, ONE, {"direction": ()}, Witness(True, {}, [])),
    (0.0, ONE, {"direction": ()}, Witness(True, {0: fmpq(1)}, [])),
]


@pytest.mark.parametrize(("cost", "rows", "claim", "witness"), FALSE)
def test_a_false_witness_of_uniqueness_is_not_believed(cost, rows, claim, witness, monkeypatch):
    answer = qr.exact_qp([[0.0]], [cost], **rows)
    asked = "multipliers_witness" if "multipliers_unique" in claim else "optimum_witness"
    monkeypatch.setattr(substitution, asked, lambda *_: witness)
    assert "not proved" in qr.verify(replace(answer, **claim)).reason


@pytest.mark.parametrize("unit", [1.0, 1e3, 1e6, 1e-6])
def test_digits_do_not_depend_on_the_units_of_other_variables(unit):
    """x_1 >= 1e-3 is missed by 1e-3, of terms 2e-3: 0.3 digits, in whatever unit x_0 is."""
    answer = qr.exact_lp(
        [1 / unit, 0.0], A_eq=[[1 / unit, 0.0]], b_eq=[1.0], bounds=[(0, None), (1e-3, None)]
    )
    assert answer.digits([unit, 0.0]) == pytest.approx(np.log10(2.0))


@pytest.mark.parametrize("unit", [1.0, 1e3, 1e6, 1e-6])
def test_digits_of_multipliers_do_not_depend_on_the_units_of_other_variables(unit):
    """Halves of both rows balance 1 in column 0 and 2 in column 1, of terms of 2 and 4."""
    rows = [[-1 / unit, -1.0], [-1 / unit, -3.0]]
    answer = qr.exact_lp([1 / unit, 2.0], A_ub=rows, b_ub=[-1.0, -2.0], bounds=(0, None))
    assert answer.z.tolist() == [0.5, 0.5]
    assert answer.digits_of_multipliers(answer.z) == 16
    assert answer.digits_of_multipliers([0.501, 0.5]) == pytest.approx(np.log10(2001.0))
    no_limit = answer.digits_of_multipliers(answer.z, z_box=[0.0, 1e-3])
    assert no_limit == pytest.approx(np.log10(4001.0))


def test_noise_of_multipliers_where_nothing_bears_leaves_all_digits():
    """x_1 costs nothing; 1e-20 on its bound, and on a row with slack at x* = 0, is nothing."""
    answer = qr.exact_lp([1.0, 0.0], A_ub=[[1.0, 0.0]], b_ub=[9.0], bounds=[(0, None), (-1, None)])
    assert answer.x.tolist() == [0.0, 0.0]
    assert answer.digits_of_multipliers([1e-20], z_box=[-1.0, -1e-20]) == 16
    none = answer.digits_of_multipliers([0.0], z_box=[0.0, 0.0])
    assert none == pytest.approx(np.log10(2.0))  # 1 is missing, of terms 1 and 1


@pytest.mark.filterwarnings("ignore:.* is a number here")
def test_digits_of_numbers_whose_products_are_beyond_float64_are_numbers():
    """Rows of 1e200 at x* = (1e200, 1e200): a tenth off x_0 is a digit of the cost."""
    answer = qr.exact_lp(
        [-1.0, 0.0], A_ub=[[1e200, -1e200]], b_ub=[0.0], bounds=[(0, None), (0, 1e200)]
    )
    assert answer.x.tolist() == [1e200, 1e200]
    assert answer.digits(answer.x) == 16
    assert answer.digits([0.9e200, 1e200]) == pytest.approx(1.0)
    assert answer.digits_of_multipliers(answer.z, z_box=answer.z_box) == 16


def test_optima_of_zero_have_all_digits():
    """Each (x, 3x) is an optimum, but for rounding; and of multipliers x* counts, not its float."""
    line = qr.exact_qp(np.zeros((2, 2)), [0.0, 0.0], A=[[0.3, -0.1]], b=[0.0])
    assert line.digits([1 / 3, 1.0]) == line.digits([1.0, 3.0]) == 16
    same = qr.exact_qp([[1.0, -1.0], [-1.0, 1.0]], [0.0, 0.0], G=[[0.3, -0.3]], h=[0.0])
    assert same.digits([0.1, 0.1]) == 16
    assert same.digits([0.1, np.nextafter(0.1, 0)]) > 15
    P = np.array([[1.0, 0.9999999999], [0.9999999999, 1.0]])
    bent = qr.exact_qp(P, [0.1, -0.3], G=[[1.0, 0.0]], h=[100.0])
    assert bent.digits_of_multipliers(z=bent.z) == 16


@pytest.mark.parametrize(
    ("P", "A", "b", "x"),
    [
        (-np.eye(2), [[2.0**31, 1.0], [1.0, 2.0**30]], [2.0**31 + 1.0, 2.0**30 + 1.0], [1.0, 1.0]),
        ([[1, -2], [-2, 1]], [[2**61 - 1, 2**61 - 1]], [2**61 - 1], [0.5, 0.5]),
        (np.zeros((2, 2)), [[2.0**31, 1.0], [1.0, 2.0**30]], [2.0**31, 1.0], [1.0, 0.0]),
        (np.outer([0, 1, -2], [0, 1, -2]), [[2.0**31, 1, 0], [1, 2.0**30, 0]], [0, 0], [0, 0, 0]),
    ],
)
def test_equations_whose_minor_is_the_prime_hold_x(P, A, b, x):
    answer = qr.exact_qp(P, np.zeros(len(P)), A=A, b=b)
    assert answer.x.tolist() == x
    assert qr.verify(answer)
