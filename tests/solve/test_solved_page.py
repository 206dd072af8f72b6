"""``StepProblem.solve`` asks in natural units: what CVXPY's own ``solve`` loses in metres."""

import cvxpy as cp
import numpy as np
import pytest

import quasistatic_ref as qr
from quasistatic_ref.solve.backends import installed_backends
from tests.helpers import pinch, random_step, sphere_on_floor

WEIGHT = (0.3, 0.0, -2.943, 0.0, 0.0, 1e-3)
ABLE = [name for name in installed_backends() if ":" not in name and name != "highs"]
STEPS = {
    "pinch": lambda: pinch(),
    "ball": lambda: sphere_on_floor(wrench=WEIGHT),
    "four and six rows": lambda: random_step(np.random.default_rng(0)),
    "no rows": lambda: random_step(np.random.default_rng(1), rows=()),
}


@pytest.mark.parametrize("name", STEPS)
@pytest.mark.parametrize("solver", ABLE)
def test_solve_is_right_in_si_units(name, solver):
    """Within 1e-7 of what the step moves, by every solver, in either case of letters."""
    step = STEPS[name]()
    page = qr.StepProblem(step)
    page.fill(step)
    exact = qr.solve_step(step)
    size = np.abs(np.linalg.solve(step.H, qr.standard_form(step).g)).max()
    for called in (solver, solver.upper()):
        found = page.solve(called)
        np.testing.assert_allclose(found, exact.delta_q, atol=1e-6 * size)
        np.testing.assert_array_equal(page.delta_q.value, found)
    lam = sum((row.dual_value.sum() for row in page.contact_rows), 0.0)
    assert lam == pytest.approx(exact.lam.sum(), rel=1e-4, abs=1e-9)


def test_metres_lose_what_natural_units_keep():
    """The pinch moves by 0.4 mm: CVXPY's own answer is off by more than 0.5 % of that."""
    step = qr.load_scenario("two_finger_pinch", steps=12).run(progress=False).step_data(11)
    exact = qr.solve_step(step).delta_q
    size = np.abs(exact).max()
    page = qr.StepProblem(step)
    page.fill(step)
    page.problem.solve(solver=cp.CLARABEL, canon_backend=cp.CPP_CANON_BACKEND)
    assert page.problem.status == cp.OPTIMAL
    assert np.abs(page.delta_q.value - exact).max() > 0.005 * size
    assert np.abs(page.solve() - exact).max() < 1e-9 * size


def test_a_page_that_is_not_filled_and_a_solver_that_is_none_are_refused():
    page = qr.StepProblem(pinch())
    with pytest.raises(qr.StepDataError, match="fill"):
        page.solve()
    page.fill(pinch())
    with pytest.raises(qr.BackendError, match="is not a backend"):
        page.solve("clarabell")
