"""How MuJoCo's velocities move its bodies, in place of pinocchio's columns."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from quasistatic_ref.contact.distance import ClosestPoints
from quasistatic_ref.model.column_map import ColumnMap
from quasistatic_ref.model.kinematics import Kinematics
from quasistatic_ref.step.arrays import Array


class Columns(ColumnMap):
    """Which of MuJoCo's velocities move a body, and with which coordinates.

    Parameters
    ----------
    moves : ndarray, shape (L, 1, nv)
        1 where a velocity moves a body [-].
    T : ndarray, shape (nv, n_v)
        MuJoCo's displacement, per unit of the coordinates [-].
    """

    def __init__(self, moves: Array, T: Array) -> None:
        self.moves = moves
        self.T = T
        self.n_v = T.shape[1]
        self.owner = np.abs(T).argmax(axis=1)

    @cached_property
    def coordinates(self) -> Array:
        """T, shape (nv, n_v) [-]."""
        return self.T

    def of_coordinates(self, columns: Array) -> Array:
        """`columns` of MuJoCo's velocities, (..., nv), per unit of delta_q, (..., n_v) [m, rad]."""
        per_unit: Array = columns @ self.T
        return per_unit


@dataclass(frozen=True, eq=False)
class Placed(Kinematics):
    """Where every body is, how it moves, and what MuJoCo finds closest.

    Parameters
    ----------
    points : ClosestPoints, optional
    """

    points: ClosestPoints | None = None
