"""Eq. (5), d~_1 and d~_2. Under test: step.problem.StepProblem.

And step.cones.pyramid, the same cone for other numbers than CVXPY's.
"""

import numpy as np

from quasistatic_ref.step.cones import pyramid
from quasistatic_ref.step.problem import StepProblem
from tests.helpers import random_step
from tests.tolerances import EXACT, ROUNDING


def printed(contacts):
    expected = []
    for j in range(contacts.n_c):
        d_tilde_1 = [contacts.mu_v[j] * contacts.d1[j][r] for r in range(3)] + [0.0]
        d_tilde_2 = [contacts.mu_v[j] * contacts.d2[j][r] for r in range(3)] + [0.0]
        expected.append([d_tilde_1, d_tilde_2])
    return expected


def directions_of_the_pyramid(contacts):
    """d~_i of every contact, shape (n_c, 6, 4): the pyramid of a gap that is zero."""
    found = []
    for j in range(contacts.n_c):
        mu_v, mu_omega = contacts.mu_v[j], contacts.mu_omega[j]
        slip_1, slip_2 = (np.array([*mu_v * d[j], 0.0]) for d in (contacts.d1, contacts.d2))
        found.append(pyramid(np.zeros(4), slip_1, slip_2, np.array([0.0, 0.0, 0.0, mu_omega])))
    return np.array(found)


def shares_of_the_problem(step, delta_q):
    """What each CVXPY constraint i adds to the gap phi + J_n delta_q: d~_i' J delta_q by (4)."""
    problem = StepProblem(step)
    problem.fill(step)
    problem.delta_q_a.value, problem.delta_q_u.value = delta_q[: step.n_a], delta_q[step.n_a :]
    gap = problem.motion[0].value
    # CVXPY keeps a >= 0 as 0 - a <= 0.
    return [-constraint.expr.value - gap for constraint in problem.contact_rows]


def shares_by_loops(step, delta_q, directions):
    """d~_i' J delta_q of every contact, for the printed d~_i of each contact."""
    share = []
    for j, d_tilde in enumerate(directions):
        total = 0.0
        for r in range(4):
            for k in range(step.n_v):
                total += d_tilde[r] * step.contacts.J[j][r][k] * delta_q[k]
        share.append(total)
    return share


def test_the_first_two_directions_are_the_scaled_tangents(rng):
    contacts = random_step(rng).contacts
    actual = directions_of_the_pyramid(contacts)[:, :2]
    np.testing.assert_allclose(actual, printed(contacts), rtol=EXACT, atol=EXACT)


def test_they_are_what_the_first_two_constraints_add_to_the_gap(rng):
    step = random_step(rng, rows=(6, 6, 6))
    delta_q = rng.normal(size=step.n_v)
    shares = shares_of_the_problem(step, delta_q)
    for i, directions in enumerate(zip(*printed(step.contacts), strict=True)):
        expected = shares_by_loops(step, delta_q, directions)
        np.testing.assert_allclose(shares[i], expected, rtol=ROUNDING, atol=ROUNDING)
