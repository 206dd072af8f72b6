"""The fuzzing program notices what it is made to notice; a sample of it finds nothing."""

from validation.tools.fuzz import outcomes
from validation.tools.fuzzing.readers import names

SAMPLE = 4
"""Inputs of each reader in the suite: 3 s in all. The committed table has thousands."""


def test_a_sample_of_every_reader_is_accepted_or_refused_in_a_sentence():
    found = list(outcomes([(name, 0, SAMPLE) for name in names()]))
    assert [one for one in found if one[2] not in ("accepted", "refused")] == []
    assert len(found) == SAMPLE * len(names())
    refused = {name for name, _, outcome, *_ in found if outcome == "refused"}
    assert len(refused) > 0.8 * len(names())
