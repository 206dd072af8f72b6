"""The matrices that solvers see, against those that CVXPY derives from the problem."""

import cvxpy as cp
import numpy as np
import pytest

from quasistatic_ref import Extra, standard_form
from quasistatic_ref.solve.step_problem import StepProblem
from tests.closeness import assert_close
from tests.helpers import random_step
from tests.tolerances import ROUNDING


def by_cvxpy(step):
    """H, g, and the rows [A, b] of A x >= b as CVXPY compiles them for a QP solver."""
    problem = StepProblem(step)
    data, _, _ = problem.problem.get_problem_data(cp.OSQP, solver_opts={})
    assert data["A"].shape[0] == 0  # no equality
    P = data["P"].toarray()
    q = data["q"]
    F = data["F"].toarray()
    G = data["G"]
    P = np.triu(P) + np.triu(P, 1).T
    return P, -q, np.column_stack([-F, -G])  # F x <= G


CONES = ("pyramid", "product", "facets-8", "frictionless")


@pytest.mark.parametrize("name", CONES)
@pytest.mark.parametrize("rows", [(6, 4, 6), (4, 4)])
def test_cvxpy_compiles_the_rows_of_every_cone_in_order(name, rows, rng):
    # CVXPY's list goes over the rows i first, ours over the contacts; no entry is sorted away.
    extra = Extra(("one", "two"), rng.normal(size=(2, 7)), rng.normal(size=2))
    step = random_step(rng, rows=rows).replace(cone=name, extra=extra)
    form = standard_form(step)
    m = int(step.offsets[-1])
    by_row = np.argsort(np.nonzero(step.mask)[1], kind="stable")
    ours = np.column_stack([form.A, form.b])[[*by_row, m, m + 1]]
    _, _, rows_of_cvxpy = by_cvxpy(step)
    assert_close(rows_of_cvxpy, ours, ROUNDING)


def test_cvxpy_compiles_the_ellipsoid_to_one_second_order_cone_a_contact(rng):
    # Its entries are b - A delta_q in the cone: gap, slip_1, slip_2 and spin.
    step = random_step(rng).replace(cone="ellipsoid")
    problem = StepProblem(step)
    data, _, _ = problem.problem.get_problem_data(cp.CLARABEL, solver_opts={})
    assert (data["dims"].nonneg, data["dims"].soc) == (0, [4, 4, 4])
    form = standard_form(step)
    mu = np.column_stack([np.ones(3), step.contacts.mu]).reshape(-1, 1)
    rows = np.column_stack([-data["A"].toarray(), -data["b"]])
    expected = mu * np.column_stack([form.A, form.b])
    assert_close(rows, expected, ROUNDING)
