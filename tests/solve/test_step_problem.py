"""``StepProblem.solve`` solves the problem as it stands, and loses nothing to metres."""

from dataclasses import replace
from functools import cache

import cvxpy as cp
import numpy as np
import pytest
from cvxpy.reductions.solvers.conic_solvers.clarabel_conif import CLARABEL

import quasistatic_ref as qr
from quasistatic_ref.lab.bench.scenes import boxes
from quasistatic_ref.solve import step_problem
from quasistatic_ref.solve.backends import installed_backends
from quasistatic_ref.solve.step_problem import problem_data
from quasistatic_ref.tolerances import UNMOVED
from tests.closeness import assert_relative, assert_same, assert_within
from tests.helpers import pinch, random_step, sphere_on_floor

WEIGHT = (0.3, 0.0, -2.943, 0.0, 0.0, 1e-3)
ABLE = [name for name in installed_backends() if ":" not in name and name != "highs"]
COSTLY = qr.Extra(("stop",), np.eye(7)[:1], [1e-4], H=np.eye(7), g=np.full(7, 1e-6))
STEPS = {
    "pinch": pinch,
    "ball": lambda: sphere_on_floor(wrench=WEIGHT),
    "four and six rows": lambda: random_step(0),
    "a user's row and cost": lambda: random_step(0).replace(extra=COSTLY),
    "facets": lambda: random_step(0).replace(cone="facets-8"),
    "nothing drives": sphere_on_floor,
    "nothing actuated": lambda: random_step(1, n_a=0),
    "all actuated": lambda: random_step(1, n_u=0),
    "no rows": lambda: random_step(1, rows=()),
}


@cache
def page_of(name):
    """A step, the page on which every solver solves it, and the exact solution."""
    step = STEPS[name]()
    return step, qr.StepProblem(step), qr.solve_step(step)


@pytest.mark.parametrize("name", STEPS)
@pytest.mark.parametrize("solver", ABLE)
def test_solve_is_right_in_si_units(name, solver):
    """Within 1e-7 of what the step moves, by every solver, in either case of letters."""
    called = solver.upper() if name == "ball" else solver
    step, page, exact = page_of(name)
    if (name, solver) == ("no rows", "scs"):
        with pytest.raises(qr.StepNotSolved, match="m must be a positive integer"):
            page.solve(solver)
        return
    size = np.abs(np.linalg.solve(step.H, qr.standard_form(step).g)).max() or UNMOVED
    found = page.solve(called)
    assert_within(found, exact.delta_q, 1e-6 * size)
    assert_same(page.primal(), found)
    lam = exact.lam
    assert page.dual().sum() == pytest.approx(lam.sum(), rel=1e-4, abs=1e-9)
    assert page.problem.status == cp.OPTIMAL
    form = qr.standard_form(step)
    least = exact.delta_q @ form.H @ exact.delta_q / 2 - form.g @ exact.delta_q
    load = np.abs(form.g).max() or size * form.H.max()
    assert page.problem.value == pytest.approx(least, rel=1e-6, abs=1e-6 * size * load)


def test_the_ellipsoid_is_solved_with_its_multipliers():
    """Second-order cones cost Clarabel digits; lam balances the load: H delta_q - g = A'lam."""
    step = random_step(3).replace(cone="ellipsoid")
    page = qr.StepProblem(step)
    exact = qr.solve_step(step)
    size = np.abs(exact.delta_q).max()
    for solver in ("clarabel", "scs"):
        assert_within(page.solve(solver), exact.delta_q, 1e-6 * size)
        form = qr.standard_form(step)
        load = form.H @ page.primal() - form.g
        assert_within(form.A.T @ page.dual(), load, 1e-6 * np.abs(load).max())
    with pytest.raises(qr.BackendError, match="accepts only linear rows"):
        page.solve("piqp")


@pytest.mark.parametrize("solver", [name for name in ABLE if name != "proxqp"])  # test_known_issues
@pytest.mark.parametrize("lift", [1e-3, 1e-5, -1.0])
def test_a_row_that_is_added_holds_and_has_its_multiplier(solver, lift):
    """A ball of weight W is lifted by z: lam h = H_zz z / h + W if z > 0; a far row has none."""
    step = sphere_on_floor(wrench=(0.0, 0.0, -2.943, 0.0, 0.0, 0.0))
    page = qr.StepProblem(step)
    row = page.delta_q[2] >= lift
    page.problem = cp.Problem(page.problem.objective, [*page.problem.constraints, row])
    z = page.solve(solver)[2]
    assert page.problem.status == cp.OPTIMAL
    assert z == pytest.approx(max(lift, 0.0), rel=1e-6, abs=1e-12)
    impulse = step.H[2, 2] * lift + step.h * 2.943 if lift > 0 else 0.0
    assert row.dual_value == pytest.approx(impulse, rel=1e-6, abs=1e-9)


