"""Extensions in SI units: further rows, slacks and refusals."""

from types import SimpleNamespace

import cvxpy as cp
import numpy as np
import pytest

from quasistatic_ref import Extension, InputError, StepNotSolved, StepProblem, standard_form
from quasistatic_ref.optional.extensions.by_cvxpy import (
    _symbols,
    extended_solution,
    extension_data,
)
from quasistatic_ref.optional.extensions.extended import simulated_solution
from quasistatic_ref.simulate.law import CONVEX
from quasistatic_ref.solve.units import ScaledStep
from quasistatic_ref.step.problem import set_values
from quasistatic_ref.step.standard_form import page_units
from tests.closeness import assert_same
from tests.helpers import changed, point_on_floor, random_step
from tests.tolerances import ROUNDING


def test_an_equation_is_a_row_either_way_and_an_inequality_one_row(rng):
    step = random_step(rng)
    C = rng.normal(size=(2, 7))
    d = np.array([0.25, -0.5])
    own = extension_data(step, Extension(lambda s: [C @ s.delta_q == d, s.delta_q_u[1] <= 2.0]))
    numbers = ("0[0]", "0[1]", "0[0] reversed", "0[1] reversed", "1[0]")
    assert own.names == tuple(f"extension {number}" for number in numbers)
    assert_same(own.A, [*-C, *C, -np.eye(7)[4]])
    assert_same(own.b, [*-d, *d, -2.0])


def test_slacks_that_an_extension_speaks_of_are_in_metres(rng):
    """Row i of the contacts that have it: phi + [J'(n~ + d~_i)]' delta_q = A delta_q - b."""
    step = random_step(rng, rows=(6, 4))
    step = step.replace(contacts=changed(step.contacts, J=16 * step.contacts.J))
    units = ScaledStep(step).units
    form = standard_form(step)
    assert units.length > 2
    problem = StepProblem(step)
    set_values(problem.page, step, units)
    of_page = page_units(units, step.h)
    delta_q = rng.normal(size=7)
    a = delta_q / (of_page.size * of_page.coordinate) / step.h**2
    problem.a_a.value, problem.a_u.value = np.split(a, [3])
    found = np.concatenate([slack.value for slack in _symbols(problem, step, of_page, 0).slack])
    slack = form.A @ delta_q - form.b  # by contacts; an extension has them by rows
    order = [0, 6, 1, 7, 2, 8, 3, 9, 4, 5]
    np.testing.assert_allclose(found, slack[order], rtol=ROUNDING, atol=16 * ROUNDING)


def test_an_extension_that_cannot_be_met_is_not_solved():
    step = point_on_floor(force=(1.0, 0.0, -3.0))
    never = Extension(lambda s: [cp.norm(s.delta_q) + 1.0 <= 0.0])
    with pytest.raises(StepNotSolved, match="clarabel"):
        extended_solution(step, never, "clarabel", 1e-10, "residual")


LOOSE = Extension(lambda s: [cp.norm(s.delta_q) <= 1e3])


def test_a_curved_extension_is_refused_under_coulombs_law_alone(rng):
    step = random_step(rng)
    own = SimpleNamespace(
        law=CONVEX, named_backend=None, replaceable=(), accuracy=1e-10, certify="residual"
    )
    assert simulated_solution(own, step, LOOSE).certificate.kind == "residual"
    own.law = "coulomb"
    with pytest.raises(
        InputError, match=r'extension: holds nonlinear .* which law = "coulomb" does'
    ):
        simulated_solution(own, step, LOOSE)


def test_an_answer_with_a_residual_beyond_the_limit_is_not_believed():
    cost = Extension(lambda s: [cp.sum_squares(s.delta_q - 1e-3)])
    with pytest.raises(StepNotSolved):
        extended_solution(point_on_floor(), cost, "scs", 0.1, "residual")
