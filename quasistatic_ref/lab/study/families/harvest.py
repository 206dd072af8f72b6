"""Problems met in the scenarios that come along: at their own settings, and at others."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from quasistatic_ref.contact.distance import closest_points
from quasistatic_ref.lab.runs import ran
from quasistatic_ref.lab.study.families.made import Made, mass_ratio
from quasistatic_ref.simulate.scenario import load_scenario
from quasistatic_ref.step.data import StepData

POSES = 40
"""Configurations of a run at which a scenario is asked again with another h or k."""


def harvested(name: str, count: int) -> Iterator[Made]:
    """Steps of a scenario's run, evenly spaced and never twice.

    Parameters
    ----------
    name : str
    count : int
        At most so many.
    """
    scenario, run = ran(name)  # exact: the same bits whatever the solvers
    steps = np.unique(np.linspace(0, run.steps - 1, min(count, run.steps)).round().astype(int))
    for s in steps:
        step = run.step_data(int(s))
        k = max(pair.k for pair in scenario.pairs)
        yield Made(f"{name}/{s}", name, step, mass_ratio(step), k)


def asked_again(
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
    _, run = ran(name)
    other = load_scenario(name, settings)
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
