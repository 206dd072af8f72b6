"""What a trajectory came to: how far a body turned, how high it rose."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from quasistatic_ref.model.rotation import rotation_angle
from quasistatic_ref.model.system import System
from quasistatic_ref.simulate.trajectory import Trajectory
from quasistatic_ref.step.data import Array


@dataclass(frozen=True, eq=False)
class LinkMotion:
    """Poses of one link along a trajectory, the start included.

    Parameters
    ----------
    times : ndarray, shape (steps + 1,)
        [s], from 0.
    R : ndarray, shape (steps + 1, 3, 3)
    t : ndarray, shape (steps + 1, 3)
        [m], world frame.
    """

    times: Array
    R: Array
    t: Array

    def rotation_since(self, time: float) -> Array:
        """Angle [rad] of each orientation from that at `time` [s], shape (steps + 1,)."""
        reference = self.R[self.index(time)]
        return rotation_angle(self.R @ reference.T)

    def index(self, time: float) -> int:
        """Index of the instant nearest to `time` [s]."""
        return int(np.abs(self.times - time).argmin())


def link_motion(system: System, trajectory: Trajectory, link: str) -> LinkMotion:
    """Poses of a link (or of a body's root link) along a trajectory."""
    i = system.link(link)
    poses = [system.kinematics(q) for q in trajectory["q"]]
    return LinkMotion(
        times=np.concatenate([[0.0], trajectory["t"]]),
        R=np.array([pose.R[i] for pose in poses]),
        t=np.array([pose.t[i] for pose in poses]),
    )
