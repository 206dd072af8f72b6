"""Steps of a planar push: two contacts, six variables, by kind of certificate; derivatives."""

import time
from collections.abc import Callable, Mapping
from functools import partial
from importlib.util import find_spec
from typing import Any

import numpy as np

from quasistatic_ref.lab.scenes.pushed_block import pushed_block
from quasistatic_ref.lab.study.bench.timing import INTERFACES, in_turn, microseconds, ratio
from quasistatic_ref.optional.derivatives.derivatives import derivatives
from quasistatic_ref.optional.derivatives.smoothed import smoothed
from quasistatic_ref.optional.derivatives.step_jax import jax_package, step_jax
from quasistatic_ref.solve.backends import CERTIFY
from quasistatic_ref.step.data import Array

TAIL = 0.99
"""The share of steps that take no longer than the second number of a row."""

KAPPA, MANY = 1e-6, 10
"""Of the smoothed steps [N m s]; steps of JAX at once."""


def pushes(steps: int, repeat: int) -> list[dict[str, float | str]]:
    """The median and the 99th percentile of a step, each speed and certificate in turn [us].

    Parameters
    ----------
    steps, repeat : int
        Of the push; how often all of them are taken.
    """
    scenes = {
        f"{interface}, {kind}": pushed_block(kind, fast=fast)
        for interface, fast in INTERFACES.items()
        for kind in CERTIFY
    }
    path = [result.q for result in pushed_block("off").run(steps)]
    rounds = [
        {name: partial(scene.simulator.step, q, scene.goal(k)) for name, scene in scenes.items()}
        for k, q in enumerate(path, start=1)
    ]
    return [
        {"how": name, "median": 1e6 * float(np.median(t)), "p99": 1e6 * float(np.quantile(t, TAIL))}
        for name, t in in_turn(rounds, repeat, time.thread_time).items()
    ]


def slopes(steps: int, repeat: int) -> list[dict[str, float | str]]:
    """What derivatives of the pushes in the pyramid cost, in turn with the steps [us]; over these.

    Parameters
    ----------
    steps, repeat : int
        Of the push; how often all of them are taken.
    """
    scene = pushed_block(cone="pyramid")
    simulator, goals = scene.simulator, [scene.goal(k) for k in range(1, steps + 1)]
    path = [result.q for result in scene.run(steps)]
    jobs: dict[str, Callable[..., Any]] = {
        "step": simulator.step,
        "derivatives": partial(derivatives, simulator),
        "smoothed": partial(smoothed, simulator, kappa=KAPPA),
    }
    if find_spec("jax"):
        jax = jax_package()
        with jax.enable_x64(True):
            one = step_jax(simulator)
            jobs |= {"step_jax": one, f"{MANY} in vmap": jax.vmap(one)}
            return _over_steps(jobs, path, goals, repeat)
    return _over_steps(jobs, path, goals, repeat)


def _over_steps(
    jobs: Mapping[str, Callable[..., Any]], path: list[Array], goals: list[Array], repeat: int
) -> list[dict[str, float | str]]:
    def given(name: str, q: Array, goal: Array) -> tuple[Array, Array]:
        return (np.tile(q, (MANY, 1)), np.tile(goal, (MANY, 1))) if "vmap" in name else (q, goal)

    rounds = [
        {name: partial(job, *given(name, q, goal)) for name, job in jobs.items()}
        for q, goal in zip(path, goals, strict=True)
    ]
    times = in_turn(rounds, repeat, time.process_time)
    return [
        {"what": name, "median": microseconds(t), "over": ratio(t, times["step"])}
        for name, t in times.items()
    ]
