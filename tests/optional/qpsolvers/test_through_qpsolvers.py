"""What qpsolvers' solution says of times, of the solver's own word, and of iterations."""

from types import SimpleNamespace

import numpy as np
import pytest

from quasistatic_ref.optional.qpsolvers.through_qpsolvers import _account, _status


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
