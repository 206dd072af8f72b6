"""A system at one configuration: what a step asks of it."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from quasistatic_ref.model.kinematics import Kinematics
from quasistatic_ref.numbers.arrays import Array, read_only
from quasistatic_ref.quoting import shown_value


class State(ABC):
    """A configuration that has been checked, and what follows from it; ``system.at(q)`` makes it.

    Each is formed once, when it is asked for.

    Parameters
    ----------
    system : Mechanism
    q : ndarray, shape (n_q,)
        The configuration, checked [m, rad, -]; a copy, read-only.

    Examples
    --------
    >>> ball = qr.Body.of_shape("ball", qr.Sphere(0.05), mass=0.3, xyz=(0, 0, 0.05))
    >>> system = qr.System([ball])
    >>> state: qr.State = system.at(system.q_start)
    >>> state.plus([0.001, 0, 0, 0, 0, 0]).q[0]
    np.float64(0.001)
    """

    def __init__(self, system: Any, q: Array) -> None:
        self.system = system
        self.q = read_only(q.copy())

    def __repr__(self) -> str:
        return f"<{type(self).__name__} at q = {shown_value(self.q.tolist())}>"

    @property
    @abstractmethod
    def kinematics(self) -> Kinematics:
        """Pose and Jacobian of every link."""

    @property
    def t(self) -> Array:
        """Origin of each link's frame in the world, shape (L, 3) [m]."""
        return self.kinematics.t

    @property
    @abstractmethod
    def M_u(self) -> Array:
        """Un-actuated block of the mass matrix, shape (n_u, n_u) [kg, kg m, kg m^2]."""

    @property
    def masses(self) -> Array:
        """M_u, (n_u, n_u), or its diagonal blocks, (k, n_u / k, n_u / k) [kg, kg m, kg m^2]."""
        return self.M_u

    @abstractmethod
    def gravity(self, acceleration: ArrayLike) -> Array:
        """Generalised force of gravity, shape (n_v,) [N, N m].

        Parameters
        ----------
        acceleration : array_like, shape (3,)
            That of free fall in the world frame [m/s^2].
        """

    @abstractmethod
    def change_to(self, q_a: ArrayLike) -> Array:
        """Change of the actuated coordinates q_a (-) q, shape (n_a,), to a target (n_q_a,).

        Raises
        ------
        ModelError
            If the target has another shape, or a quaternion in it is not of length one.
        """

    def changes_to(self, q_a: Array) -> Array:
        """Changes to N targets, (N, n_q_a): shape (N, n_a); errors as of one."""
        return np.array([self.change_to(target) for target in q_a])

    def plus_each(self, delta_q: Array) -> Array:
        """The configurations q (+) each of N changes (N, n_v): shape (N, n_q) [m, rad, -]."""
        return np.array([self.plus(change).q for change in delta_q])

    @abstractmethod
    def plus(self, delta_q: ArrayLike) -> State:
        """The state at q (+) delta_q, of a change of shape (n_v,) [m, rad].

        Raises
        ------
        ModelError
            If the change has another shape.
        """
