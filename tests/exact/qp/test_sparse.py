"""Sparse programs by HiGHS's basis against another method in fractions, and by substitution."""

import cvxpy as cp
import numpy as np
import pytest
from flint import fmpz

import quasistatic_ref as qr
from quasistatic_ref.exact.qp import basis, guess, search, sparse
from tests.oracles.program_truth import refutation
from tests.oracles.random_programs import sparse_program

PARTS = range(25)
IN_PART = 20
SHORT = [k if k < 3 else pytest.param(k, marks=pytest.mark.long) for k in PARTS]


def answer_of(program):
    """The optimum of a program, or the proof that there is none."""
    try:
        return qr.exact_qp(**program)
    except (qr.QPInfeasible, qr.QPUnbounded) as proof:
        return proof


@pytest.mark.shared
@pytest.mark.parametrize("part", SHORT)
def test_500_sparse_programs_have_the_answers_of_another_method(part, monkeypatch):
    monkeypatch.setattr(guess, "MANY_VARIABLES", 1)
    for seed in range(IN_PART * part, IN_PART * (part + 1)):
        program = sparse_program(seed, most=12 if part < 3 else 40)
        answer = answer_of(program)
        optimal = isinstance(answer, qr.ExactQP)
        assert refutation(answer if optimal else None, program) is None, seed
        verdict = qr.verify(answer)
        assert verdict, (seed, verdict.reason)


def test_the_basis_is_enough_for_linear_programs_that_have_an_optimum(monkeypatch):
    unknown = cp.Variable()
    cp.Problem(cp.Minimize(unknown), [unknown >= 1]).solve(solver="HIGHS")  # by many threads
    programs = [program for program in map(sparse_program, range(80)) if not program["P"].any()]
    optimal = [program for program in programs if isinstance(answer_of(program), qr.ExactQP)]
    assert len(optimal) > 40
    monkeypatch.setattr(guess, "MANY_VARIABLES", 1)
    monkeypatch.setattr(guess, "guesses", lambda scaled: iter(()))
    monkeypatch.setattr(
        search, "_searched", lambda *_: pytest.fail("it does not prove the optimum")
    )
    for program in optimal:
        assert isinstance(qr.exact_qp(**program), qr.ExactQP)


def test_an_equation_outside_of_a_basis_takes_the_place_of_what_is_zero_first():
    """Of a = 2 r0 - r1 with y = (4, 1): y_a = 2 makes r0 zero, y_a = -1 makes r1 zero, first."""
    stay = basis.with_equations(np.array([4.0, 1.0]), np.array([[2.0], [-1.0]]))
    assert stay.tolist() == [True, False]


def test_a_sparse_solution_satisfies_its_system():
    """Rows and columns with one entry around a full nucleus; whole numbers, nothing rounded."""
    rng = np.random.default_rng(0)
    n = 12
    square = np.zeros((n, n), dtype=int)
    square[4:8, 4:8] = rng.integers(-9, 10, (4, 4)) + 20 * np.eye(4, dtype=int)
    square[:4, :4] = np.tril(rng.integers(1, 9, (4, 4)))  # from rows of one entry on
    square[4:8, :4] = rng.integers(-9, 10, (4, 4))
    square[8:, 8:] = np.triu(rng.integers(1, 9, (4, 4)))
    square[8:, :8] = rng.integers(-9, 10, (4, 8))  # columns of one entry
    order, other = rng.permutation(n), rng.permutation(n)
    square = square[np.ix_(order, other)]
    lines = [{j: fmpz(int(v)) for j, v in enumerate(row) if v} for row in square]
    side = [fmpz(int(v)) for v in rng.integers(-9, 10, n)]
    (x,), d = sparse.solution(lines, range(n), [side])
    assert len(sparse.peeled(lines, range(n)).rows) == 4
    assert [sum(v * x[j] for j, v in line.items()) for line in lines] == [v * d for v in side]


def test_a_singular_sparse_system_has_no_solution():
    lines = [{0: fmpz(1)}, {0: fmpz(2)}]
    with pytest.raises(ZeroDivisionError):
        sparse.solution(lines, range(2), [[fmpz(1), fmpz(2)]])
