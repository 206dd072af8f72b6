"""Extensions in SI units: further rows, slacks and refusals."""

import cvxpy as cp
import numpy as np
import pytest

from quasistatic_ref import (
    Extension,
    InputError,
    StepNotSolved,
    load_scenario,
    solve_step,
    standard_form,
)
from tests.closeness import assert_relative, assert_same
from tests.helpers import changed, first_step, point_on_floor, random_step
from tests.tolerances import ROUNDING


def own_rows(step, terms):
    """The rows that the terms of an extension are in its step."""
    return solve_step(step, extension=Extension(terms)).step.extra


def test_an_equation_is_a_row_either_way_and_an_inequality_one_row(rng):
    C = rng.normal(size=(2, 7))
    d = np.array([0.25, -0.5])
    free = random_step(rng, rows=())
    own = own_rows(free, lambda s: [C @ s.delta_q == d, s.delta_q_u[1] <= 2.0])
    numbers = ("0[0]", "0[1]", "0[0] reversed", "0[1] reversed", "1[0]")
    assert own.names == tuple(f"extension {number}" for number in numbers)
    assert_same(own.A, [*-C, *C, -np.eye(7)[4]])
    assert_same(own.b, [*-d, *d, -2.0])


def test_slacks_that_an_extension_speaks_of_are_in_metres(rng):
    """Row i of the contacts that have it: phi + [J'(n~ + d~_i)]' delta_q = A delta_q - b."""
    step = random_step(rng, rows=(6, 4))
    step = step.replace(contacts=changed(step.contacts, J=16 * step.contacts.J))
    own = own_rows(step, lambda s: [slack >= -2.0 for slack in s.slack])
    form = standard_form(step)
    order = [0, 6, 1, 7, 2, 8, 3, 9, 4, 5]  # by contacts; an extension has them by rows
    np.testing.assert_allclose(own.A, form.A[order], rtol=ROUNDING, atol=16 * ROUNDING)
    assert_relative(own.b, form.b[order] - 2.0)


def test_an_extension_that_cannot_be_met_is_not_solved():
    step = point_on_floor(force=(1.0, 0.0, -3.0))
    never = Extension(lambda s: [cp.norm(s.delta_q) + 1.0 <= 0.0])
    with pytest.raises(StepNotSolved, match="clarabel"):
        solve_step(step, "clarabel", extension=never)


def test_a_curved_extension_is_refused_under_coulombs_law_alone():
    loose = Extension(lambda s: [cp.norm(s.delta_q) <= 1e3])
    for law in ("convex", "coulomb"):
        scenario = load_scenario("sphere_spin", {"law": law})
        simulator = scenario.simulator(lambda q: loose)
        if law == "convex":
            solution = first_step(scenario, simulator).solution
            assert solution.certificate.kind == "residual"
            continue
        with pytest.raises(InputError, match=r'holds nonlinear .* which law = "coulomb" does'):
            first_step(scenario, simulator)


def test_an_answer_with_a_residual_beyond_the_limit_is_not_believed():
    cost = Extension(lambda s: [cp.norm(s.delta_q - 1e-3)])
    with pytest.raises(StepNotSolved):
        solve_step(point_on_floor(), "scs", accuracy=0.1, extension=cost)