def test_a_curved_constraint_a_cost_and_a_variable_of_a_user_are_obeyed():
    """1 N s pulls the ball along x, no farther than 2 mm, whatever is added to its cost."""
    step = sphere_on_floor(wrench=(0.0, 0.0, -2.943, 0.0, 0.0, 0.0))

    def additions(page):
        square = cp.Variable()
        pull = -1.0 * page.delta_q[0]
        return [
            cp.norm(page.delta_q[:2]) <= 2e-3,
            square >= cp.square(page.delta_q[0]),
            square,
            pull,
        ]

    page = qr.StepProblem(step, additions)
    assert_within(page.solve()[:2], [2e-3, 0.0], 1e-9)
    assert_relative(page.problem.value, page.problem.objective.value)


def test_what_has_no_solution_and_data_that_are_not_known_are_said_in_a_sentence(monkeypatch):
    page = qr.StepProblem(pinch())
    walls = [page.delta_q[0] >= 1e-3, page.delta_q[0] <= -1e-3]
    whole = page.problem
    page.problem = cp.Problem(whole.objective, [*whole.constraints, *walls])
    with pytest.raises(qr.StepNotSolved, match="infeasible"):
        page.solve()
    assert page.problem.status == cp.INFEASIBLE
    page.problem = cp.Problem(whole.objective, [*whole.constraints, cp.diag(page.delta_q[:2]) >> 0])
    assert (page.solve()[:2] >= -1e-12).all()

    def another_form(*arguments):
        data = problem_data(*arguments)
        return replace(data, numbers={**data.numbers, "h": data.numbers["b"]})

    monkeypatch.setattr(step_problem, "problem_data", another_form)
    with pytest.raises(qr.BackendError, match="takes data of a form that is not known here"):
        page.solve()


def test_a_solver_without_multipliers_is_said_to_have_none(monkeypatch):
    """As CVXPY's interface to SCIP does: it gives None in their place, and unknowns of its own."""
    inverted = CLARABEL.invert

    def without(self, *data):
        solution = inverted(self, *data)
        solution.dual_vars = None
        solution.primal_vars = {key: np.zeros(15) for key in solution.primal_vars}
        return solution

    monkeypatch.setattr(CLARABEL, "invert", without)
    with pytest.raises(qr.BackendError, match="gives no multipliers through CVXPY; choose cl"):
        qr.StepProblem(pinch()).solve()


def test_a_page_of_more_than_a_thousand_numbers_is_solved_in_cvxpy_s_own_way():
    """From there on CVXPY chooses another way to compile by itself, which fails at ``multiply``."""
    scene = boxes(3)
    step = scene.simulator("off", True).step(scene.q, np.zeros(0), scene.force).step
    page = qr.StepProblem(step)
    assert sum(parameter.size for parameter in page.parameters.values()) >= 1000
    page.problem.solve(solver="CLARABEL")
    assert page.problem.status == cp.OPTIMAL


def test_a_solver_that_cvxpy_does_not_call_and_whole_numbers_are_refused():
    page = qr.StepProblem(pinch())
    with pytest.raises(qr.BackendError, match="is not a backend"):
        page.solve("clarabell")
    with pytest.raises(qr.BackendError, match="is not called through CVXPY"):
        page.solve("none")
    switch = cp.Variable(boolean=True)
    page.problem = cp.Problem(page.problem.objective, [switch <= page.delta_q[0]])
    with pytest.raises(qr.InputError, match="unknowns that are whole numbers"):
        page.solve("highs")


@pytest.mark.extra("study")
def test_multipliers_of_a_solve_that_gave_none_are_not_those_of_the_solve_before():
    """HiGHS gives none where an unknown is a whole number; CVXPY keeps the earlier ones."""
    page = qr.StepProblem(pinch())
    assert page.dual() is None
    page.solve()
    assert page.dual().any()
    switch = cp.Variable(boolean=True)
    linear = cp.Minimize(cp.sum(page.delta_q_a) + switch)
    bounded = [page.delta_q_a <= 1.0, page.delta_q_a >= -1.0]
    page.problem = cp.Problem(linear, [*page.problem.constraints, *bounded])
    page.problem.solve(solver="HIGHS")
    assert page.contact_rows[0].dual_value is not None
    assert page.dual() is None


def test_a_solver_that_cvxpy_knows_and_that_is_not_here_is_said_to_be_missing():
    with pytest.raises(qr.BackendError, match=r"is not installed; .*\(got .mosek"):
        qr.solve_step(pinch(), "mosek")
