"""The matrices that solvers see, against those that CVXPY derives from the problem."""

import cvxpy as cp
import numpy as np
import pytest

from quasistatic_ref.step.data import Extra
from quasistatic_ref.step.problem import StepProblem
from quasistatic_ref.step.standard_form import standard_form
from tests.helpers import random_step
from tests.tolerances import EXACT, ROUNDING


def by_cvxpy(step):
    """H, g, and the rows [A, b] of A x >= b as CVXPY compiles them for a QP solver."""
    problem = StepProblem(step)
    problem.fill(step)
    data, _, _ = problem.problem.get_problem_data(cp.OSQP, solver_opts={})
    assert data["A"].shape[0] == 0  # no equality
    P, q, F, G = data["P"].toarray(), data["q"], data["F"].toarray(), data["G"]
    P = np.triu(P) + np.triu(P, 1).T
    return P, -q, np.column_stack([-F, -G])  # F x <= G


def sorted_rows(rows):
    return rows[np.lexsort(np.round(rows, 9).T)]


def with_extra(step, rng):
    return step.replace(
        extra=Extra(("one", "two"), rng.normal(size=(2, step.n_v)), rng.normal(size=2))
    )


@pytest.mark.parametrize(("n_a", "n_u"), [(7, 6), (0, 6), (7, 0)])
@pytest.mark.parametrize("rows", [(6, 4, 6), (4, 4), (6,)])
def test_cvxpy_compiles_the_same_program_up_to_the_order_of_rows(n_a, n_u, rows, rng):
    step = random_step(rng, n_a, n_u, rows)
    form = standard_form(step)
    H, g, rows_of_cvxpy = by_cvxpy(step)
    ours = np.column_stack([form.A, form.b])
    np.testing.assert_allclose(H, form.H, rtol=ROUNDING, atol=ROUNDING)
    np.testing.assert_allclose(g, form.g, rtol=ROUNDING, atol=ROUNDING)
    assert rows_of_cvxpy.shape == ours.shape
    np.testing.assert_allclose(
        sorted_rows(rows_of_cvxpy), sorted_rows(ours), rtol=ROUNDING, atol=ROUNDING
    )


def test_the_user_s_own_rows_come_last_as_given(rng):
    step = with_extra(random_step(rng), rng)
    form = standard_form(step)
    np.testing.assert_allclose(form.A[-2:], step.extra.A, rtol=EXACT, atol=EXACT)
    np.testing.assert_allclose(form.b[-2:], step.extra.b, rtol=EXACT, atol=EXACT)
    rows_of_cvxpy = by_cvxpy(step)[2]
    ours = np.column_stack([form.A, form.b])
    np.testing.assert_allclose(
        sorted_rows(rows_of_cvxpy), sorted_rows(ours), rtol=ROUNDING, atol=ROUNDING
    )


def test_H_is_exactly_symmetric(rng):
    H = standard_form(random_step(rng, 7, 6)).H
    np.testing.assert_allclose(H, H.T, rtol=EXACT, atol=EXACT)


def test_without_contacts_there_are_no_rows(rng):
    form = standard_form(random_step(rng, 2, 3, rows=()))
    assert form.A.shape == (0, 5)
    assert form.b.shape == (0,)
