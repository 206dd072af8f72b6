"""How a link moved along a trajectory: how far it turned, how high it rose."""

from dataclasses import dataclass, replace

import numpy as np

from quasistatic_ref.errors import check_kind
from quasistatic_ref.model.mechanism import Mechanism
from quasistatic_ref.model.system import System
from quasistatic_ref.numbers.arrays import Array, checked_array
from quasistatic_ref.simulate.record.trajectory import Trajectory


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
    check_kind(system, Mechanism, "system", "a System")
    check_kind(trajectory, Trajectory, "trajectory", "a Trajectory")
    number = system.link(link)
    poses = [system.kinematics(q) for q in trajectory["q"]]
    R = np.array([pose.R[number] for pose in poses])
    t = np.array([pose.t[number] for pose in poses])
    return LinkMotion(times=np.concatenate([[0.0], trajectory["t"]]), R=R, t=t)


def relative_turn(
    system: System, trajectory: Trajectory, link: str, to: str, since: float = 0.0
) -> Array:
    """The rotation of a link relative to another link, such as of an object in a hand.

    Parameters
    ----------
    system : System
    trajectory : Trajectory
    link, to : str
        Names of links, or of bodies, whose root links are meant.
    since : float
        The time from which the turn counts [s].

    Returns
    -------
    ndarray, shape (steps + 1,)
        Angles from 0 to pi [rad], the start included.

    Examples
    --------
    >>> scenario = qr.load_scenario("block_push", steps=2)
    >>> run = scenario.run(progress=False)
    >>> qr.relative_turn(scenario.system, run, "block", "block")
    array([0., 0., 0.])
    """
    since = float(checked_array(since, "since", ()))
    motion = link_motion(system, trajectory, link)
    back = link_motion(system, trajectory, to).R.swapaxes(1, 2)
    return replace(motion, R=back @ motion.R).rotation_since(since)


def rotation_angle(R: Array) -> Array:
    """Angle of rotation matrices [rad], shape (...,), accurate near 0 and near pi.

    Parameters
    ----------
    R : ndarray, shape (..., 3, 3)
    """
    from scipy.spatial.transform import Rotation  # takes as long as a short run

    angles = Rotation.from_matrix(R.reshape(-1, 3, 3)).magnitude()
    return np.asarray(angles).reshape(R.shape[:-2])
