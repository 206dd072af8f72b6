"""The fuzzing program notices what it is made to notice; a sample of it finds nothing."""

from validation.tools.fuzz import outcomes
from validation.tools.fuzzing.readers import names

PLANTED = "tests.meta.planted_readers"
SAMPLE = 4
"""Inputs of each reader in the suite: 3 s in all. The committed table has thousands."""
QUICK = 1.0
"""Limit of time [s] for the planted hang."""


def test_every_planted_fault_is_named_and_the_inputs_after_it_are_read():
    kinds = {
        "plain": "refused",
        **{fault: fault for fault in ("traceback", "crash", "hang", "memory")},
    }
    found = [*outcomes([("hang", 5, 1)], PLANTED, QUICK)]
    found += outcomes([(name, 5, 1) for name in kinds if name != "hang"], PLANTED)
    assert {name: outcome for name, _, outcome, *_ in found} == kinds
    assert {i for _, i, *_ in found} == {5}
    after = [("plain", 0, 1), ("crash", 1, 2), ("plain", 3, 1)]
    assert [i for _, i, *_ in outcomes(after, PLANTED)] == [0, 1, 2, 3]


def test_a_sample_of_every_reader_is_accepted_or_refused_in_a_sentence():
    found = list(outcomes([(name, 0, SAMPLE) for name in names()]))
    assert [one for one in found if one[2] not in ("accepted", "refused")] == []
    assert len(found) == SAMPLE * len(names())
    refused = {name for name, _, outcome, *_ in found if outcome == "refused"}
    assert len(refused) > 0.8 * len(names())
