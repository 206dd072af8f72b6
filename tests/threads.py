"""Public methods of a simulator in two threads at once: each answers as it does alone."""

import sys
import time
from collections import Counter
from contextlib import contextmanager
from itertools import combinations_with_replacement
from threading import Thread

import numpy as np

from quasistatic_ref import Simulator, StepNotSolved
from quasistatic_ref.simulate.form_step import form_step
from tests.meta.test_environments import outcome, word

SWITCH = 1e-5
"""From one thread to the other [s]."""
PUBLIC = {
    name
    for name in dir(Simulator)
    if callable(getattr(Simulator, name)) and not name.startswith("_")
}


def calls(simulator, q, target):
    """Each public method of a simulator by its name, asked at q, (n_q,), towards a target."""
    system = simulator.system
    points = simulator.closest_points(system.kinematics(q))
    step = form_step(simulator.plan, system.at(q), target, None, points)
    failure = StepNotSolved(simulator.backend, "a test", step, 1e-9)
    return {
        "closest_points": lambda: simulator.closest_points(system.kinematics(q)),
        "fallback_solution": lambda: simulator.fallback_solution(step, failure).delta_q,
        "findings": lambda: simulator.findings(q),
        "fitting_solver": lambda: simulator.fitting_solver(step).name,
        "generalised_force": lambda: simulator.generalised_force(q, None),
        "natural_step": lambda: simulator.natural_step(step).units,
        "settings": lambda: [*simulator.settings()],
        "solution": lambda: simulator.solution(step).delta_q,
        "stands": lambda: simulator.stands(q, target),
        "start_cold": simulator.start_cold,
        "step": lambda: simulator.step(q, target).q,
        "steps": lambda: [one.q for one in simulator.steps(q, np.array([target, target]))],
    }


@contextmanager
def quick_switches():
    """Threads take turns after SWITCH."""
    before = sys.getswitchinterval()
    sys.setswitchinterval(SWITCH)
    try:
        yield
    finally:
        sys.setswitchinterval(before)


def words_of_two_threads(simulator, states, seconds, methods=PUBLIC):
    """How often an answer was the same, refused or wrong, of each method beside each other one.

    `states` are two pairs of q and a target; each pair of methods is asked for some seconds.
    """
    every = [calls(simulator, *state) for state in states]
    right = [{name: outcome(call) for name, call in each.items()} for each in every]
    words = Counter()

    def ask(k, name, end):
        while True:
            words[word(outcome(every[k][name]), right[k][name])] += 1
            if time.monotonic() > end:
                break

    with quick_switches():
        for pair in combinations_with_replacement(sorted(methods), 2):
            end = time.monotonic() + seconds
            threads = [Thread(target=ask, args=(k, name, end)) for k, name in enumerate(pair)]
            for thread in threads:
                thread.start()
            for thread in threads:
                thread.join()
    return words
