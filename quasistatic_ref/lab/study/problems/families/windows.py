"""Sequences: steps of a scenario's run one after the other, to be solved in order."""

from collections.abc import Iterator

import numpy as np

from quasistatic_ref.lab.digits import correct_digits
from quasistatic_ref.lab.study.problems.families.harvest import Count, scenario_run
from quasistatic_ref.lab.study.problems.families.made import Made, mass_ratio
from quasistatic_ref.simulate.trajectory import Trajectory
from quasistatic_ref.step.data import Mask

LENGTH = 12
"""Steps of a sequence."""
STRIDES = (1, 1, 4, 16)
"""How far apart the steps of a scenario's sequences are: consecutive ones, and coarser samples."""
STILL = 6.0
"""Correct digits of the last answer again from which a step asks for nothing new [-]."""
FEW = 2
"""Still steps of a sequence at most; a run without such a sequence has none."""


def windows(name: str, count: Count) -> Iterator[Made]:
    """Sequences of a scenario that move, at most one for each stride, where contacts change most.

    Parameters
    ----------
    name : str
    count : callable
        Is called with the number of steps that were just simulated.
    """
    scenario, run = scenario_run(name, count)
    k = max(pair.k for pair in scenario.pairs)
    taken: list[set[int]] = []
    for i, wanted in enumerate(STRIDES):
        stride = min(wanted, (run.steps - 1) // (LENGTH - 1))
        steps = _busiest(run, stride, taken)
        taken.append(set(steps))
        for place, s in enumerate(steps):
            step = run.step_data(s)
            yield Made(
                f"moving/{name},every {stride}/{i}.{place:02d}", "moving", step,
                mass_ratio(step), k, float(stride), sequence=(f"{name}/{i}", place),
            )  # fmt: skip


def _busiest(run: Trajectory, stride: int, taken: list[set[int]]) -> list[int]:
    """The window of few still steps, and of these with fewest, that changes most pressed rows.

    Windows share a step or two at most. Empty if there is none.
    """
    pressed = np.nan_to_num(run["lam"].reshape(run.steps, -1)) > 0
    still = still_steps(run, stride)
    best = (-FEW - 1, -1)
    found: list[int] = []
    for first in range(run.steps - stride * (LENGTH - 1)):
        steps = [first + stride * place for place in range(LENGTH)]
        if any(len(other & set(steps)) > 2 for other in taken):
            continue
        changes = int((pressed[steps[1:]] != pressed[steps[:-1]]).sum())
        score = (-int(still[steps[1:]].sum()), changes)
        if score > best:
            best = score
            found = steps
    return found


def still_steps(run: Trajectory, stride: int) -> Mask:
    """Whether the answer so many steps before has six digits of that of each step, shape (steps,).

    The first steps, which have none before, are not still.
    """
    x = run["delta_q"]
    still = np.zeros(run.steps, dtype=bool)
    for s in range(stride, run.steps):
        still[s] = correct_digits(run.step_data(s), x[s - stride], x[s]) >= STILL
    return still
