"""Eq. (4), phi + [J'(n~ + d~_i)]' delta_q >= 0. Under test: step.problem.StepProblem."""

from quasistatic_ref import StepProblem
from tests.closeness import assert_close
from tests.helpers import contact_row, random_step
from tests.tolerances import ROUNDING


def at(step, delta_q):
    """The problem at a displacement, and the left-hand side of each row i of its contacts."""
    problem = StepProblem(step)
    problem.fill(step)
    problem.delta_q_a.value = delta_q[: step.n_a]
    problem.delta_q_u.value = delta_q[step.n_a :]
    # CVXPY keeps a >= 0 as 0 - a <= 0.
    return problem, [-constraint.expr.value for constraint in problem.contact_rows]


def test_the_cvxpy_constraints_are_the_printed_left_hand_sides(rng):
    step = random_step(rng, rows=(6, 4, 6))
    contacts = step.contacts
    delta_q = rng.normal(size=step.n_v)
    _, found = at(step, delta_q)
    for i in range(6):
        expected = []
        for j in range(3):
            if i < contacts.rows[j]:
                expected.append(contacts.phi[j] + contact_row(contacts, j, i) @ delta_q)
        assert_close(found[i], expected, ROUNDING)
