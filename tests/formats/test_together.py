"""Files that are read together."""

from quasistatic_ref.formats.together import once, together


def test_what_is_named_again_is_made_once():
    made = []
    with together():
        first, again = (once("a.obj", lambda: made.append(1) or made) for _ in "ab")
    assert first is again
    once("a.obj", lambda: made.append(2))
    assert made == [1, 2]
