"""The matrices that solvers see, against those that CVXPY derives from the problem."""

import cvxpy as cp
import numpy as np

from quasistatic_ref import Extra, StepProblem, standard_form
from quasistatic_ref.step.standard_form import Units, clipped_gaps
from tests.closeness import assert_close
from tests.helpers import random_step
from tests.made import point_step
from tests.tolerances import ROUNDING


def test_cvxpy_compiles_the_ellipsoid_to_one_second_order_cone_a_contact(rng):
    # Its entries are b - A a in the cone: gap, slip_1, slip_2 and spin, over h^2.
    step = random_step(rng).replace(cone="ellipsoid")
    problem = StepProblem(step)
    data, _, _ = problem.problem.get_problem_data(cp.CLARABEL, solver_opts={})
    assert (data["dims"].nonneg, data["dims"].soc) == (0, [4, 4, 4])
    form = standard_form(step)
    mu = np.column_stack([np.ones(3), step.contacts.mu]).reshape(-1, 1)
    rows = np.column_stack([-data["A"].toarray(), -data["b"]])
    expected = mu * np.column_stack([form.A, form.b / step.h**2])
    assert_close(rows, expected, ROUNDING)


def test_a_row_out_of_reach_is_put_at_its_reach_in_the_units_that_are_asked_for():
    """In units of 2, 4 and 8 m the row (3, 0, 4) is 0.5 (6, 0, 32) long, with rho ell = 8 m."""
    step = point_step(0.3, (0.0, 0.0, 0.0), 0.5, 0.0, 0.01)
    rows = [[3.0, 0.0, 4.0]] * 2
    step = step.replace(extra=Extra(("near", "far"), rows, [-8.0, -1e9]))
    _, b = clipped_gaps(step, Units(np.array([2.0, 4.0, 8.0]), 2.0, 4.0), 10.0)
    assert b.tolist() == [-8.0, -80 * np.hypot(3.0, 16.0)]
