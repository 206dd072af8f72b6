"""The matrices that solvers see, against those that CVXPY derives from the problem."""

import cvxpy as cp
import numpy as np

from quasistatic_ref import standard_form
from quasistatic_ref.solve.step_problem import StepProblem
from tests.closeness import assert_close
from tests.helpers import random_step
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
