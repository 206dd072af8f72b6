"""Eq. (6), d~_3 and d~_4. Under test: step.problem.StepProblem.

And step.cones.pyramid, the same cone for other numbers than CVXPY's.
"""

import numpy as np

from tests.equations.test_eq05_tangential_directions import (
    directions_of_the_pyramid,
    shares_by_loops,
    shares_of_the_problem,
)
from tests.helpers import random_step
from tests.tolerances import EXACT, ROUNDING


def printed(contacts):
    expected = []
    for j in range(contacts.n_c):
        d_tilde_3 = [-contacts.mu_v[j] * contacts.d1[j][r] for r in range(3)] + [0.0]
        d_tilde_4 = [-contacts.mu_v[j] * contacts.d2[j][r] for r in range(3)] + [0.0]
        expected.append([d_tilde_3, d_tilde_4])
    return expected


def test_the_next_two_directions_are_the_scaled_tangents_turned_round(rng):
    contacts = random_step(rng).contacts
    actual = directions_of_the_pyramid(contacts)[:, 2:4]
    np.testing.assert_allclose(actual, printed(contacts), rtol=EXACT, atol=EXACT)


def test_they_are_what_the_third_and_fourth_constraint_add_to_the_gap(rng):
    step = random_step(rng, rows=(6, 6, 6))
    delta_q = rng.normal(size=step.n_v)
    shares = shares_of_the_problem(step, delta_q)
    for i, directions in enumerate(zip(*printed(step.contacts), strict=True), start=2):
        expected = shares_by_loops(step, delta_q, directions)
        np.testing.assert_allclose(shares[i], expected, rtol=ROUNDING, atol=ROUNDING)
