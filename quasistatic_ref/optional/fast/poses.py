"""Where pinocchio writes the poses of links and the columns of Jacobians: C reads them there."""

import numpy as np

from quasistatic_ref.model.kinematics import Kinematics
from quasistatic_ref.model.system import System
from quasistatic_ref.model.workspace import WORLD_POSE
from quasistatic_ref.numbers.arrays import Array


class Poses:
    """A pinocchio workspace, its addresses, and the functions that move it to a configuration.

    Parameters
    ----------
    system : System

    Attributes
    ----------
    q : ndarray, shape (n_q,)
        The configuration whose poses are written.
    R, t : ndarray of int, shape (L,)
        Addresses of each link's rotation, by columns, and of its origin; the world's first.
    columns : ndarray of int, shape (n_x,)
        Addresses of the Jacobian's columns, velocity before angular velocity.
    gravity : ndarray of int, shape (n_v,)
        Addresses of the entries of g, the gravity term in M dv + g = tau, in the paper's order.
    """

    def __init__(self, system: System) -> None:
        self._workspace = system.workspace()
        self._column_map = system.column_map
        self._order = system.column_map.order
        self.q = system.q_start.copy()
        R = [WORLD_POSE[0]]
        t = [WORLD_POSE[1]]
        columns: list[int] = []
        gravity: list[int] = []
        for part in self._workspace.parts:
            R += part.R
            t += part.t
            J = part.data.J.reshape(6, -1, order="F")
            assert J.strides[0] == 8
            of_J = J.ctypes.data
            of_g = part.data.g.ctypes.data
            columns += [of_J + J.strides[1] * i for i in range(J.shape[1])]
            gravity += [of_g + 8 * i for i in range(part.model.nv)]
        assert all(one.strides == (8, 24) for one in R[1:])
        self.R = np.array([one.ctypes.data for one in R])
        self.t = np.array([one.ctypes.data for one in t])
        self.columns = np.array(columns, np.int64)
        self.gravity = np.array(gravity, np.int64)[self._order.v]
        self._q_parts: list[Array] = []
        self._at: bytes | None = None
        self._kinematics: Kinematics | None = None

    def move(self, q: Array) -> None:
        """Write the poses of a configuration (n_q,), unless the last call wrote the same."""
        at = q.tobytes()
        if at == self._at:
            return
        self._at = None  # of a failure
        self._kinematics = None
        self.q[:] = q
        self._q_parts = self._workspace.q_parts(q)
        self._workspace.move(self._q_parts)
        self._at = at

    def kinematics(self) -> Kinematics:
        """The kinematics of the configuration whose poses are written."""
        if self._kinematics is None:
            self._kinematics = Kinematics(*self._workspace.poses(), self._column_map)
        return self._kinematics

    def weigh(self, gravity: tuple[float, ...]) -> None:
        """Compute the force of gravity [m/s^2] at the configuration whose poses are written."""
        self._workspace.gravity_torque(self._q_parts, gravity)
