"""Studies whose problems are taken from a set: which ones, and what is refused."""

import numpy as np

from quasistatic_ref.lab.study.problems.selection import problems_taken
from tests.closeness import assert_relative


def test_problems_are_spread_over_the_dial_up_to_where_it_ends():
    """Angles from 0.1 rad down: those of at least `most`, both ends among them."""
    found = problems_taken("contact-qp", {"capped_wedge": 5}, {"capped_wedge": 1e-3})
    dials = [one.facts["dial"] for one in found]
    assert len(dials) == 5
    assert max(dials) == 0.1
    assert 1e-3 <= min(dials) < 1.2e-3
    ratios = np.array(sorted(dials)[1:]) / sorted(dials)[:-1]
    assert_relative(ratios, 100 ** (1 / 4), 0.2)


def test_sequences_are_taken_whole_and_in_order():
    found = problems_taken("contact-qp", {"moving": 30})
    assert [one.facts["sequence"]["place"] for one in found] == [*range(12), *range(12)]
