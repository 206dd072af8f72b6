"""What derivatives cost, compared with the step: two boxes on a slope, one of which slides."""

import time
from functools import partial
from importlib.util import find_spec

import numpy as np

from quasistatic_ref.lab.bench.timing import Job, in_turn, microseconds
from quasistatic_ref.optional.derivatives.derivatives import derivatives
from quasistatic_ref.optional.derivatives.step_jax import jax_package, step_jax
from quasistatic_ref.scenario.scenario import load_scenario

SCENE = "block_incline"
ELEMENTS = 16
"""Steps in one call of a ``vmap``."""

STEP = "step, proved"
MAPPED = f"step_jax, an element of {ELEMENTS} in a vmap"


def of_derivatives(rounds: int, repeat: int) -> dict[str, float]:
    """Processor time of the step, its derivatives, and the step in JAX where that is there [us].

    Medians of `rounds` in which they take turns, each `repeat` times.
    """
    scenario = load_scenario(SCENE, fast=True)
    simulator = scenario.simulator()
    given = scenario.system.q_start, np.zeros(0)
    jobs: dict[str, Job] = {
        STEP: partial(simulator.step, *given),
        "derivatives": partial(derivatives, simulator, *given),
    }
    if find_spec("jax") is None:
        return _medians(jobs, rounds, repeat)
    jax = jax_package()
    with jax.enable_x64(True):
        step = step_jax(simulator)
        many = np.tile(given[0], (ELEMENTS, 1))
        mapped = jax.vmap(lambda q: step(q, given[1]))
        jobs["step_jax"] = lambda: jax.block_until_ready(step(*given))
        jobs[MAPPED] = lambda: jax.block_until_ready(mapped(many))
        times = _medians(jobs, rounds, repeat)
    return times | {MAPPED: times[MAPPED] / ELEMENTS}


def _medians(jobs: dict[str, Job], rounds: int, repeat: int) -> dict[str, float]:
    # Of all threads: JAX calls back in one of its own.
    times = in_turn([jobs] * rounds, repeat, time.process_time)
    return {name: microseconds(own) for name, own in times.items()}
