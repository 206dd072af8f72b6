"""Studies whose problems are taken from a set: which ones, and what is refused."""

import numpy as np
import pytest

from quasistatic_ref import InputError
from quasistatic_ref.lab.study.problems.for_study import study_problems
from quasistatic_ref.lab.study.problems.selection import problems_along_dial, problems_taken
from tests.closeness import assert_relative


def test_problems_are_spread_over_the_dial_up_to_where_it_ends(members):
    """Angles from 0.1 rad down: those of at least `most`, both ends among them."""
    own = [one for one in members if one.facts["family"] == "capped_wedge"]
    dials = [one.facts["dial"] for one in problems_along_dial(own, "capped_wedge", 5, 1e-3)]
    assert len(dials) == 5
    assert max(dials) == 0.1
    assert 1e-3 <= min(dials) < 1.2e-3
    ratios = np.array(sorted(dials)[1:]) / sorted(dials)[:-1]
    assert_relative(ratios, 100 ** (1 / 4), 0.2)


def test_sequences_are_taken_whole_and_in_order(members):
    own = [one for one in members if one.facts["family"] == "moving"]
    found = problems_along_dial(own, "moving", 30)
    assert [one.facts["sequence"]["place"] for one in found] == [*range(12), *range(12)]


def test_a_family_of_cones_is_refused():
    with pytest.raises(InputError, match="has cones; studies contain rows only"):
        problems_taken("contact-qp", {"ellipsoid": 2}, {})


@pytest.mark.parametrize(("text", "words"), [
    ("families = { moving = 12 }", "is a family of sets; say set"),
    ("families = { scenarios = { count = 3, most = 0.01 } }", "has no dial to be turned"),
    ('set = "contact-qp-3"\nfamilies = { narrow = 3 }', "is neither a folder nor a set"),
    ('set = "contact-qp"\nfamilies = { heaps = 3 }', "heaps"),
    ("families = { contacts = { most = 3 } }", "count"),
    ('set = "contact-qp"\nfamilies = { narrow = { count = 3, most = -1 } }', "must be greater"),
])  # fmt: skip
def test_what_cannot_be_taken_is_said(study, tmp_path, text, words):
    with pytest.raises(InputError, match=words):
        study_problems(
            study(f"[problems]\n{text}\n[[runs]]\nsolvers = ['qpsolvers:daqp']").problems, tmp_path
        )
