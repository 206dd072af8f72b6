"""Studies whose problems are taken from contact-qp: which ones."""

import numpy as np

from tests.closeness import assert_relative
from tests.lab.study.asked import problems_taken


def test_problems_are_spread_over_the_dial_to_both_ends():
    """Angles from 1e-8 to 0.1 rad."""
    dials = [one.dial for one in problems_taken({"capped_wedge": 5})]
    assert (dials[0], dials[-1]) == (1e-8, 0.1)
    assert_relative(np.divide(dials[1:], dials[:-1]), 1e7 ** (1 / 4), 0.2)


def test_sequences_are_taken_whole_and_in_order():
    found = problems_taken({"moving": 30})
    assert [one.facts["sequence"]["place"] for one in found] == [*range(12), *range(12)]
