"""``exact_qp`` against another method in fractions; what a step would refuse; bad input."""

from fractions import Fraction
from pathlib import Path
from types import SimpleNamespace

import cvxpy as cp
import numpy as np
import pytest
import scipy.sparse

import quasistatic_ref as qr
from tests.oracles.program_truth import floats
from tests.oracles.random_programs import random_program
from validation import check_solution as checker

pytestmark = pytest.mark.filterwarnings("ignore:.* is a number here")  # programs of any scale


def both_take(answer, tmp_path):
    """What is saved is read again, and both checkers take it."""
    path = answer.save(tmp_path / "answer.json")
    read = qr.load_answer(path)
    if isinstance(answer, qr.ExactQP):
        assert read == answer
    else:
        assert {**vars(read), "problem": 0}.keys() == {**vars(answer), "problem": 0}.keys()
        assert (str(read), read.problem) == (str(answer), answer.problem)
    assert qr.verify(read), qr.verify(read).reason
    claims = [*checker.program_verdicts(checker.program_read(checker.table(path)))]
    assert all(holds for _, holds in claims), claims


def outcome(program, **more):
    """The optimum, or the proof of none."""
    try:
        return qr.exact_qp(**program, **more)
    except qr.QPInfeasible as proof:
        return proof


NEAR = [[1.0, 1.0], [1.0, 1.0 + 2.0**-50]]


@pytest.mark.parametrize(
    ("P", "words"),
    [
        ([[0.0, 1.0], [1.0, 0.0]], "x_0 - x_1"),
        ([[1.0, 1.0], [1.0, 1.0 - 2.0**-50]], "x_0 - x_1"),
        ([[4.0, 0.0], [0.0, -1e-300]], "x_1"),
        (np.outer([3 * 0.1, 0.7], [3 * 0.1, 0.7]), "x_0 - "),  # decimals: indefinite by an ulp
        ([[0.0, 1e-9, 0.0], [1e-9, 4.0, 0.0], [0.0, 0.0, 1.0]], "x_0 - "),
        ([[5e-324, 1e-160], [1e-160, 1.0]], "- x_0 + "),  # no unit of x makes both ones
    ],
)
def test_a_direction_that_costs_less_than_nothing_is_proved(P, words, tmp_path):
    with pytest.raises(qr.QPNotConvex, match="P as float64 holds it is not convex: ") as caught:
        qr.exact_qp(P, np.ones(len(P)), lb=np.zeros(len(P)))
    assert f"convex: {words}" in str(caught.value)
    both_take(caught.value, tmp_path)


def test_the_covariance_of_fewer_samples_than_assets_is_refused_in_its_own_time():
    X = np.random.default_rng(0).normal(size=(120, 200))
    with pytest.raises(qr.QPNotConvex) as caught:
        qr.exact_qp(np.cov(X.T), -np.ones(200), A=np.ones(200), b=[1.0], lb=np.zeros(200))
    assert qr.verify(caught.value)


SADDLE = {"P": [[2.0, 3.0], [3.0, 1.0]], "q": [-2.0, 0.0]}
PRIME = 2.0**61 - 1
HALF = Fraction(1) + Fraction(2) ** -45
KNOWN = [
    # A step would refuse them.
    ({"P": NEAR, "q": [-1.0, 0.0]}, [2.0**50 + 1, -(2.0**50)]),  # 2^50 [1 + 2^-50, -1]
    (
        {"P": np.eye(2), "q": [0.0, 0.0], "G": [[1.0, 0.0], [-1.0, 1e-12]], "h": [-1.0, -1.0]},
        floats([-1, -2 / Fraction(1e-12)]),
    ),
    # Convex where something can move is enough.
    (SADDLE | {"lb": [-5.0, 0.0], "ub": [5.0, 0.0]}, [1.0, 0.0]),
    (SADDLE | {"A": [[0.0, 1.0]], "b": [0.0], "lb": [-5, -5], "ub": [5, 5]}, [1.0, 0.0]),
    (SADDLE | {"A": [[1.0, -1.0]], "b": [0.0]}, [2 / 9, 2 / 9]),
    (SADDLE | {"A": np.eye(2), "b": [3.0, 4.0]}, [3.0, 4.0]),
    # A prime that divides a determinant costs another prime.
    *(
        ({"P": P, "q": [-1.0, 1.0], "A": [row, [0.0, PRIME]], "b": [0.0, 0.0]}, [0.0, 0.0])
        for P in ([[1087.0, 4.0], [4.0, 4242581433695849.0]], np.diag([PRIME, 1]))
        for row in ([1.0, 1.0], [PRIME, 1.0])
    ),
    # One variable, no rows, all fixed.
    *(
        ({"P": P, "q": -3 * one, "lb": one, "ub": one, "G": [0 * one], "h": [0.0]}, one.tolist())
        for one in (np.ones(1), np.ones(2))
        for P in (np.diag(one), 0 * np.diag(one))
    ),
    # The symmetric part of P counts, without rounding.
    (
        {"P": [[1.0, 1.0], [1.0 + 2.0**-44, 4.0]], "q": [-1.0, 0.0]},
        floats([4 / (4 - HALF**2), -HALF / (4 - HALF**2)]),
    ),
]
SEVERAL = [
    ({"P": PRIME * np.ones((2, 2)), "q": [1.0, 1.0]}, floats([-1 / (2 * Fraction(PRIME))] * 2)),
    *(({"P": np.zeros((n, n)), "q": [0.0] * n}, [0.0] * n) for n in (1, 2)),
]
"""The x of least norm."""


