"""What derivatives cost, compared with the step: a box that a force pushes over the floor."""

import time
from functools import partial
from importlib.util import find_spec

import numpy as np

from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.lab.scenes.systems import world_plane
from quasistatic_ref.lab.study.bench.timing import Job, in_turn, microseconds
from quasistatic_ref.model.body import Body
from quasistatic_ref.model.system import System
from quasistatic_ref.optional.derivatives.derivatives import derivatives
from quasistatic_ref.optional.derivatives.step_jax import jax_package, step_jax
from quasistatic_ref.shapes.placed_shape import Box
from quasistatic_ref.simulate.simulator import Simulator
from quasistatic_ref.step.data import Array

ELEMENTS = 16
"""Steps in one call of a ``vmap``."""

STEP = "step, proved"
MAPPED = f"step_jax, an element of {ELEMENTS} in a vmap"


def pushed_box() -> tuple[Simulator, Array, Array]:
    """The simulator, q (7,), and a force (6,) [N, N m] beyond friction, which holds 2.45 N."""
    cube = Box(size=(0.1, 0.1, 0.1))
    box = Body.of_shape("box", cube, mass=0.5, xyz=(0, 0, 0.05), rpy=(0, 0, 0.3))
    system = System([box])
    floor = ContactPair("floor", world_plane(), system.shapes[0], 0.5, 0.01, 6, 4)
    simulator = Simulator(system, [floor], h=0.01, K_q=np.zeros((0, 0)), fast=True)
    return simulator, system.q_start, np.array([3.0, 0.2, 0.0, 0.0, 0.0, 0.01])


def of_derivatives(rounds: int, repeat: int) -> dict[str, float]:
    """Processor time of the step, its derivatives, and the step in JAX where that is there [us].

    Medians of `rounds` in which they take turns, each `repeat` times.
    """
    simulator, q, force = pushed_box()
    given = q, np.zeros(0), force
    jobs: dict[str, Job] = {
        STEP: partial(simulator.step, *given),
        "derivatives": partial(derivatives, simulator, *given),
    }
    if find_spec("jax") is None:
        return _medians(jobs, rounds, repeat)
    jax = jax_package()
    with jax.enable_x64(True):
        step = step_jax(simulator)
        many = np.tile(q, (ELEMENTS, 1))
        mapped = jax.vmap(lambda q: step(q, *given[1:]))
        jobs["step_jax"] = lambda: jax.block_until_ready(step(*given))
        jobs[MAPPED] = lambda: jax.block_until_ready(mapped(many))
        times = _medians(jobs, rounds, repeat)
    return times | {MAPPED: times[MAPPED] / ELEMENTS}


def _medians(jobs: dict[str, Job], rounds: int, repeat: int) -> dict[str, float]:
    # Of all threads: JAX calls back in one of its own.
    times = in_turn([jobs] * rounds, repeat, time.process_time)
    return {name: microseconds(own) for name, own in times.items()}
