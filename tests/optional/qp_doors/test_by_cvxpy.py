"""The exact solver in CVXPY: values, multipliers, statuses and proofs, in code that calls CVXPY."""

from fractions import Fraction

import cvxpy as cp
import numpy as np
import pytest

import quasistatic_ref as qr
from tests.helpers import random_step
from tests.processes import printed_text

NEAREST = 1e-14
"""Of a page's answer, from the exact one, in its largest entry [-]."""


def two():
    return cp.Variable(2, "x")


def least_squares(x):
    """In every coordinate 2 (x - [1, 2]) + y = 0, and sum(x) = 0: y = 3, x = [-1/2, 1/2]."""
    return cp.Minimize(cp.sum_squares(x - np.array([1.0, 2.0]))), [cp.sum(x) == 0], [3.0]


def maximised(x):
    """At the bound 1/4 z_0 = 2 (1 - x_0), and x_1 is free: x = [1/4, 1]."""
    return cp.Maximize(2 * cp.sum(x) - cp.sum_squares(x)), [x <= 0.25 + np.eye(2)[1]], [[1.5, 0.0]]


def linear(x):
    """All of the total in the cheaper one: costs 1 and 3, z = [0, 3 - 1], y = -1."""
    return cp.Minimize(x[0] + 3 * x[1]), [cp.sum(x) == 2, x >= 0], [-1.0, [0.0, 2.0]]


def absolute(x):
    """The slope of |x_0 - 3| at the bound 1 is -1."""
    return cp.Minimize(cp.abs(x[0] - 3) + 2 * cp.abs(x[1])), [x[0] <= 1], [1.0]


OPTIMA = {
    least_squares: ([-0.5, 0.5], 4.5),
    maximised: ([0.25, 1.0], 0.5 - 0.0625 + 1.0),
    linear: ([2.0, 0.0], 2.0),
    absolute: ([1.0, 0.0], 2.0),
}


@pytest.mark.parametrize("posed", OPTIMA, ids=lambda posed: posed.__name__)
def test_values_and_multipliers_are_the_nearest_numbers_and_the_answer_is_proved(posed):
    x = two()
    objective, constraints, multipliers = posed(x)
    problem = cp.Problem(objective, constraints)
    at, value = OPTIMA[posed]
    assert problem.solve(solver=qr.Exact()) == problem.value == value
    assert problem.status == cp.OPTIMAL
    assert x.value.tolist() == at
    assert [np.asarray(one.dual_value).tolist() for one in constraints] == multipliers
    statistics = problem.solver_stats
    assert (statistics.solver_name, statistics.solve_time > 0) == ("EXACT", True)
    assert isinstance(statistics.extra_stats, qr.ExactQP)
    assert qr.verify(statistics.extra_stats)


def test_a_constant_of_the_objective_is_in_the_objective_of_the_answer():
    """The least of 3 x^2 - 2 x is -1/3; with the nearest number of 1/3 a sum in float64 is zero."""
    x = cp.Variable()
    problem = cp.Problem(cp.Minimize(3 * cp.square(x) - 2 * x + 1 / 3))
    problem.solve(solver=qr.Exact())
    rounded = Fraction(1 / 3) - Fraction(1, 3)
    assert problem.solver_stats.extra_stats.obj == float(rounded) != 0


def test_where_there_is_no_optimum_the_status_says_so_and_the_proof_is_handed_on():
    x = two()
    apart = [x[0] >= 2, x[0] <= 1]
    for objective, rows, status, value, kind in (
        (cp.Minimize(cp.sum_squares(x)), apart, cp.INFEASIBLE, np.inf, qr.QPInfeasible),
        (cp.Maximize(cp.sum(x)), apart, cp.INFEASIBLE, -np.inf, qr.QPInfeasible),
        (cp.Minimize(x[1]), apart[:1], cp.UNBOUNDED, -np.inf, qr.QPUnbounded),
        (cp.Maximize(x[1]), apart[:1], cp.UNBOUNDED, np.inf, qr.QPUnbounded),
    ):
        problem = cp.Problem(objective, rows)
        assert (problem.solve(solver=qr.Exact()), problem.status) == (value, status)
        proof = problem.solver_stats.extra_stats
        assert isinstance(proof, kind)
        assert qr.verify(proof)
        assert x.value is None
    problem = cp.Problem(cp.Minimize(0), apart)
    problem.solve(solver=qr.Exact())
    assert [row.dual_value for row in apart] == [1.0, 1.0]  # the factors of the rows


