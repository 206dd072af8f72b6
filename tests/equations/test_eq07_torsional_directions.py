"""Eq. (7), d~_5 and d~_6. Under test: step.problem.StepProblem."""

from quasistatic_ref import StepProblem
from quasistatic_ref.step.cones import pyramid
from tests.equations.test_eq05_tangential_directions import assert_shares_are_printed
from tests.helpers import random_step


def printed_directions(contacts):
    return [[[0.0, 0.0, 0.0, mu], [0.0, 0.0, 0.0, -mu]] for mu in contacts.mu_omega]


def test_they_are_what_the_last_two_constraints_add_to_the_gap(rng):
    assert_shares_are_printed(rng, printed_directions, 4)


def test_only_contacts_with_six_rows_have_them(rng):
    problem = StepProblem(random_step(rng, rows=(6, 4, 6)))
    assert [constraint.shape for constraint in problem.contact_rows] == [(3,)] * 4 + [(2,)] * 2
    assert pyramid(1.0, 0.0, 0.0, 0.25)[4:] == (1.25, 0.75)
