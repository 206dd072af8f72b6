"""Eq. (4), phi + [J'(n~ + d~_i)]' delta_q >= 0. Under test: step.problem.paper_problem."""

import numpy as np

from quasistatic_ref.step.problem import paper_problem, set_values
from tests.closeness import assert_close
from tests.helpers import contact_row, random_step


def problem_at(step, delta_q):
    """The problem of a step, with the values of its parameters and of its unknowns."""
    problem = paper_problem(step)
    set_values(problem, step)
    problem.delta_q_a.value, problem.delta_q_u.value = np.split(delta_q, [step.n_a])
    return problem


def left_hand_sides(step, delta_q):
    """The left-hand side of each row i of the contacts that have it, at a displacement."""
    # CVXPY keeps a >= 0 as 0 - a <= 0.
    return [-constraint.expr.value for constraint in problem_at(step, delta_q).contact_rows]


def test_the_cvxpy_constraints_are_the_printed_left_hand_sides(rng):
    step = random_step(rng)
    delta_q = rng.normal(size=step.n_v)
    c = step.contacts
    for i, row in enumerate(left_hand_sides(step, delta_q)):
        expected = [c.phi[j] + contact_row(c, j, i) @ delta_q for j in range(3) if i < c.rows[j]]
        assert_close(row, expected)


def added_to_the_gap(rng):
    """Contacts, their motion J delta_q, and what each row i adds to phi + n'J delta_q."""
    step = random_step(rng, rows=(6, 6, 6))
    delta_q = rng.normal(size=step.n_v)
    c = step.contacts
    motion = c.J @ delta_q
    return c, motion, np.array(left_hand_sides(step, delta_q)) - c.phi - along(c.n, motion)


def along(direction, motion):
    """The part of each contact's motion along a direction of its own."""
    return (direction * motion[:, :3]).sum(axis=1)