@pytest.mark.parametrize(
    ("program", "x", "unique"),
    [(*one, rows is KNOWN) for rows in (KNOWN, SEVERAL) for one in rows],
)
def test_programs_have_the_answers_by_hand(program, x, unique, tmp_path):
    answer = qr.exact_qp(**program)
    assert answer.x.tolist() == x
    assert answer.x_unique == unique
    both_take(answer, tmp_path)
    assert answer.digits(x) == 16
    assert not any(x) or answer.digits(np.multiply(x, 1 + 1e-7)) < 8


P, Q, G, H = np.eye(2), [-3.0, -1.0], [[1.0, 1.0]], [1.0]


def test_a_problem_has_all_arrays_and_bounds_may_be_none():
    answer = qr.exact_qp(P, Q, G, H)
    assert qr.exact_qp(P, Q, G, H, lb=[-np.inf, -np.inf]) == answer
    arrays = {"P": P, "q": Q, "G": G, "h": H, "A": None, "b": None, "lb": None, "ub": None}
    assert qr.exact_qp(SimpleNamespace(**arrays)) == answer


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"q": [0.0, np.nan]}, r"q\[1\]: must be a finite number \(got nan\)"),
        ({"h": [-np.inf]}, r"h\[0\]: .*, or inf for no limit: -inf is none at all"),
        ({"b": [np.inf], "A": G}, r"b\[0\]: must be a finite number"),
        ({"q": [1.0, 2.0, 3.0]}, "P: must be 3 x 3 numbers"),
        ({"G": [[1.0, 2.0, 3.0]]}, "G: must be 1 x 2 numbers"),
        ({"lb": [0.0]}, "lb: must be 2 numbers"),
        ({"ub": [-np.inf, 0.0]}, r"ub\[0\]: must be a finite number, or inf"),
        ({"P": np.triu(NEAR)}, r"P: is one triangle, the upper one; give P \+ P.T - np.diag"),
        ({"P": scipy.sparse.csc_array(np.tril(NEAR))}, "P: is one triangle, the lower one"),
        ({"P": [[1.0, 4.0], [-2.0, 1.0]]}, r"P\[0, 1\]: must be symmetric; P\[1, 0\] is -2"),
        ({"q": np.ma.masked_array([1.0, 2.0], [True, False])}, "q: is a masked array"),
        ({"q": ["0.1", "one"]}, "q: must be numbers"),
        ({"q": ["1/0", "1e9999"]}, "q: must be numbers"),
        ({"q": [10**400, 0]}, "q: is beyond the range of float64"),
        ({"q": [True, 0.5]}, "q: must be numbers"),
        ({"h": None}, "G and h are given together"),
        ({"P": "eye"}, "P: must be numbers"),
        ({"q": None}, "q: is missing"),
        ({"P": np.zeros((0, 0)), "q": [], "G": None, "h": None}, "q: must have an entry"),
        ({"initvals": [1.0]}, "initvals: must be 2 finite numbers"),
        ({"P": np.eye(2) * 1e-300, "q": [1e300, 0.0]}, "x of the optimum is beyond"),
    ],
)
def test_bad_input_gets_one_sentence(changes, sentence):
    with pytest.raises(qr.InputError, match=f"^{sentence}"):
        qr.exact_qp(**{"P": P, "q": Q, "G": G, "h": H} | changes)


