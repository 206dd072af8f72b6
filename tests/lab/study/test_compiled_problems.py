"""Quadratic programs through CVXPY and qpsolvers, as studies ask: start, times, status."""

from types import SimpleNamespace

import numpy as np
import pytest

from quasistatic_ref.lab.study.compiled_problems import CompiledProblems
from quasistatic_ref.optional.qpsolvers.through_qpsolvers import _account, _status
from quasistatic_ref.solve.backends import BACKENDS
from quasistatic_ref.step.standard_form import StandardForm

FORM = StandardForm(
    np.array([[3.0, 1.0], [1.0, 2.0]]), np.array([0.0, 4.0]), np.eye(2), np.array([1.0, -9.0])
)


def test_a_cold_start_through_cvxpy_knows_nothing_of_the_reply_before():
    programs = CompiledProblems("osqp")
    options = BACKENDS["osqp"].first(1e-10)
    first, warm, cold = (programs.reply(FORM, options, warm=w) for w in (False, True, False))
    assert cold.iterations == first.iterations > warm.iterations


def solver_reply(**extras):
    """What qpsolvers returns of a solver."""
    return SimpleNamespace(extras=extras, found=True)


class Microseconds:
    """Times of ProxQP."""

    __module__ = "proxsuite.proxqp"
    solve_time = 5.0
    setup_time = 0.0


@pytest.mark.parametrize(
    ("solution", "seconds"),
    [
        (solver_reply(solve_time=4.0, setup_time=2.0), (4e-3, 2e-3)),  # SCS: ms
        (solver_reply(info=Microseconds()), (5e-6, None)),  # zero: not measured
        (solver_reply(info=SimpleNamespace(solve_time=0.5)), (0.5, None)),
        (solver_reply(), (None, None)),
    ],
)
def test_times_that_solvers_report_are_in_seconds(solution, seconds):
    assert _account(solution) == pytest.approx(seconds)


@pytest.mark.parametrize(
    ("solution", "expected"),
    [
        (solver_reply(iterations=np.array([3, 1])), ("found", 3)),  # quadprog: added, dropped
        (solver_reply(status="SolverStatus.Solved", iter=7), ("Solved", 7)),
        (solver_reply(info=SimpleNamespace(status="solved", iter=25)), ("solved", 25)),
        (SimpleNamespace(extras=None, found=False), ("not found", None)),
    ],
)
def test_the_word_and_the_iterations_of_a_solver(solution, expected):
    assert _status(solution) == expected
