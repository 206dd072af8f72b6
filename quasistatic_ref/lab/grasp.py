"""The grasp of the bunny, the paper's section III-B: its two cases and what a run came to."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from quasistatic_ref.cli.run import worst_residual
from quasistatic_ref.errors import ScenarioError
from quasistatic_ref.files.scenario.scenario import Scenario, load_scenario
from quasistatic_ref.simulate.record.motions import LinkMotion, link_motion
from quasistatic_ref.simulate.record.trajectory import Trajectory, certified

CASES: dict[str, list[str]] = {
    "with torsion": [],
    "without torsion": ["contacts.grip.mu_omega=0"],
}
"""Changes of the scenario ``bunny_grasp``."""

CLOSED, TOP = 0.7, 2.9
"""When the grip is closed, and when the lift ends [s]; see bunny_grasp.toml."""

INSTANTS = (0.3, 1.4, TOP)
"""Columns of Figure 1 [s]."""


def grasp_scenarios(settings: Sequence[str] = ()) -> dict[str, Scenario]:
    """Both cases with settings of the user's own, as ``key=value``.

    What makes a case comes last, so that no setting undoes it.

    Raises
    ------
    ScenarioError
        If a setting is refused, or a run would end before the lift does.
    """
    scenarios = {
        case: load_scenario("bunny_grasp", [*settings, *changes]) for case, changes in CASES.items()
    }
    for scenario in scenarios.values():
        end = scenario.steps * scenario.h
        if end < TOP - scenario.h / 2:
            raise ScenarioError(
                f"end at t = {end:g} s; the comparison needs the whole lift, until {TOP:g} s: "
                "set more of them",
                field="steps",
                value=scenario.steps,
            )
    return scenarios


def lift_motion(scenario: Scenario, run: Trajectory) -> tuple[LinkMotion, slice]:
    """The bunny's motion in a run, and its steps from the closed grip to the top."""
    motion = link_motion(scenario.system, run, "bunny")
    return motion, slice(motion.index(CLOSED), motion.index(TOP) + 1)


def rotations(scenario: Scenario, runs: Mapping[str, Trajectory]) -> dict[str, Any]:
    """The bunny's rotation during the lift, since the grip closed.

    Parameters
    ----------
    scenario : Scenario
        Its bodies; the runs may differ from it in contact numbers only.
    runs : mapping of str to Trajectory
        Case -> run.

    Returns
    -------
    dict
        times [s], angles [deg] by case, and h [s].
    """
    motions = {case: lift_motion(scenario, run) for case, run in runs.items()}
    first, steps = next(iter(motions.values()))
    return {
        "times": first.times[steps],
        "angles": {c: np.degrees(m.rotation_since(CLOSED)[steps]) for c, (m, _) in motions.items()},
        "h": scenario.h,
    }


def grasp_report(scenario: Scenario, trajectory: Trajectory) -> dict[str, object]:
    """Rotation, lift height and further numbers of one run of the grasp, during the lift.

    Returns
    -------
    dict
        rotation_deg (largest since the grip closed), lift_mm, variables, rows, worst_residual
        (natural units), findings, and the milliseconds of each part of a step.
    """
    motion, steps = lift_motion(scenario, trajectory)
    z = motion.t[steps, 2]
    parts = {f"{part}_ms": 1e3 * float(np.mean(s)) for part, s in trajectory.seconds.items()}
    return {
        "steps": trajectory.steps,
        "certified": certified(trajectory),
        "variables": trajectory["A"].shape[2],
        "rows": trajectory["A"].shape[1],
        "rotation_deg": float(np.degrees(motion.rotation_since(CLOSED)[steps].max())),
        "lift_mm": 1e3 * float(z[-1] - z[0]),
        "worst_residual": worst_residual(trajectory),
        "findings": [str(finding) for finding in trajectory.findings],
        **parts,
    }
