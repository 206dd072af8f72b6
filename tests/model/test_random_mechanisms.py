"""A sample of the random mechanisms of validation/make/random_mechanisms.py."""

from collections import Counter

from tests.tolerances import ROUNDING
from validation.make.random_mechanisms import CALLS, compare


def test_random_mechanisms_move_and_weigh_as_their_links_do() -> None:
    kinds = Counter[str]()  # in 38, joints of one chain follow a passive one next to it
    for seed in range(31, 39):
        own, errors, same = compare(seed)
        kinds += own
        assert errors.shape[0] == CALLS
        assert errors.max() < ROUNDING
        assert same
    assert min(kinds[name] for name in ("negative", "passive", "below another mimic joint")) > 2
