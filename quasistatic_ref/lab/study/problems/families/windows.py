"""Sequences: steps of a scenario's run one after the other, to be solved in order."""

from collections.abc import Iterator

import numpy as np

from quasistatic_ref.lab.study.problems.families.harvest import Count, no_count, scenario_run
from quasistatic_ref.lab.study.problems.families.made import Made, mass_ratio
from quasistatic_ref.simulate.trajectory import Trajectory

LENGTH = 12
"""Steps of a sequence."""
STRIDES = (1, 1, 4, 16)
"""How far apart the steps of a scenario's sequences are: consecutive ones, and coarser samples."""


def windows(
    name: str, strides: tuple[int, ...] = STRIDES, count: Count = no_count
) -> Iterator[Made]:
    """Sequences of a scenario, one for each stride, where contacts change most.

    Parameters
    ----------
    name : str
    strides : tuple of int
        In steps of the run; smaller where the run is too short.
    count : callable
        Is called with the number of steps that were just simulated.
    """
    scenario, run = scenario_run(name, count)
    k = max(pair.k for pair in scenario.pairs)
    taken: list[set[int]] = []
    for i, wanted in enumerate(strides):
        stride = min(wanted, (run.steps - 1) // (LENGTH - 1))
        steps = _busiest(run, stride, taken)
        taken.append(set(steps))
        for place, s in enumerate(steps):
            step = run.step_data(s)
            yield Made(
                f"sequences/{name},every {stride}/{i}.{place:02d}", "sequences", step,
                mass_ratio(step), k, float(stride), sequence=(f"{name}/{i}", place),
            )  # fmt: skip


def _busiest(run: Trajectory, stride: int, taken: list[set[int]]) -> list[int]:
    """The window with fewest steps at rest, and then with most changes of pressed rows.

    Windows share a step or two at most.
    """
    pressed = np.nan_to_num(run["lam"].reshape(run.steps, -1)) > 0
    rest = ~np.any(run["delta_q"] != 0, axis=1)
    best, found = (-1, -1), list(range(0, LENGTH * stride, stride))
    for first in range(run.steps - stride * (LENGTH - 1)):
        steps = [first + stride * place for place in range(LENGTH)]
        if any(len(other & set(steps)) > 2 for other in taken):
            continue
        changes = int((pressed[steps[1:]] != pressed[steps[:-1]]).sum())
        score = (int((~rest[steps]).sum()), changes)
        if score > best:
            best, found = score, steps
    return found
