"""Files that are read together."""

import pytest

from quasistatic_ref import ModelError
from quasistatic_ref.formats.together import SECONDS, once, spend, together

MOST = 0.75 * SECONDS


def test_files_that_are_read_together_are_counted_in_all():
    spend(MOST)
    spend(MOST)
    with together():
        spend(MOST)
        with together(), pytest.raises(ModelError, match="12 s of reading, more than the 8 s of"):
            spend(MOST)
    with together():
        spend(MOST)


def test_what_is_named_again_is_made_once():
    made = []
    with together():
        first, again = (once("a.obj", lambda: made.append(1) or made) for _ in "ab")
    assert first is again
    once("a.obj", lambda: made.append(2))
    assert made == [1, 2]
