"""Both runs of the grasp, each made once for all that look at it."""

from functools import cache

from quasistatic_ref.files.scenario.scenario import Scenario, load_scenario
from quasistatic_ref.lab.grasp import CASES, lift_motion
from quasistatic_ref.simulate.record.motions import LinkMotion
from quasistatic_ref.simulate.record.trajectory import Trajectory


@cache
def grasp(case: str) -> tuple[Scenario, Trajectory]:
    """The run of ``bunny_grasp`` ``"with torsion"`` or ``"without torsion"``, made once."""
    scenario = load_scenario("bunny_grasp", CASES[case], fast=True)
    return scenario, scenario.run(progress=False, findings=False)


def lift(case: str) -> tuple[LinkMotion, slice]:
    """The bunny's motion in a case of the grasp, and its steps from the closed grip to the top."""
    return lift_motion(*grasp(case))
