"""Extensions in SI units: further rows, slacks, a cost that alone drives the step, refusals."""

import cvxpy as cp
import numpy as np
import pytest

from quasistatic_ref.errors import BackendError, StepNotSolved
from quasistatic_ref.optional.extensions import extended
from quasistatic_ref.optional.extensions.extended import _symbols, extended_solution, with_rows
from quasistatic_ref.solve.backends import check_takes_cones
from quasistatic_ref.solve.cvxpy_problem import CvxpyProblem
from quasistatic_ref.solve.units import natural_step, natural_units
from quasistatic_ref.step.data import Extra
from quasistatic_ref.step.extension import Extension
from quasistatic_ref.step.standard_form import standard_form
from tests.helpers import changed, point_on_floor, random_step
from tests.tolerances import EXACT, OPTIMUM, ROUNDING


def test_further_rows_stand_after_those_that_a_step_has(rng):
    one, two = rng.normal(size=(2, 2, 7))
    step = random_step(rng).replace(extra=Extra(("a", "b"), one, [1.0, 2.0]))
    found = with_rows(step, Extra(("c", "d"), two, [3.0, 4.0])).extra
    assert found.names == ("a", "b", "c", "d")
    np.testing.assert_allclose(found.A, [*one, *two], rtol=EXACT, atol=EXACT)
    assert found.b.tolist() == [1.0, 2.0, 3.0, 4.0]


def test_slacks_that_an_extension_speaks_of_are_in_metres(rng):
    """Row i of the contacts that have it: phi + [J'(n~ + d~_i)]' delta_q = A delta_q - b."""
    step = random_step(rng, rows=(6, 4))
    step = step.replace(contacts=changed(step.contacts, J=16 * step.contacts.J))
    units = natural_units(step)
    form = standard_form(step)
    assert units.length > 2
    natural = natural_step(step, units)
    problem = CvxpyProblem(natural)
    delta_q = rng.normal(size=7)
    problem.fill(natural)
    x = delta_q / (units.size * units.coordinate)
    problem.delta_q_a.value = x[:3]
    problem.delta_q_u.value = x[3:]
    found = np.concatenate([slack.value for slack in _symbols(problem, step, units).slack])
    slack = form.A @ delta_q - form.b  # by contacts; an extension has them by rows
    order = [0, 6, 1, 7, 2, 8, 3, 9, 4, 5]
    np.testing.assert_allclose(found, slack[order], rtol=ROUNDING, atol=16 * ROUNDING)


def test_a_cost_that_alone_drives_a_step_moves_it_as_far_as_in_closed_form():
    """m/2h |x|^2 + k/2 |x - p|^2 has its least at k p / (m/h + k)."""
    step = point_on_floor(m=0.3, h=0.01, phi=0.0)
    k = 10.0
    p = np.array([0.02, -0.01, 0.03])
    cost = Extension(lambda s: [k / 2 * cp.sum_squares(s.delta_q - p)])
    answer = extended_solution(step, cost, "clarabel", 1e-10, "residual")
    expected = k * p / (0.3 / 0.01 + k)
    size = np.abs(expected).max()
    np.testing.assert_allclose(answer.delta_q, expected, rtol=0.0, atol=OPTIMUM * size)
    assert max(answer.certificate.residuals.values()) < OPTIMUM


def test_an_extension_that_cannot_be_met_is_not_solved():
    step = point_on_floor(force=(1.0, 0.0, -3.0))
    never = Extension(lambda s: [cp.norm(s.delta_q) + 1.0 <= 0.0])
    with pytest.raises(StepNotSolved, match="clarabel"):
        extended_solution(step, never, "clarabel", 1e-10, "residual")


def test_a_curved_extension_is_judged_with_h_as_it_is(rng):
    """Its K_q couples the actuated coordinates: the residuals are of the whole of H."""
    step = random_step(rng)
    assert np.abs(np.triu(step.H, 1)).max() > 0
    loose = Extension(lambda s: [cp.norm(s.delta_q) <= 1e3])
    answer = extended_solution(step, loose, "clarabel", 1e-10, "residual")
    assert max(answer.certificate.residuals.values()) < OPTIMUM


def test_an_answer_whose_worst_residual_is_just_the_limit_is_believed(monkeypatch):
    step = point_on_floor()
    cost = Extension(lambda s: [cp.sum_squares(s.delta_q - 1e-3)])
    found = extended_solution(step, cost, "clarabel", 1e-10, "residual")
    worst = max(found.certificate.residuals.values())
    assert worst > 0
    monkeypatch.setattr(extended, "RESIDUAL_LIMIT", worst)
    again = extended_solution(step, cost, "clarabel", 1e-10, "residual")
    assert again.certificate == found.certificate
    monkeypatch.setattr(extended, "RESIDUAL_LIMIT", 0.0)
    with pytest.raises(StepNotSolved):
        extended_solution(step, cost, "clarabel", 1e-10, "residual")


def test_only_backends_with_cones_take_what_is_no_row():
    for name in ("clarabel", "scs", "none"):
        check_takes_cones(name, "the ellipsoid")
    for name in ("osqp", "daqp", "qpsolvers:clarabel"):
        with pytest.raises(BackendError, match="accepts only linear rows; the ellipsoid needs one"):
            check_takes_cones(name, "the ellipsoid")
