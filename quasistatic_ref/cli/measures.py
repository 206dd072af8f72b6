"""What a trajectory came to: how far a body turned, how high it rose."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

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
    R = np.array([pose.R for pose in poses])
    t = np.array([pose.t for pose in poses])
    times = np.concatenate([[0.0], trajectory["t"]])
    numbers = {link: system.link(link) for link in links}
    return {link: LinkMotion(times=times, R=R[:, i], t=t[:, i]) for link, i in numbers.items()}


def rotation_angle(R: Array) -> Array:
    """Angle of rotation matrices [rad], shape (...,), accurate near 0 and near pi.

    Parameters
    ----------
    R : ndarray, shape (..., 3, 3)
    """
    axial = np.stack(
        [
            R[..., 2, 1] - R[..., 1, 2],
            R[..., 0, 2] - R[..., 2, 0],
            R[..., 1, 0] - R[..., 0, 1],
        ],
        axis=-1,
    )
    trace = np.trace(R, axis1=-2, axis2=-1)
    return np.asarray(np.arctan2(np.linalg.norm(axial, axis=-1), trace - 1))


def worst_residual(trajectory: Trajectory) -> float | None:
    """Largest residual of all steps, in natural units [-]; None where none was computed."""
    residuals = trajectory["worst_residual"]
    if not residuals.size or np.isnan(residuals).any():
        return None
    return float(residuals.max())
