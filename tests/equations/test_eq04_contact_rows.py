"""Eq. (4), phi + [J'(n~ + d~_i)]' delta_q >= 0. Under test: step.problem.StepProblem."""

import numpy as np

from quasistatic_ref.step.friction import friction_rows
from quasistatic_ref.step.problem import StepProblem
from tests.helpers import random_step
from tests.tolerances import ROUNDING


def row(contacts, j, d_tilde_i):
    """[J_j'(n~_j + d~_i)]' by loops."""
    n_tilde = [*contacts.n[j], 0.0]
    entries = []
    for k in range(contacts.J.shape[2]):
        total = 0.0
        for r in range(4):
            total += contacts.J[j][r][k] * (n_tilde[r] + d_tilde_i[r])
        entries.append(total)
    return entries


def directions(contacts, j):
    v = contacts.mu_v[j]
    w = contacts.mu_omega[j]
    d1 = contacts.d1[j]
    d2 = contacts.d2[j]
    return [
        [v * d1[0], v * d1[1], v * d1[2], 0.0],
        [v * d2[0], v * d2[1], v * d2[2], 0.0],
        [-v * d1[0], -v * d1[1], -v * d1[2], 0.0],
        [-v * d2[0], -v * d2[1], -v * d2[2], 0.0],
        [0.0, 0.0, 0.0, w],
        [0.0, 0.0, 0.0, -w],
    ]


def test_every_row_of_A_is_the_printed_one(rng):
    step = random_step(rng, rows=(6, 4, 6, 6))
    contacts = step.contacts
    expected = [[row(contacts, j, d) for d in directions(contacts, j)] for j in range(4)]
    found = friction_rows(contacts)[step.mask]  # those that the contacts have
    np.testing.assert_allclose(found, np.array(expected)[step.mask], rtol=ROUNDING, atol=ROUNDING)


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
            total = contacts.phi[j]
            for k, entry in enumerate(row(contacts, j, directions(contacts, j)[i])):
                total += entry * delta_q[k]
            expected.append(total)
        constraint = problem.contact_rows[i]
        # CVXPY keeps a >= 0 as 0 - a <= 0.
        np.testing.assert_allclose(-constraint.expr.value, expected, rtol=ROUNDING, atol=ROUNDING)
