"""Eq. (7), d~_5 and d~_6. Under test: step.problem.paper_problem."""

from quasistatic_ref.step.cones import pyramid
from quasistatic_ref.step.problem import paper_problem
from tests.closeness import assert_close
from tests.helpers import random_step
from tests.oracles.printed_rows import added_to_the_gap


def test_torsional_directions_are_those_that_the_last_two_constraints_add_to_the_gap(rng):
    c, motion, added = added_to_the_gap(rng)
    assert_close(added[4:], [sign * c.mu_omega * motion[:, 3] for sign in (1, -1)])


def test_only_contacts_with_six_rows_have_torsional_directions(rng):
    problem = paper_problem(random_step(rng))
    assert [constraint.shape for constraint in problem.contact_rows] == [(3,)] * 4 + [(2,)] * 2
    assert pyramid(1.0, 0.0, 0.0, 0.25)[4:] == (1.25, 0.75)
