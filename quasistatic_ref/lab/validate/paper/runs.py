"""Runs of the scenarios that come along, each made once for all claims that look at it."""

from __future__ import annotations

from functools import cache

from quasistatic_ref.lab.grasp import CASES
from quasistatic_ref.simulate.scenario import Scenario, load_scenario
from quasistatic_ref.simulate.trajectory import Trajectory


@cache
def grasp(case: str) -> tuple[Scenario, Trajectory]:
    """``bunny_grasp``, ``"with torsion"`` or ``"without torsion"``."""
    scenario = load_scenario("bunny_grasp", CASES[case])
    return scenario, scenario.run(progress=False)