def test_a_problem_with_parameters_is_solved_anew_with_each_value():
    x = two()
    least = cp.Parameter()
    problem = cp.Problem(cp.Minimize(cp.sum_squares(x)), [x >= least])
    for value in (1.0, -3.0, 0.1):
        least.value = value
        problem.solve(solver=qr.Exact())
        assert x.value.tolist() == [max(value, 0.0)] * 2


F = np.array([[0.4, 0.7, 0.6], [0.0, 0.7, 0.8]])


def test_a_cost_that_rounding_has_bent_is_refused_and_its_remedy_is_one():
    x = cp.Variable(3)
    bent = cp.quad_form(x, F.T @ F)
    with pytest.raises(qr.QPNotConvex, match=r"sum_squares\(F @ x\)") as caught:
        cp.Problem(cp.Minimize(bent)).solve(solver=qr.Exact())
    assert qr.verify(caught.value)
    assert cp.Problem(cp.Minimize(cp.sum_squares(F @ x))).solve(solver=qr.Exact()) == 0


@pytest.mark.parametrize(
    ("problem", "options", "says"),
    [
        (lambda x: cp.Problem(cp.Minimize(cp.norm(x))), {}, "cannot solve this problem"),
        (lambda x: cp.Problem(cp.Minimize(cp.Variable(integer=True))), {}, "not MIP-capable"),
        (lambda x: cp.Problem(cp.Minimize(cp.sum_squares(x))), {"eps": 1}, "eps: is no option"),
    ],
    ids=["a cone", "a whole number", "an option"],
)
def test_what_it_cannot_take_is_refused(problem, options, says):
    with pytest.raises((cp.error.SolverError, qr.InputError), match=says):
        problem(two()).solve(solver=qr.Exact(), **options)


def lifted(of):
    """A row and a cost of a user's: for a page, or for an extension of a step."""
    return [of.delta_q[0] >= 1e-3, 0.3 * cp.sum_squares(of.delta_q - 2e-3)]


@pytest.mark.parametrize("additions", [None, lifted], ids=["the paper's page", "with own terms"])
@pytest.mark.parametrize("seed", [0, 1, None])
def test_a_page_has_the_answer_of_the_step(additions, seed):
    if seed is None:
        step = qr.load_scenario("bunny_grasp", steps=1).run(progress=False).step_data(0)
    else:
        step = random_step(seed)
    page = qr.StepProblem(step, additions)
    page.problem.solve(solver=qr.Exact())
    extension = None if additions is None else qr.Extension(lifted)
    exact = qr.solve_step(step, extension=extension).delta_q
    assert abs(page.primal() - exact).max() <= NEAREST * abs(exact).max()


OF_A_STRANGER = (
    "import cvxpy as cp",
    "x = cp.Variable(2)",
    "problem = cp.Problem(cp.Minimize(cp.sum_squares(x)), [x[0] + 3 * x[1] == 1])",
    "import quasistatic_ref as qr",
    "problem.solve(solver=qr.Exact())",
    "print(x.value.tolist())",
)


def test_code_of_a_stranger_needs_two_lines():
    assert printed_text(*OF_A_STRANGER) == "[0.1, 0.3]"


def test_multipliers_of_matrices_and_of_variables_with_attributes_are_those_of_clarabel():
    X = cp.Variable((3, 2))
    within = cp.Variable(2, bounds=[-0.3, 0.4])
    above = cp.Variable(nonneg=True)
    twice = cp.Variable((2, 2), symmetric=True)
    rows = [X >= -0.1, X <= 0.4, cp.sum(X, axis=0) == [0.4, 0.35]]
    rows += [cp.sum(within) + above == 1.0, twice[0, 1] >= 0.2, cp.abs(twice) <= 0.3]
    target = np.array([[1.0, -2.0], [3.0, 0.5], [-1.0, 2.0]])
    costs = [X - target, within - 1, above, twice - np.diag([1.0, -2.0])]
    problem = cp.Problem(cp.Minimize(cp.norm1(X) + sum(map(cp.sum_squares, costs))), rows)
    dual_values = []
    for solver in (cp.CLARABEL, qr.Exact()):
        problem.solve(solver=solver)
        assert problem.status == cp.OPTIMAL
        dual_values.append([np.asarray(row.dual_value) for row in rows])
    for theirs, ours in zip(*dual_values, strict=True):
        np.testing.assert_allclose(ours, theirs, rtol=0, atol=1e-5)
        assert ours.any()
