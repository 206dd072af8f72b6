"""Functions of time made of waypoints: targets of actuated joints, and external wrenches."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np

from quasistatic_ref.errors import ScenarioError
from quasistatic_ref.formats.plain import Plain
from quasistatic_ref.model.joints.axis_joint import AxisJoint
from quasistatic_ref.model.joints.joint import Joint
from quasistatic_ref.model.system import System
from quasistatic_ref.step.arrays import Array, freeze_copies


def piecewise_linear(times: Array, values: Array, t: float) -> Array:
    """Linear between waypoints, held before the first and after the last.

    Parameters
    ----------
    times : ndarray, shape (w,)
        Strictly increasing [s].
    values : ndarray, shape (w, d)
        [m, rad, -]
    t : float
        [s].

    Returns
    -------
    ndarray, shape (d,)
    """
    i, s = _interval(times, t)
    return np.asarray(values[i] if s == 0 else (1 - s) * values[i] + s * values[i + 1])


@dataclass(frozen=True, eq=False)
class JointTrack(Plain):
    """The target of one actuated joint: linear for scalar joints, geodesic for a base.

    Parameters
    ----------
    system : System
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

    system: System
    joint: Joint
    times: Array
    values: Array

    def __post_init__(self) -> None:
        freeze_copies(self, "times", "values")
        if not (np.diff(self.times) > 0).all():
            field = f"targets of {self.joint.name}"
            raise ScenarioError("waypoint times must increase", field=field, value=self.times)

    def at(self, t: float) -> Array:
        """The joint's entries of q at time t, shape (nq,)."""
        if isinstance(self.joint, AxisJoint):
            return np.array(self.joint.at(float(piecewise_linear(self.times, self.values, t)[0])))
        i, s = _interval(self.times, t)
        start = self._waypoints[i]
        if s == 0:
            return np.asarray(start[self.joint.q])
        # The geodesic of (+): a screw when the base both moves and turns.
        return np.asarray(self.system.integrate(start, s * self._ways[i])[self.joint.q])

    @cached_property
    def _waypoints(self) -> list[Array]:
        """Each as q, in which all else is neutral, shape (n_q,)."""
        return [self._placed(value) for value in self.values]

    @cached_property
    def _ways(self) -> list[Array]:
        """The displacement from each to the next, shape (n_v,)."""
        return [self.system.difference(*ends) for ends in pairwise(self._waypoints)]

    def _placed(self, value: Array) -> Array:
        q = self.system.neutral().copy()
        q[self.joint.q] = value
        return q


@dataclass(frozen=True, eq=False)
class Targets(Plain):
    """q_bar_a as a function of time.

    Parameters
    ----------
    q_a_start : ndarray, shape (n_q_a,)
        Held by every joint that has no track [m, rad, -].
    tracks : sequence of JointTrack
    """

    q_a_start: Array
    tracks: Sequence[JointTrack]

    def __post_init__(self) -> None:
        freeze_copies(self, "q_a_start")

    def __call__(self, t: float) -> Array:
        """q_bar_a at time t [s], shape (n_q_a,)."""
        q_bar_a = self.q_a_start.copy()
        for track in self.tracks:
            q_bar_a[track.joint.q] = track.at(t)
        return q_bar_a


def _interval(times: Array, t: float) -> tuple[int, float]:
    """Index of the waypoint before t, and how far t is towards the next, in [0, 1)."""
    i = int(np.searchsorted(times, t, side="right")) - 1
    if i < 0:
        return 0, 0.0
    if i >= len(times) - 1:
        return len(times) - 1, 0.0
    return i, float((t - times[i]) / (times[i + 1] - times[i]))
