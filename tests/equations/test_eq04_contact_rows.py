"""Eq. (4), phi + [J'(n~ + d~_i)]' delta_q >= 0. Under test: step.problem.paper_problem."""

from tests.closeness import assert_close
from tests.helpers import contact_row, random_step
from tests.oracles.printed_rows import left_hand_sides


def test_the_cvxpy_constraints_are_the_printed_left_hand_sides(rng):
    step = random_step(rng)
    delta_q = rng.normal(size=step.n_v)
    c = step.contacts
    for i, row in enumerate(left_hand_sides(step, delta_q)):
        expected = [c.phi[j] + contact_row(c, j, i) @ delta_q for j in range(3) if i < c.rows[j]]
        assert_close(row, expected)
