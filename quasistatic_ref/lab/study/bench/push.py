"""Steps of a planar push in the ellipsoid: two contacts, six variables, by kind of certificate."""

import time
from functools import partial

import numpy as np

from quasistatic_ref.lab.scenes.pushed_block import pushed_block
from quasistatic_ref.lab.study.bench.timing import INTERFACES, in_turn
from quasistatic_ref.solve.backends import CERTIFY

TAIL = 0.99
"""The share of steps that take no longer than the second number of a row."""


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
