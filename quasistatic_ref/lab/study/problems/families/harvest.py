"""Problems met in the scenarios that come along."""

from collections.abc import Callable, Iterator, Sequence
from functools import cache

import numpy as np

from quasistatic_ref.errors import RunFailed
from quasistatic_ref.lab.study.problems.families.made import Made, mass_ratio
from quasistatic_ref.scenario.scenario import Scenario, load_scenario
from quasistatic_ref.simulate.rollout import rollout
from quasistatic_ref.simulate.trajectory import Trajectory
from quasistatic_ref.step.data import Array

Count = Callable[[int], object]
_RUNS: dict[str, Trajectory] = {}


@cache
def scenario_of(name: str) -> Scenario:
    """A scenario by name, loaded once."""
    return load_scenario(name, fast=True)


def scenario_run(name: str, count: Count) -> tuple[Scenario, Trajectory]:
    """A scenario and its run, each step exact: the same bits whatever the machine's solvers.

    Parameters
    ----------
    name : str
    count : callable
        Is called with the number of steps that were just simulated.

    Raises
    ------
    KeyboardInterrupt
        Between two steps, after Ctrl-C.
    RunFailed
        If a step fails.
    """
    scenario = scenario_of(name)
    if name in _RUNS:
        count(scenario.steps)
        return scenario, _RUNS[name]

    def target(t: float) -> Array:
        count(1)
        return scenario.targets(t)

    try:
        _RUNS[name] = rollout(scenario.simulator(), scenario.system.q_start, target, scenario.steps,
                              force=scenario.force, record=scenario.record,
                              progress=False)  # fmt: skip
    except RunFailed as failure:
        if isinstance(failure.__cause__, KeyboardInterrupt):
            raise KeyboardInterrupt from None
        raise
    return scenario, _RUNS[name]


def harvested(names: Sequence[str], total: int, count: Count) -> Iterator[Made]:
    """Steps of the runs of scenarios, evenly spaced and never twice.

    Parameters
    ----------
    names : sequence of str
    total : int
        At most so many, shared among the scenarios.
    count : callable
        Is called with the number of steps that were just simulated.
    """
    for i, name in enumerate(names[:total]):
        scenario, run = scenario_run(name, count)
        share = total // len(names) + (i < total % len(names))
        last = run.steps - 1
        steps = np.unique(np.linspace(0, last, min(share, run.steps)).round().astype(int))
        for s in steps:
            step = run.step_data(int(s))
            k = max(pair.k for pair in scenario.pairs)
            yield Made(f"scenarios/{name}/{s}", "scenarios", step, mass_ratio(step), k)
