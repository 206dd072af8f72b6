"""Eq. (4), phi + [J'(n~ + d~_i)]' delta_q >= 0. Under test: step.problem.StepProblem."""

import numpy as np

from quasistatic_ref.step.problem import StepProblem
from tests.helpers import contact_row, random_step
from tests.tolerances import ROUNDING


def test_the_cvxpy_constraints_are_the_printed_left_hand_sides(rng):
    step = random_step(rng, rows=(6, 4, 6))
    contacts = step.contacts
    delta_q = rng.normal(size=step.n_v)
    problem = StepProblem(step)
    problem.fill(step)
    problem.delta_q_a.value = delta_q[:3]
    problem.delta_q_u.value = delta_q[3:]
    for i in range(6):
        expected = []
        for j in range(3):
            if i >= contacts.rows[j]:
                continue
            row = contact_row(contacts, j, i)
            expected.append(contacts.phi[j] + row @ delta_q)
        constraint = problem.contact_rows[i]
        # CVXPY keeps a >= 0 as 0 - a <= 0.
        np.testing.assert_allclose(-constraint.expr.value, expected, rtol=ROUNDING, atol=ROUNDING)
