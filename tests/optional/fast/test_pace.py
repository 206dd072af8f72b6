"""A run says when `fast` would save ten seconds, and only then, once."""

from types import SimpleNamespace

import pytest

from quasistatic_ref.optional.fast.pace import FIRST, SAVED, WORTH, Pace
from quasistatic_ref.tolerances import SPARSE_FROM_PIQP

STEPS = 1000


def advice_by_step(fast, step_seconds, first=0.0):
    """What is said after each step: the first takes longer, the others as long as is given."""
    pace = Pace(fast, STEPS)
    times = [first, *[step_seconds] * (STEPS - 1)]
    return [pace.advice({"solve": time / 2, "rows": time / 4, "proof": time / 4}) for time in times]


@pytest.mark.parametrize(("share", "spoken"), [(0.999, False), (1.001, True), (2.0, True)])
def test_it_is_said_once_where_ten_seconds_would_be_saved(share, spoken):
    # After 1 + FIRST steps, the share SAVED of what the others take is WORTH seconds.
    seconds = share * WORTH / SAVED / (STEPS - 1 - FIRST)
    sentences = advice_by_step(False, seconds, first=1e3)
    assert [k for k, words in enumerate(sentences) if words] == [FIRST] * spoken
    if spoken:
        rest = f"the other {STEPS - 1 - FIRST} steps take some {share * WORTH / SAVED:.0f} s; "
        assert sentences[FIRST].startswith(rest)
        assert "--fast" in sentences[FIRST]


def test_each_step_is_looked_at_until_enough_are_measured():
    pace = Pace(False, STEPS)
    looks = []
    for _ in range(1 + FIRST + 1):
        looks.append(pace.every_step)
        pace.advice({"solve": 1e-9})
    assert looks == [True] * (1 + FIRST) + [False]
    assert not Pace(True, STEPS).every_step


def test_a_large_scene_is_told_at_once():
    assert Pace(False, 1).opening(SPARSE_FROM_PIQP - 1) is None
    assert Pace(True, 1).opening(SPARSE_FROM_PIQP) is None
    assert "--fast" in Pace(False, 1).opening(SPARSE_FROM_PIQP)


def test_the_entries_of_J_are_told_once_before_the_first_step(capsys):
    n_v = 7
    for n_c in (1, SPARSE_FROM_PIQP):
        layout = SimpleNamespace(rows=range(n_c))
        system = SimpleNamespace(n_v=n_v)
        recorder = SimpleNamespace(simulator=SimpleNamespace(layout=layout, system=system))
        pace = Pace(False, 2)
        pace.before(recorder)
    printed = capsys.readouterr().err
    pace.before(recorder)
    assert capsys.readouterr().err == ""
    assert printed.startswith(f"quasistatic-ref: J has {4 * SPARSE_FROM_PIQP * n_v:,} entries")
    assert printed.count("\n") == 1


def test_a_fast_run_says_nothing():
    assert not any(advice_by_step(True, 1.0))
