"""Eq. (5), d~_1 and d~_2. Under test: step.pyramid.pyramid."""

from tests.closeness import assert_close
from tests.oracles.printed_rows import added_to_the_gap, along


def test_tangents_are_those_that_the_first_two_constraints_add_to_the_gap(rng):
    c, motion, added = added_to_the_gap(rng)
    expected = [c.mu_v * along(d, motion) for d in (c.d1, c.d2)]
    assert_close(added[0:2], expected)
