"""One grasp with a cloud of the bunny: what became of it, and what its closed grip foretold."""

import tempfile
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from quasistatic_ref.lab.grasp import CLOSED, TOP, lift_motion
from quasistatic_ref.lab.log import Record
from quasistatic_ref.scenario.scenario import Scenario, load_scenario
from quasistatic_ref.simulate.failures import RunFailed
from quasistatic_ref.simulate.trajectory import Trajectory
from quasistatic_ref.step.data import Array

LOADED = 1e-6
"""A point bears load above this force [N]: the weight is 2 N."""
STEPS = 290
"""To the end of the lift."""
FINGERS = ("left", "right")
LIFTING = 0.04 / (TOP - CLOSED)
"""Speed of the lift [m/s]; see bunny_grasp.toml."""


@dataclass(frozen=True)
class Grip:
    """The closed grip, just before the lift.

    Parameters
    ----------
    squeeze : float
        Normal force of a finger, the mean of both [N].
    lever : float
        Horizontal distance of the centre of mass from the line through the middles of the two
        loads [m].
    points : int
        Points that bear load, of both fingers.
    spread : float
        mu_omega that the points of both fingers have by mu_v alone, (R15) [m]: mu_v times the mean
        distance of the loads from their middle.
    needed : float
        mu_omega that holds the weight and the drag of the lift, (R14) [m]; infinite where the
        squeeze does not even bear the weight.
    """

    squeeze: float
    lever: float
    points: int
    spread: float
    needed: float


def grasp_record(cloud: Array, settings: Mapping[str, Any]) -> Record:
    """Run ``bunny_grasp`` to the end of the lift with another cloud.

    Parameters
    ----------
    cloud : ndarray, shape (N, 3)
        [m], in the bunny's frame.
    settings : mapping
        Changes of the scenario, by dotted key.

    Returns
    -------
    dict
        ``failed``: whether a step had no solution, or left the scene's limits; ``rotation``: the
        largest of the bunny during the lift [deg]; ``lift``: how high its origin rose [mm];
        ``certified``: share of the steps that are certified exactly [-]; and the fields of its
        grip, where both fingers bore load.
    """
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "cloud.npz"
        np.savez(path, points=cloud)
        changes = {"bodies.bunny.cloud": str(path), "steps": STEPS}
        scenario = load_scenario("bunny_grasp", {**settings, **changes}, fast=True)
    failed = False
    try:
        run = scenario.run(progress=False)
    except RunFailed as failure:
        failed = True
        run = failure.trajectory
    motion, steps = lift_motion(scenario, run)
    z = motion.t[steps, 2]
    grip = _grip(scenario, run, steps.start)
    return {
        "failed": failed,
        "rotation": float(np.degrees(motion.rotation_since(CLOSED)[steps].max())),
        "lift": 1e3 * float(z[-1] - z[0]),
        "certified": float(np.mean(run["certificate"] == "exact")),
        **(vars(grip) if grip else {}),
    }


def _grip(scenario: Scenario, run: Trajectory, step: int) -> Grip | None:
    """The grip in the last step before the lift."""
    if run.steps < step:
        return None
    names = run.header["contacts"][step - 1]
    loads = run["wrench"][step - 1, :, 2]
    points = run["beta"][step - 1]
    middles = []
    squeezes = []
    spreads = []
    loaded = 0
    for finger in FINGERS:
        on_finger = np.array([f"{finger}_finger" in name for name in names])
        bearing = on_finger & (loads > LOADED)
        if not bearing.any():
            return None
        share = loads[bearing] / loads[bearing].sum()
        middle = share @ points[bearing]
        middles.append(middle)
        squeezes.append(float(loads[bearing].sum()))
        spreads.append(float(share @ np.linalg.norm(points[bearing] - middle, axis=1)))
        loaded += int(bearing.sum())
    mu_v = float(run["mu_v"][on_finger].max())
    squeeze = float(np.mean(squeezes))
    lever = _lever(scenario, run["q"][step], np.array(middles))
    spare = 2 * squeeze / _load(scenario) - 1 / mu_v
    needed = lever / spare if spare > 0 else np.inf
    return Grip(squeeze, lever, loaded, mu_v * float(np.mean(spreads)), needed)


def _lever(scenario: Scenario, q: Array, middles: Array) -> float:
    """Horizontal distance of the bunny's centre of mass from the line through two points [m]."""
    system = scenario.system
    kinematics = system.kinematics(q)
    link = system.link("bunny")
    centre = kinematics.t[link] + kinematics.R[link] @ system.centres[link]
    along = middles[1, :2] - middles[0, :2]
    across = np.array([-along[1], along[0]]) / np.linalg.norm(along)
    return float(abs(across @ (centre - middles[0])[:2]))


def _load(scenario: Scenario) -> float:
    """Weight of the bunny and drag m v / h of the lift [N], (R13)."""
    mass = scenario.system.mass("bunny")
    return mass * (float(np.linalg.norm(scenario.gravity)) + LIFTING / scenario.h)
