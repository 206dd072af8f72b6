"""Solids of revolution about z, and their rims."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.numbers.ordered import norm, product
from quasistatic_ref.shapes.frozen import positive_length, set_half
from quasistatic_ref.shapes.shape import Shape
from quasistatic_ref.tolerances import UPRIGHT

QUARTERS = np.array([[1, 0], [0, 1], [-1, 0], [0, -1]])
"""(cos, sin) of the four points of a rim, from the one nearest to the other body."""


@dataclass(frozen=True, eq=False, init=False)
class Revolved(Shape):
    """A solid of revolution about its local z axis; radius and half_length in [m].

    It is made of its half_length or, as in files, of its `length` [m].
    """

    radius: float
    half_length: float

    def __init__(
        self, radius: float, half_length: float | None = None, *, length: float | None = None
    ) -> None:
        object.__setattr__(self, "radius", positive_length(radius, "radius"))
        set_half(self, "half_length", half_length, "length", length, positive_length)

    @property
    def edge_count(self) -> int:
        """Four, as of a square: a rim crosses an edge at most twice, a line once."""
        return 4

    @property
    def sizes(self) -> dict[str, Any]:
        """Radius and length of the solid [m], by their names in files."""
        return {"radius": self.radius, "length": 2 * self.half_length}


def from_axis(points: Array) -> tuple[Array, Array]:
    """Distances (N,) from the z axis, and unit vectors (N, 3) away from it.

    Parameters
    ----------
    points : ndarray, shape (N, 3)
        [m]; on the axis the vector is along x.
    """
    radial = points * [1.0, 1.0, 0.0]
    r = norm(radial)
    on_axis = r == 0
    outward = radial / np.where(on_axis, 1.0, r)[:, None]
    outward[on_axis] = (1.0, 0.0, 0.0)
    return r, outward


def rim_corners(radius: float, z: float, towards: Array) -> Array:
    """Four points of a rim, a quarter turn apart, shape (4, 3) [m].

    Parameters
    ----------
    radius, z : float
        Radius of the rim, and its height [m].
    towards : ndarray, shape (3,)
        Unit vector [-] to the other body; the first point is the one nearest to it.
    """
    x, y = towards[:2]
    length = norm(towards[:2])
    x, y = (x / length, y / length) if length > UPRIGHT else (1.0, 0.0)
    around = product(QUARTERS, np.array([[x, y], [-y, x]]))
    return np.column_stack([radius * around, np.full(4, z)])


def rim_point(radius: float, direction: Array) -> tuple[float, float]:
    """X and y of a rim's point farthest along a direction; the rim's centre if all are as far.

    Parameters
    ----------
    radius : float
        [m].
    direction : ndarray, shape (3,)
        Unit vector [-].
    """
    x, y, _ = direction
    length = norm(direction[:2])
    return (radius * x / length, radius * y / length) if length else (0.0, 0.0)
