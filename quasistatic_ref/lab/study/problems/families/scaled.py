"""Families in which one number is scaled: contacts, ratio of masses, time step, bodies."""

from collections.abc import Iterator

import numpy as np

from quasistatic_ref.lab.scenes.slabs import slab_step, tower_step
from quasistatic_ref.lab.study.problems.families.made import Made
from quasistatic_ref.step.data import Array

COMMON = {"contacts": 12, "ratio": 10.0, "h": 0.01}
"""What a slab has that is not scaled: contacts, ratio of masses [-], time step [s]."""


def slabs(family: str, field: str, values: Array, seed: int) -> Iterator[Made]:
    """A slab on the floor with a block on it, in which one number is scaled.

    Parameters
    ----------
    family : str
    field : str
        ``contacts``, ``ratio`` or ``h``.
    values : ndarray, shape (n,)
        One step for each; of contacts and ratio [-], of h [s].
    seed : int
    """
    for i, value in enumerate(values):
        numbers = COMMON | {field: float(value)}
        rng = np.random.default_rng([seed, i, len(field)])
        step = slab_step(rng, int(numbers["contacts"]), numbers["ratio"], numbers["h"])
        name = f"{family}/{value:.6g}/{i}"
        yield Made(name, family, step, numbers["ratio"], 0, float(value))


def towers(bodies: list[int], seed: int) -> Iterator[Made]:
    """A tower of each number of bodies."""
    for i, count in enumerate(bodies):
        step = tower_step(np.random.default_rng([seed, i, 77]), count)
        yield Made(f"bodies/{count}/{i}", "bodies", step, 1.0, 0, float(count))
