"""The fuzzing program notices what it is made to notice; a sample of it finds nothing."""

import json

from validation.tools.fuzz import outcomes, table
from validation.tools.fuzzing.readers import names, readers

PLANTED = "tests.meta.planted_readers"
SAMPLE = 12
"""Inputs of each reader in the suite: 10 s in all. The committed table has thousands."""
QUICK = 1.0
"""Limit of time [s] for the planted hang."""


def test_every_planted_fault_is_named_and_the_inputs_after_it_are_read():
    kinds = {
        "plain": "refused", "sentence": "traceback", "traceback": "traceback", "crash": "crash",
        "hang": "hang", "memory": "memory", "too much": "memory",
    }  # fmt: skip
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
    assert {name for name, _, outcome, *_ in found if outcome == "refused"} == set(names())


def test_an_input_is_the_same_in_every_process(tmp_path):
    (tmp_path / "a").mkdir()
    (tmp_path / "b").mkdir()
    one, other = readers(tmp_path / "a"), readers(tmp_path / "b")
    assert {name: reader.good for name, reader in one.items()} == {
        name: reader.good for name, reader in other.items()
    }


def test_the_table_adds_batches_up():
    record = {"reader": "step", "count": 3, "accepted": 1, "refused": 1, "seconds": 0.5}
    record |= {"mebibytes": 300, "failures": [{"input": 1, "outcome": "hang", "words": ""}]}
    other = {**record, "failures": [], "refused": 2, "seconds": 0.25, "mebibytes": 400}
    lines = table([record, json.loads(json.dumps(other))])
    assert lines[2] == "| step | 6 | 2 | 3 | 1 | 0.50 | 400 |"
    assert lines[3] == "| all | 6 | 2 | 3 | 1 | 0.50 | 400 |"
