"""Functions of time made of waypoints: targets of actuated joints, and external wrenches."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Protocol, runtime_checkable

import numpy as np

from quasistatic_ref.errors import ScenarioError
from quasistatic_ref.model.joints.axis_joint import AxisJoint
from quasistatic_ref.model.joints.joint import Joint
from quasistatic_ref.model.kinematics import Kinematics
from quasistatic_ref.model.system import System
from quasistatic_ref.numbers.arrays import Array, Indices, freeze_copies
from quasistatic_ref.numbers.ordered import total
from quasistatic_ref.text.plain import Plain


def piecewise_linear(times: Array, values: Array, t: float | Array) -> Array:
    """Linear between waypoints, held before the first and after the last.

    Parameters
    ----------
    times : ndarray, shape (w,)
        Strictly increasing [s].
    values : ndarray, shape (w, d)
        [m, rad, -]
    t : float or ndarray, shape (...)
        [s].

    Returns
    -------
    ndarray, shape (..., d)
    """
    i, s = _interval(times, t)
    after = values[np.minimum(i + 1, len(times) - 1)]
    s = s[..., None]
    return np.where(s == 0, values[i], (1 - s) * values[i] + s * after)


@dataclass(frozen=True, eq=False)
class JointTrack(Plain):
    """The target of one actuated joint: linear for scalar joints, geodesic for a base.

    Parameters
    ----------
    joint : Joint
    times : ndarray, shape (w,)
        Strictly increasing [s].
    values : ndarray, shape (w, nq)
        The joint's entries of q [m, rad, -]; an angle, shape (w, 1), for a continuous joint.

    Raises
    ------
    ScenarioError
        If the times do not increase.
    """

    joint: Joint
    times: Array
    values: Array

    def __post_init__(self) -> None:
        freeze_copies(self, "times", "values")
        if not (np.diff(self.times) > 0).all():
            field = f"targets of {self.joint.name}"
            raise ScenarioError(
                "waypoint times must increase", field=field, value=self.times.tolist()
            )

    def over(self, t: Array) -> Array:
        """The joint's entries of q at times t, shape (T,): shape (T, nq)."""
        joint = self.joint
        if isinstance(joint, AxisJoint):
            positions = piecewise_linear(self.times, self.values, t)[:, 0]
            rows = [joint.at(position) for position in positions.tolist()]
            return np.reshape(rows, (len(t), joint.q.stop - joint.q.start)).astype(np.float64)
        intervals, shares = _interval(self.times, t)
        start = self.values[intervals]
        ways = shares[:, None] * self._ways[intervals]
        with np.errstate(all="ignore"):  # as plain arithmetic
            # The geodesic of (+): a screw when the base both moves and turns.
            within = joint.integrated([*start.T.copy()], [*ways.T.copy()])
        return np.where(shares[:, None] == 0, start, np.stack(within, axis=1))

    @cached_property
    def _ways(self) -> Array:
        """The displacement from each waypoint to the next, none from the last, shape (w, n_v)."""
        ways = [self.joint.change(*ends) for ends in pairwise(self.values.tolist())]
        return np.array([*ways, [0.0] * len(self.joint.coordinates)])


@runtime_checkable
class Drives(Protocol):
    """Targets by columns of a table, some of which may drive nothing.

    Attributes
    ----------
    idle : tuple of str
        Names of those columns.
    """

    idle: tuple[str, ...]


@dataclass(frozen=True, eq=False)
class Targets(Plain):
    """q_bar_a as a function of time.

    ``scenario.targets`` are such; their constructor checks nothing.

    Parameters
    ----------
    q_a_start : ndarray, shape (n_q_a,)
        Held by every joint that has no track [m, rad, -].
    tracks : sequence of JointTrack

    Examples
    --------
    >>> targets: qr.Targets = qr.load_scenario("two_finger_pinch").targets
    >>> targets(0.0).shape
    (4,)
    """

    q_a_start: Array
    tracks: Sequence[JointTrack]

    def __post_init__(self) -> None:
        freeze_copies(self, "q_a_start")

    def __call__(self, t: float) -> Array:
        """q_bar_a at time t [s], shape (n_q_a,)."""
        return np.asarray(self.over(np.array([t]))[0])

    def over(self, t: Array) -> Array:
        """q_bar_a at times t, shape (T,) [s]: shape (T, n_q_a)."""
        q_bar_a = np.tile(self.q_a_start, (len(t), 1))
        for track in self.tracks:
            q_bar_a[:, track.joint.q] = track.over(t)
        return q_bar_a


@dataclass(frozen=True, eq=False)
class Wrenches(Plain):
    """An external wrench at the centre of mass of a body's root link, piecewise linear in time.

    It is held before its first time, from the run's start, and after its last.

    Parameters
    ----------
    body : str
    times : ndarray, shape (w,)
        [s].
    values : ndarray, shape (w, 6)
        Force [N] and torque [N m], world frame.
    """

    body: str
    times: Array
    values: Array

    def __post_init__(self) -> None:
        freeze_copies(self, "times", "values")

    def force(self, system: System, t: float, kinematics: Kinematics) -> Array:
        """Generalised force at time t [s], shape (n_v,) [N, N m]."""
        wrench = piecewise_linear(self.times, self.values, t)
        return system.load_at(kinematics, self.body, wrench[:3], wrench[3:])


@dataclass(frozen=True, eq=False)
class Loads:
    """The generalised force of wrenches as a function of time and configuration.

    Parameters
    ----------
    system : System
    wrenches : sequence of Wrenches
    """

    system: System
    wrenches: Sequence[Wrenches]

    def __call__(self, t: float, q: Array) -> Array:
        """The force of the step to time t [s] from q, shape (n_v,)."""
        kinematics = self.system.kinematics(q)
        return total(wrench.force(self.system, t, kinematics) for wrench in self.wrenches)


def _interval(times: Array, t: float | Array) -> tuple[Indices, Array]:
    """Index of the waypoint before each t, and how far t is towards the next, in [0, 1)."""
    last = len(times) - 1
    i = np.clip(np.searchsorted(times, t, side="right") - 1, 0, last)
    length = np.append(np.diff(times), np.inf)[i]
    return i, np.maximum((t - times[i]) / length, 0.0)
