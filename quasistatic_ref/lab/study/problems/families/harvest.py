"""Problems met in the scenarios that come along: at their own settings, and at others."""

from collections.abc import Callable, Iterator
from functools import cache

import numpy as np

from quasistatic_ref.contact.distance import closest_points
from quasistatic_ref.errors import RunFailed
from quasistatic_ref.lab.study.problems.families.made import Made, mass_ratio
from quasistatic_ref.scenario.scenario import Scenario, load_scenario
from quasistatic_ref.simulate.rollout import rollout
from quasistatic_ref.simulate.trajectory import Trajectory
from quasistatic_ref.step.data import Array, StepData

POSES = 40
"""Configurations of a run at which a scenario's step is formed again with another h or k."""


Count = Callable[[int], object]
_RUNS: dict[str, Trajectory] = {}


def no_count(steps: int) -> None:
    """Count nothing."""


@cache
def scenario_of(name: str) -> Scenario:
    """A scenario by name, loaded once."""
    return load_scenario(name, fast=True)


def scenario_run(name: str, count: Count = no_count) -> tuple[Scenario, Trajectory]:
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


def harvested(name: str, count: int) -> Iterator[Made]:
    """Steps of a scenario's run, evenly spaced and never twice.

    Parameters
    ----------
    name : str
    count : int
        At most so many.
    """
    scenario, run = scenario_run(name)
    steps = np.unique(np.linspace(0, run.steps - 1, min(count, run.steps)).round().astype(int))
    for s in steps:
        step = run.step_data(int(s))
        k = max(pair.k for pair in scenario.pairs)
        yield Made(f"scenarios/{name}/{s}", "scenarios", step, mass_ratio(step), k)


def stepped_again(
    family: str, name: str, settings: list[str], count: int, first: int
) -> Iterator[Made]:
    """A scenario with other settings, at configurations of its own run.

    Parameters
    ----------
    family : str
    name : str
    settings : list of str
        Changes that leave q alone, such as ``h=0.001`` or ``contacts.grip.k=20``.
    count : int
    first : int
        Which of the configurations comes first, so that families do not all ask at the same ones.
    """
    _, run = scenario_run(name)
    other = load_scenario(name, settings, fast=True)
    simulator, words = other.simulator(), ",".join(settings)
    for i in range(count):
        s = int((first + i) * 7919 % run.steps)  # scattered, and the same every time
        q, t = run["q"][s], s * float(run.header["h"]) + other.h
        kinematics = other.system.kinematics(q)
        points = closest_points(simulator.pairs, kinematics)
        force = 0.0 if other.force is None else other.force(t, q)
        step: StepData = simulator.step_data(q, other.targets(t), force, points, kinematics)
        k = max(pair.k for pair in other.pairs)
        yield Made(f"{family}/{name},{words}/{s}", family, step, mass_ratio(step), k)
