"""Times that can be compared: taken in turn, in one process, as medians."""

import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any

import numpy as np

from quasistatic_ref.numbers.arrays import Array

Job = Callable[[], Any]
Clock = Callable[[], float]


def seconds(job: Job, clock: Clock = time.perf_counter) -> float:
    """Time of one call [s]."""
    start = clock()
    job()
    return clock() - start


def in_turn(
    rounds: Sequence[Mapping[str, Job]], repeat: int = 1, clock: Clock = time.perf_counter
) -> dict[str, Array]:
    """Times of several jobs that take turns, each round in the order given.

    Parameters
    ----------
    rounds : sequence of mapping of str to callable
        The same names in every round.
    repeat : int
        How often all rounds are gone through; of each job and round the least time is kept, which
        other processes have disturbed least.
    clock : callable
        Wall time, or the processor time of this thread, which means over many calls need on a
        machine that has other things to do.

    Returns
    -------
    dict of str to ndarray, shape (rounds,)
        [s].
    """
    return least(_once_in_turn(rounds, clock) for _ in range(repeat))


def _once_in_turn(rounds: Sequence[Mapping[str, Job]], clock: Clock) -> dict[str, Array]:
    taken = [{name: seconds(job, clock) for name, job in jobs.items()} for jobs in rounds]
    return {name: np.array([times[name] for times in taken]) for name in rounds[0]}


def least(runs: Iterable[Mapping[str, Array]]) -> dict[str, Array]:
    """Of each job and round the least time in several runs, by name, shape (rounds,) [s]."""
    every = [*runs]
    return {name: np.minimum.reduce([times[name] for times in every]) for name in every[0]}


def microseconds(times: Array) -> float:
    """The median [us] of `times` (n,) [s]."""
    return 1e6 * float(np.median(times))
