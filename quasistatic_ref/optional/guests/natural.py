"""Rows of MuJoCo's in natural units, and those of which only rounding is left.

Where a contact is at the axis of the joint that moves its body, its normal row is zero but for
rounding, 1e-15 m/rad. As a row of a step it would bear any load, by a force of 1e15 times the load.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from quasistatic_ref.optional.guests.mujoco_state import MujocoState
from quasistatic_ref.step.arrays import Array, Mask
from quasistatic_ref.tolerances import FULL_RANK


def terms(state: MujocoState, J: Array, T: Array) -> Array:
    """The sizes of the terms of which the entries of J T are sums, shape (m, n).

    J has the shape (m, nv), and T the shape (nv, n) [-].
    """
    sizes: Array = np.maximum(np.abs(J), state.reach * (J != 0)) @ np.abs(T)
    return sizes


def moved(state: MujocoState, J: Array, T: Array) -> Array:
    """J T, with zeros for the entries of which only rounding is left, shape (m, n).

    J has the shape (m, nv), and T the shape (nv, n) [-].
    """
    entries = J @ T
    return np.where(np.abs(entries) > FULL_RANK * terms(state, J, T), entries, 0.0)


class Natural(NamedTuple):
    """What natural units of rows are made of.

    Parameters
    ----------
    state : MujocoState
    T : ndarray, shape (nv, n)
        MuJoCo's displacement, per unit of the coordinates of a step [-].
    units : ndarray, shape (n,)
        Diagonal of S of these coordinates [m or rad, per (N m s)^0.5].
    """

    state: MujocoState
    T: Array
    units: Array

    def rows(self, J: Array) -> Array:
        """Rows along MuJoCo's velocities, (m, nv), in natural units, (m, n)."""
        rows: Array = J @ self.T * self.units
        return rows

    def sizes(self, J: Array) -> Array:
        """The largest term of each row, shape (m,)."""
        sizes: Array = (terms(self.state, J, self.T) * self.units).max(axis=1, initial=0.0)
        return sizes

    def empty(self, J: Array, held: Array | None = None) -> Mask:
        """Which rows, (m, nv), are zero but for rounding, shape (m,): at most FULL_RANK of a term.

        `held`, shape (r, n) [-], are orthonormal rows, in natural units, along which nothing moves.
        """
        rows = self.rows(J)
        if held is not None:
            rows -= rows @ held.T @ held
        empty: Mask = np.abs(rows).max(axis=1, initial=0.0) <= FULL_RANK * self.sizes(J)
        return empty
