"""Eq. (7), d~_5 and d~_6. Under test: step.pyramid.pyramid."""

import numpy as np

from tests.closeness import assert_close
from tests.helpers import random_step
from tests.oracles.printed_rows import added_to_the_gap, problem_at


def test_torsional_directions_are_those_that_the_last_two_constraints_add_to_the_gap(rng):
    c, motion, added = added_to_the_gap(rng)
    assert_close(added[4:], [sign * c.mu_omega * motion[:, 3] for sign in (1, -1)])


def test_only_contacts_with_six_rows_have_torsional_directions(rng):
    page = problem_at(random_step(rng), np.zeros(7))
    assert [row.shape for row in page.contact_rows] == [(3,)] * 4 + [(2,)] * 2
