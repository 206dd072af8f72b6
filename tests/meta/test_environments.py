"""Nothing is claimed in a strange environment."""

from collections import Counter

import pytest

from quasistatic_ref import InputError
from quasistatic_ref.certify.arithmetic import check_arithmetic
from tests.oracles.environments import (
    LONG,
    MODES,
    after_all_modes,
    by_two_threads,
    in_mode,
    left_by_backend,
    mode,
    next_to_a_mode,
)

STEPS = 1


@pytest.mark.parametrize("name", MODES)
def test_in_a_mode_of_the_processor_nothing_is_claimed(name):
    """Of each step: solved by two ways and bounded, and its proof verified; and solved "off"."""
    assert in_mode(name, STEPS) == Counter(refused=4 * STEPS, unclaimed=STEPS)
    assert left_by_backend(name, STEPS) == Counter(refused=2 * STEPS, unclaimed=STEPS)
    cause = "flushes subnormal" if name in ("FTZ", "DAZ", "FTZ and DAZ") else "does not round to"
    with mode(name), pytest.raises(InputError, match=cause):
        check_arithmetic()
    check_arithmetic()


def test_what_solvers_keep_is_not_changed_by_a_mode():
    assert after_all_modes(STEPS) == Counter(same=4 * STEPS)


def test_a_mode_of_another_thread_changes_nothing():
    assert next_to_a_mode(STEPS) == Counter(same=4 * STEPS)


@pytest.mark.parametrize("shared", ["one simulator", "one system"])
def test_a_step_next_to_another_thread_s_is_the_same_or_refused(shared):
    words = by_two_threads(shared, STEPS)
    assert set(words) <= {"same", "refused"}
    assert words.total() == 2 * LONG * STEPS
    assert words["same"] >= LONG * STEPS / 2


def test_deep_copies_take_steps_at_once():
    assert by_two_threads("a deep copy", STEPS) == Counter(same=2 * LONG * STEPS)