@pytest.mark.parametrize(
    ("whole", "call"),
    [
        ("model.qps", r"load_qp reads it: exact_qp\(load_qp\(file\)\)"),
        (Path("model.qps"), r"load_qp reads it: exact_qp\(load_qp\(file\)\)"),
        (cp.Problem(cp.Minimize(cp.Variable())), r"problem.solve\(solver=Exact\(\)\)"),
    ],
)
def test_what_stands_for_a_program_elsewhere_is_refused_by_the_call_that_takes_it(whole, call):
    with pytest.raises(qr.InputError, match=f"^P: is .*{call}"):
        qr.exact_qp(whole)


def test_no_solution_names_the_rows_and_a_row_without_entries_says_what_it_asks_for():
    with pytest.raises(qr.QPInfeasible, match=r"G\[0\] asks for 0 <= -2.8e-17 \(proved"):
        qr.exact_qp(P, Q, [[0.0, 0.0]], [-2.8e-17])
    with pytest.raises(qr.QPInfeasible, match=r"A\[0\] asks for 0 = 1 \(proved"):
        qr.exact_qp(P, Q, A=[[0.0, 0.0]], b=[1.0])
    with pytest.raises(qr.QPInfeasible, match=r"G\[0\], lb\[0\] and lb\[1\] contradict each other"):
        qr.exact_qp(P, Q, G, H, lb=[0.5, 0.6])


@pytest.mark.parametrize("seed", range(40))
def test_a_guess_may_be_anything(seed):
    program = random_program(seed)
    rng = np.random.default_rng(seed)
    sizes = {"x": len(program["q"]), "z": len(program["h"]), "y": len(program["b"])}
    guess = SimpleNamespace(**{name: rng.normal(size=k) for name, k in sizes.items()})

    def said(initvals):
        answer = outcome(program, initvals=initvals)
        if isinstance(answer, qr.QPInfeasible):
            return bool(qr.verify(answer))
        return answer.x.tolist(), answer.obj, answer.multipliers_unique

    assert said(None) == said(guess) == said(guess.x)


def test_multipliers_of_two_rows_that_oppose_each_other_are_not_unique():
    answer = qr.exact_qp(P, [0.0, -1.0], [[1.0, 0.0], [-1.0, 0.0]], [0.0, 0.0])
    assert (answer.x.tolist(), answer.multipliers_unique) == ([0.0, 1.0], False)


def test_the_digits_of_an_x_and_of_multipliers():
    twice = {"G": np.array([[1.0, 1.0]] * 2), "h": [1.0, 1.0]}
    answer = qr.exact_qp(np.diag([1.0, 4.0]), [-3.0, -4.0], **twice)
    assert answer.x.tolist() == [0.6, 0.4]
    assert not answer.multipliers_unique
    longer = np.sqrt(3.0**2 + 4.0 * 1.0**2)  # the optimum without rows is [3, 1]
    assert answer.digits([0.6 + 1e-6, 0.4]) == pytest.approx(-np.log10(1e-6 / longer), abs=1e-6)
    assert answer.digits(SimpleNamespace(x=[0.6 + 1e-6, 0.4])) == answer.digits([0.6 + 1e-6, 0.4])
    assert answer.digits(answer) == 16
    assert answer.digits([7.0, 0.0]) == answer.digits([np.nan, 0.0]) == 0
    assert answer.digits_of_multipliers([1.2, 1.2]) > 15  # as any two whose sum is 2.4
    off = np.sqrt(1.0 + 1 / 4) * 1e-6
    of_sum = answer.digits_of_multipliers([2.4 + 1e-6, 0.0])
    assert of_sum == pytest.approx(-np.log10(off / longer), abs=1e-6)
    still = qr.exact_qp(P, [0.0, 0.0])
    assert (still.digits([0.0, 0.0]), still.digits([1e-9, 0.0])) == (16, 0)
    for x in ([1.0], SimpleNamespace(x=None)):
        with pytest.raises(qr.InputError, match=r"^x: must be "):
            answer.digits(x)
