"""The page solves itself; ``StepProblem.solve`` in natural units, whatever its numbers are."""

import copy
import pickle
from functools import cache
from itertools import product

import cvxpy as cp
import numpy as np
import pytest

import quasistatic_ref as qr
from quasistatic_ref.tolerances import UNMOVED
from tests.closeness import assert_same, assert_within
from tests.helpers import REQUIRED, boxes_step, changed, pinch, random_step, sphere_on_floor
from tests.made import no_contacts
from tests.solvers import installed_backends

WEIGHT = -2.943 * np.eye(6)[2]
ABLE = [name for name in installed_backends() if ":" not in name and name != "highs"]
COSTLY = qr.Extra(("stop",), np.eye(7)[:1], [1e-4], H=np.eye(7), g=np.full(7, 1e-6))
STEPS = {
    "pinch": pinch,
    "ball": lambda: sphere_on_floor(wrench=(0.3, 0.0, -2.943, 0.0, 0.0, 1e-3)),
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
    assert page.dual().sum() == pytest.approx(exact.lam.sum(), rel=1e-4, abs=1e-9)
    assert page.problem.status == cp.OPTIMAL
    form = qr.standard_form(step)
    least = exact.delta_q @ form.H @ exact.delta_q / 2 - form.g @ exact.delta_q
    load = np.abs(form.g).max() or size * form.H.max()
    for value in (page.problem.value, page.problem.solution.opt_val):
        assert value * step.h**3 == pytest.approx(least, rel=1e-6, abs=1e-6 * size * load)


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


HAVE_FRICTION = ((0, 0, 0), (1, 0, 1), (1, 1, 1))
BY_CONE = [
    *product(("pyramid", "product", "facets-8", "frictionless"), REQUIRED),
    *product(["ellipsoid"], ("clarabel", "scs")),
]


@pytest.mark.shared
@pytest.mark.parametrize(("cone", "solver"), BY_CONE)
def test_contacts_without_friction_are_solved(cone, solver):
    """mu_v and mu_omega are zero in all contacts, in some, in none; H delta_q - g = A'lam."""
    for rows in ((6,), (6, 6), (6, 4, 6)):
        step = random_step(len(rows), n_a=1, n_u=3, rows=rows)
        form = qr.standard_form(step)
        size = np.abs(np.linalg.solve(form.H, form.g)).max()
        having = {has[: len(rows)] for has in HAVE_FRICTION}
        for slides, spins in product(having, repeat=2):
            mu_v = step.contacts.mu_v * slides
            mu_omega = step.contacts.mu_omega * spins
            contacts = changed(step.contacts, mu_v=mu_v, mu_omega=mu_omega)
            posed = step.replace(contacts=contacts, cone=cone)
            page = qr.StepProblem(posed)
            assert_within(page.solve(solver), qr.solve_step(posed).delta_q, 1e-6 * size)
            load = form.H @ page.primal() - form.g
            forces = qr.standard_form(posed).A.T @ page.dual()
            assert_within(forces, load, 1e-6 * np.abs(form.g).max())


@pytest.mark.parametrize("solver", [name for name in ABLE if name != "proxqp"])  # test_known_issues
@pytest.mark.parametrize("lift", [1e-3, 1e-5, -1.0])
def test_a_row_that_is_added_holds_and_its_multiplier_is_a_force(solver, lift):
    """A ball of weight W is lifted by z: a force of M z / h^2 + W if z > 0; a far row has none."""
    step = sphere_on_floor(wrench=WEIGHT)
    force = step.M_u[2, 2] * lift / step.h**2 + 2.943 if lift > 0 else 0.0
    page = qr.StepProblem(step, lambda page: [page.delta_q[2] >= lift])
    z = page.solve(solver)[2]
    assert page.problem.status == cp.OPTIMAL
    assert z == pytest.approx(max(lift, 0.0), rel=1e-6, abs=1e-9)
    assert page.problem.constraints[-1].dual_value == pytest.approx(force, rel=1e-6, abs=1e-6)
    bare = qr.StepProblem(step)
    row = bare.row(bare.delta_q[2] - lift)
    lifted = cp.Problem(bare.problem.objective, [*bare.problem.constraints, row])
    lifted.solve(solver="CLARABEL")
    assert_within(bare.delta_q.value[2], max(lift, 0.0), 1e-9)
    assert row.dual_value == pytest.approx(force, rel=1e-6, abs=1e-6)
    bare.problem = lifted
    with pytest.raises(qr.InputError, match="is another problem than that of this step"):
        bare.solve(solver)


KINDS = {
    "a norm": lambda x: cp.norm(x) <= 2e-3,
    "a row": lambda x: x[0] <= 2e-3,
    "an equation": lambda x: x[0] == 2e-3,
    "a second-order cone": lambda x: cp.SOC(cp.Constant(2e-3), x),
    "an entry >= 0": lambda x: cp.constraints.NonNeg(2e-3 - x[0]),
    "a semidefinite matrix": lambda x: cp.diag(2e-3 - x) >> 0,
    "an exponential cone": lambda x: cp.constraints.ExpCone(
        x[0], cp.Constant(2e-3), cp.Constant(2e-3 * np.e)
    ),
}


@pytest.mark.parametrize("kind", [None, *KINDS])
def test_rows_and_costs_of_a_user_are_in_metres_and_newton_metre_seconds(kind):
    """A spring draws a free ball to 5 mm; alone by k / (k + m / h^2) of it, else at most 2 mm.

    Its cost is h times its energy.
    """
    step = sphere_on_floor(wrench=WEIGHT).replace(cone="frictionless")
    k = 1e4

    def additions(page):
        spring = step.h * k / 2 * cp.square(page.delta_q[0] - 5e-3)
        return [spring] if kind is None else [spring, KINDS[kind](page.delta_q[:2])]

    page = qr.StepProblem(step, additions)
    expected = 5e-3 * k / (k + step.M_u[0, 0] / step.h**2) if kind is None else 2e-3
    assert_within(page.solve()[0], expected, 1e-8)
    assert_within(page.problem.value, page.problem.objective.value, 1e-9)


def test_a_page_without_a_solution_is_said_in_a_sentence():
    page = qr.StepProblem(pinch(), lambda page: [page.delta_q[0] >= 1e-3, page.delta_q[0] <= -1e-3])
    with pytest.raises(qr.StepNotSolved, match="infeasible"):
        page.solve()
    assert page.problem.status == cp.INFEASIBLE


def test_a_page_of_more_than_a_thousand_numbers_is_solved_in_cvxpy_s_own_way():
    """From there on CVXPY chooses another way to compile by itself, which fails at ``multiply``."""
    page = qr.StepProblem(boxes_step(3))
    assert sum(parameter.size for parameter in page.parameters.values()) >= 1000
    page.problem.solve(solver="CLARABEL")
    assert page.problem.status == cp.OPTIMAL


@pytest.mark.parametrize(
    ("solver", "says"),
    [
        ("clarabell", "is not a backend"),
        ("none", "is not called through CVXPY"),
        ("mosek", r"is not installed; .*\(got .mosek"),
    ],
)
def test_a_solver_that_cvxpy_does_not_call_is_refused(solver, says):
    with pytest.raises(qr.BackendError, match=says):
        qr.StepProblem(pinch()).solve(solver)


COPIES = {"pickle": lambda page: pickle.loads(pickle.dumps(page)), "deep copy": copy.deepcopy}
PAGES = {
    "four and six rows": lambda: qr.StepProblem(random_step(0)),
    "a user's row and cost": lambda: qr.StepProblem(STEPS["a user's row and cost"]()),
    "facets": lambda: qr.StepProblem(STEPS["facets"]()),
    "the ellipsoid": lambda: qr.StepProblem(random_step(3).replace(cone="ellipsoid")),
    "additions": lambda: qr.StepProblem(random_step(0), lambda page: [page.delta_q[0] >= 1e-3]),
}


@pytest.mark.shared
@pytest.mark.parametrize("how", COPIES.values(), ids=COPIES)
@pytest.mark.parametrize("kind", PAGES)
def test_a_solved_page_is_copied_with_its_solution(kind, how):
    page = PAGES[kind]()
    able = ("clarabel", "scs") if kind == "the ellipsoid" else ABLE
    for solver in able:
        found = page.solve(solver)
        other = how(page)
        assert_same(other.primal(), found)
        assert_same(other.dual(), page.dual())
        assert other.problem.status == cp.OPTIMAL
        assert other.problem.value == page.problem.value
        assert_within(other.solve(solver), found, 1e-6 * np.abs(found).max())
    other.fill(page.step.replace(tau_u=2 * page.step.tau_u))
    other.solve(able[0])
    assert not np.array_equal(other.primal(), found)
    assert_same(page.primal(), found)


def test_a_page_whose_problem_was_replaced_or_whose_additions_are_lost_has_no_deep_copy():
    page = PAGES["additions"]()
    with pytest.raises(qr.InputError, match="does not hold the function of its additions"):
        copy.deepcopy(COPIES["pickle"](page))
    page.problem = cp.Problem(page.problem.objective)
    with pytest.raises(qr.InputError, match="is another problem than that of this step"):
        copy.deepcopy(page)


def test_a_page_and_its_deep_copy_are_two_parts_of_one_problem():
    one = qr.StepProblem(pinch())
    one.solve()
    two = copy.deepcopy(one)
    two.fill(one.step.replace(tau_u=2 * one.step.tau_u))
    pages = one.page.problem, two.page.problem
    objective = pages[0].objective + pages[1].objective
    both = cp.Problem(objective, pages[0].constraints + pages[1].constraints)
    both.solve(solver="CLARABEL")
    for page in (one, two):
        assert_within(page.primal(), qr.solve_step(page.step).delta_q, 1e-9)


EQUATIONS = {
    "z at least": (lambda z: z >= -2e-4, 1, -2e-4),
    "z at most": (lambda z: z <= -3e-3, -1, -3e-3),
    "z == 1 mm": (lambda z: z == 1e-3, -1, 1e-3),
    "1 mm == z": (lambda z: cp.Constant(1e-3) == z, 1, 1e-3),
    "-z == -1 mm": (lambda z: -z == -1e-3, 1, 1e-3),
    "3 z == 3 mm": (lambda z: 3 * z == 3e-3, -1 / 3, 1e-3),
}
"""A row of a falling body's z, its dual value per force along z, and where z ends [m]."""


@pytest.mark.parametrize(("row", "sign", "z"), EQUATIONS.values(), ids=EQUATIONS)
def test_the_multiplier_of_an_equation_is_minus_the_force_along_its_left_side(row, sign, z):
    """What holds a body of mass M and weight W at z bears W + M z / h^2."""
    step = sphere_on_floor(wrench=WEIGHT).replace(cone="frictionless")
    page = qr.StepProblem(step.replace(contacts=no_contacts(6)))
    held = page.row(row(page.delta_q[2]))
    problem = cp.Problem(page.problem.objective, [*page.problem.constraints, held])
    problem.solve(solver="CLARABEL")
    force = 2.943 + step.M_u[2, 2] * z / step.h**2
    assert_within(held.dual_value, sign * force, 1e-6)


@pytest.mark.extra("study")
def test_multipliers_of_a_solve_that_gave_none_are_not_those_of_the_solve_before():
    """HiGHS gives none where an unknown is a whole number; CVXPY keeps the earlier ones."""
    page = qr.StepProblem(pinch())
    assert page.dual() is None
    page.solve()
    assert page.dual().any()
    switch = cp.Variable(boolean=True)
    linear = cp.Minimize(cp.sum(page.a_a) + switch)
    bounded = [page.a_a <= 1.0, page.a_a >= -1.0]
    page.problem = cp.Problem(linear, [*page.problem.constraints, *bounded])
    page.problem.solve(solver="HIGHS")
    assert page.contact_rows[0].dual_value is not None
    assert page.dual() is None
