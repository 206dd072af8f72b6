"""Eq. (7), d~_5 and d~_6. Under test: step.problem.StepProblem.

And step.cones.pyramid, the same cone for other numbers than CVXPY's.
"""

import numpy as np

from quasistatic_ref.step.cones import pyramid
from quasistatic_ref.step.problem import StepProblem
from tests.equations.test_eq05_tangential_directions import (
    directions_of_the_pyramid,
    shares_by_loops,
    shares_of_the_problem,
)
from tests.helpers import random_step
from tests.tolerances import EXACT, ROUNDING


def printed(contacts):
    return [[[0.0, 0.0, 0.0, mu], [0.0, 0.0, 0.0, -mu]] for mu in contacts.mu_omega]


def test_the_torsional_directions_are_plus_and_minus_mu_omega_on_the_spin(rng):
    contacts = random_step(rng).contacts
    actual = directions_of_the_pyramid(contacts)
    assert actual.shape == (3, 6, 4)
    np.testing.assert_allclose(actual[:, 4:], printed(contacts), rtol=EXACT, atol=EXACT)


def test_they_are_what_the_last_two_constraints_add_to_the_gap(rng):
    step = random_step(rng, rows=(6, 6, 6))
    delta_q = rng.normal(size=step.n_v)
    shares = shares_of_the_problem(step, delta_q)
    assert len(shares) == 6
    for i, directions in enumerate(zip(*printed(step.contacts), strict=True), start=4):
        expected = shares_by_loops(step, delta_q, directions)
        np.testing.assert_allclose(shares[i], expected, rtol=ROUNDING, atol=ROUNDING)


def test_only_contacts_with_six_rows_have_them(rng):
    problem = StepProblem(random_step(rng, rows=(6, 4, 6)))
    assert [constraint.shape for constraint in problem.contact_rows] == [(3,)] * 4 + [(2,)] * 2
    assert pyramid(1.0, 0.0, 0.0, 0.25)[4:] == (1.25, 0.75)
