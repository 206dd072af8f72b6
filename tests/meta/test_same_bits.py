"""The script that holds bits the same finds what differs, and nothing else."""

from validation.make import same_bits

BEFORE = {"runs": {"push": {"q": "a1", "steps": 3}, "pinch": {"q": "b2", "steps": 4}}}


def test_equal_records_differ_in_nothing():
    assert same_bits.differences(BEFORE, {"runs": dict(BEFORE["runs"])}) == []


def test_every_entry_that_changed_came_or_went_is_named():
    now = {"runs": {"push": {"q": "a9", "steps": 3}, "spin": {"q": "c3"}}}
    assert same_bits.differences(BEFORE, now) == [
        "runs: push: q: was a1, is a9",
        f"runs: pinch: was {BEFORE['runs']['pinch']}, is absent",
        "runs: spin: was absent, is {'q': 'c3'}",
    ]


def test_a_record_of_a_run_is_the_same_when_it_is_made_again():
    one = same_bits.run_record("two_finger_pinch", ["steps=3"])
    assert one == same_bits.run_record("two_finger_pinch", ["steps=3"])
    assert one["exact"] == one["steps"] == 3
    other = same_bits.run_record("two_finger_pinch", ["steps=4"])
    assert all(one[key] != other[key] for key in ("q", "delta_q", "A'lam", "slack"))


def test_the_kernel_of_blas_is_named():
    assert len(same_bits.kernel().split()) == 3
