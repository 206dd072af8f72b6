"""Threads that share a simulator: nothing changes another's numbers."""

import numpy as np
import pytest

from quasistatic_ref import load_scenario
from tests.threads import PUBLIC, calls, words_of_two_threads

AWAY = 1e-3
"""How far the second state is from the start [m, rad]."""
SECONDS = 0.02
"""For each two methods."""


def two_states(system):
    """The start, and a place to which everything moves; each with a target."""
    q = system.q_start
    there = system.integrate(q, np.full(system.n_v, AWAY))
    return [(q, there[: system.n_q_a]), (there, q[: system.n_q_a])]


@pytest.mark.parametrize("scene", ["bunny_grasp", "stack"])
def test_each_method_beside_each_other_one_has_its_bits_or_is_refused(scene):
    """A cloud on boxes in compiled code; solids on solids."""
    simulator = load_scenario(scene, fast=True).simulator()
    states = two_states(simulator.system)
    assert calls(simulator, *states[0]).keys() == PUBLIC
    words = words_of_two_threads(simulator, states, SECONDS)
    assert words.keys() <= {"same", "refused"}
    assert words["same"] > words["refused"]
