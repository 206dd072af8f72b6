"""What one run of a sweep came to, in a few numbers."""

from __future__ import annotations

import numpy as np

from quasistatic_ref.simulate.measures import link_motion
from quasistatic_ref.simulate.scenario import Scenario
from quasistatic_ref.simulate.trajectory import Trajectory


def outcomes(
    scenario: Scenario, trajectory: Trajectory, link: str, since: float
) -> dict[str, float | None]:
    """Measured outcomes of one run.

    Parameters
    ----------
    scenario : Scenario
    trajectory : Trajectory
    link : str
        Whose motion is measured.
    since : float
        From when on [s].

    Returns
    -------
    dict
        ``rotation_deg`` (largest since then), ``rise_mm`` and ``travel_mm`` (from then to the
        end), ``deepest_um`` (largest penetration of any step), ``boundary_layer_um``,
        ``quasi_dynamic_number``, ``steps`` and ``exact`` (share of steps certified exactly).
    """
    motion = link_motion(scenario.system, trajectory, link)
    start = motion.index(since)
    way = motion.t[-1] - motion.t[start]
    phi = trajectory["phi"] if trajectory.steps else np.zeros(0)
    Pi = trajectory.header["quasi_dynamic_number"]
    exact = trajectory["certificate"] == "exact" if trajectory.steps else np.ones(1)
    return {
        "rotation_deg": float(np.degrees(motion.rotation_since(since)[start:].max())),
        "rise_mm": 1e3 * float(way[2]),
        "travel_mm": 1e3 * float(np.linalg.norm(way)),
        "deepest_um": 1e6 * max(0.0, float(-phi.min(initial=0.0))),
        "boundary_layer_um": 1e6 * float(trajectory.header["largest_boundary_layer"]),
        "quasi_dynamic_number": None if Pi is None else float(Pi),
        "steps": float(trajectory.steps),
        "exact": float(np.mean(exact)),
    }
