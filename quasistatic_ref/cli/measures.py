"""What a trajectory came to: how far a body turned, how high it rose."""

from collections.abc import Sequence
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

    @property
    def largest_rotation(self) -> float:
        """Largest angle [rad] from the orientation at the start."""
        return float(self.rotation_since(0.0).max())

    @property
    def largest_rise(self) -> float:
        """How far the origin was above its start at most, along the world's z [m]; 0 at least."""
        return float((self.t[:, 2] - self.t[0, 2]).max())


def link_motion(system: System, trajectory: Trajectory, link: str) -> LinkMotion:
    """Poses of a link (or of a body's root link) along a trajectory."""
    return _motions(system, trajectory, (link,))[link]


def free_body_motions(system: System, trajectory: Trajectory) -> dict[str, LinkMotion]:
    """Motion of each body that nothing drives: whose base is floating or planar and free."""
    bases = [j for j in system.joints if j.kind in ("floating", "planar") and not j.actuated]
    return _motions(system, trajectory, [joint.name.removesuffix("/base") for joint in bases])


def _motions(system: System, trajectory: Trajectory, links: Sequence[str]) -> dict[str, LinkMotion]:
    poses = [system.kinematics(q) for q in trajectory["q"]]
    R, t = np.array([pose.R for pose in poses]), np.array([pose.t for pose in poses])
    times = np.concatenate([[0.0], trajectory["t"]])
    at = {link: system.link(link) for link in links}
    return {link: LinkMotion(times=times, R=R[:, i], t=t[:, i]) for link, i in at.items()}
