"""What a solver returns through each door, and what its row says of it."""

import importlib
from types import SimpleNamespace

import numpy as np
import pytest

from quasistatic_ref import InputError
from quasistatic_ref.solve.backends import BACKENDS
from quasistatic_ref.step.standard_form import Units
from tests.lab.study import broken
from tests.lab.study.asked import Limits, Program, Solver, call_of, function_solver, study

RETURNED = {
    "honest": ("solved", True, "optimal"),
    "spoils": ("solved", True, "optimal"),
    "zeros": ("solved", False, "optimal"),
    "too_long": ("solved", False, "optimal"),
    "no_numbers": ("solved", False, "optimal"),
    "pair": ("other", False, "returned a tuple in place of (x, z, status)"),
    "nan": ("solved", False, "optimal"),
    "gives_up": ("other", False, "too many sweeps"),
    "denies": ("infeasible", False, "infeasible"),
    "raises": ("other", False, "RuntimeError: no licence at all"),
}


@pytest.mark.usefixtures("in_this_process")
def test_the_answer_of_a_function_is_judged_as_it_is(tmp_path, three):
    functions = [function_solver(getattr(broken, name), options={"high": {}}) for name in RETURNED]
    limits = Limits(repetitions=1)
    rows = study(three[:1], functions, ["high"], folder=tmp_path, limits=limits)
    said = {row.solver: (row.says, row.reached, row.status) for row in rows}
    assert said == RETURNED
    with_digits = {row.solver for row in rows if row.digits is not None}
    assert with_digits == {"honest", "spoils", "zeros"}


def test_a_function_whose_module_is_not_there_is_one_sentence(tmp_path, monkeypatch, three):
    module = tmp_path / "fleeting_solver.py"
    module.write_text("def solve(P, q, G, h):\n    return None, None, 'infeasible'\n")
    monkeypatch.syspath_prepend(str(tmp_path))
    function = importlib.import_module("fleeting_solver").solve
    module.unlink()
    with pytest.raises(InputError, match="solve: cannot be imported: ModuleNotFoundError: No mod"):
        study(three, [function], folder=tmp_path / "store")


@pytest.mark.usefixtures("in_this_process")
def test_an_option_that_a_solver_refuses_is_its_row(tmp_path, three):
    clarabel = Solver("c", "qpsolvers", "clarabel", {"default": {"tol_feasibility": 1.0}})
    (row,) = study(three[:1], [clarabel], folder=tmp_path, limits=Limits(repetitions=1))
    assert row.says == "other"
    assert "tol_feasibility" in row.status


def test_a_cold_start_through_cvxpy_knows_nothing_of_the_reply_before():
    program = Program(np.array([[3.0, 1.0], [1.0, 2.0]]), np.array([0.0, 4.0]), np.eye(2),
                      np.array([1.0, -9.0]))  # fmt: skip
    call = call_of(Solver("osqp", "cvxpy", "osqp"))
    options = BACKENDS["osqp"].attempts(1e-10)[0][1]
    first, again = (call(program, options) for _ in range(2))
    assert first.iterations == again.iterations > 1


X = np.array([0.75, 0.25])
"""The point of x_1 + x_2 = 1, x_1 >= 0.75 that is nearest to the origin."""
NEAREST = SimpleNamespace(
    id="nearest",
    family="mine",
    dial=None,
    feasible=True,
    program=Program(np.eye(2), np.zeros(2), np.array([[1.0, 1], [1, 0]]), np.array([1, 0.75]), 1),
    units=Units(np.array([0.5, 2.0]), 4.0, 0.25),
    digits=lambda x: -np.log10(abs(x - X).max() + 1e-16),
)


def by_substitution(P, q, G, h, A, b):
    """It knows where x_2 = 1 - x_1."""
    assert [part.tolist() for part in (A, b, G, h)] == [[[1, 1]], [1], [[-1, 0]], [-0.75]]
    return X, np.array([0.5]), np.array([-0.25]), "optimal"


@pytest.mark.usefixtures("in_this_process")
@pytest.mark.parametrize("units", ["raw", "natural"])
def test_a_problem_of_others_with_an_equation_goes_through_each_door(tmp_path, units):
    """Residuals see the signs of multipliers, of which an equation's may be any."""
    mine = function_solver(by_substitution, options={"tuned": {}})
    solvers = ["qpsolvers:daqp", "cvxpy:clarabel", *([mine] if units == "raw" else [])]
    for row in study([NEAREST], solvers, ["tuned"], tmp_path, units=[units]):
        assert (row.family, row.dial, row.n, row.m, row.says) == ("mine", None, 2, 2, "solved")
        assert max(row.primal, row.dual, row.gap) < 1e-8
        assert row.digits > 7
