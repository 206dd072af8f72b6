"""A system at one configuration: what a step asks of it."""

from __future__ import annotations

from abc import ABC, abstractmethod

from numpy.typing import ArrayLike

from quasistatic_ref.model.kinematics import Kinematics
from quasistatic_ref.numbers.arrays import Array


class State(ABC):
    """A configuration that has been checked, and what follows from it; ``system.at(q)`` makes it.

    Each is formed once, when it is asked for.

    Attributes
    ----------
    q : ndarray, shape (n_q,)
        The configuration [m, rad, -]; a copy, read-only.
    """

    q: Array

    @property
    @abstractmethod
    def kinematics(self) -> Kinematics:
        """Pose and Jacobian of every link."""

    @property
    @abstractmethod
    def M_u(self) -> Array:
        """Un-actuated block of the mass matrix, shape (n_u, n_u) [kg, kg m, kg m^2]."""

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

    @abstractmethod
    def plus(self, delta_q: ArrayLike) -> State:
        """The state at q (+) delta_q, of a change of shape (n_v,) [m, rad].

        Raises
        ------
        ModelError
            If the change has another shape.
        """
