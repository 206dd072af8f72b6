"""A shape with its pose in the world, and the closest points of a pair of them."""

from typing import NamedTuple

import numpy as np

from quasistatic_ref.shapes.placed_shape import Shape
from quasistatic_ref.step.data import Array


class ShapeInWorld(NamedTuple):
    """A shape and its pose in the world: x_world = R x + t."""

    shape: Shape
    R: Array
    t: Array

    def farthest(self, direction: Array) -> Array:
        """The farthest point along a direction, shape (3,) [m]; both in the world frame."""
        return self.R @ self.shape.support_point(self.R.T @ direction) + self.t

    def reach(self, directions: Array) -> Array:
        """How far it reaches along unit vectors (N, 3) of the world frame, shape (N,) [m]."""
        return self.shape.support_value(directions @ self.R) + directions @ self.t


class Witness(NamedTuple):
    """Closest points of two solids, in one frame: beta - alpha = phi n."""

    phi: float
    alpha: Array
    beta: Array
    n: Array

    def swapped(self) -> "Witness":
        """The same with alpha and beta exchanged."""
        return Witness(self.phi, self.beta, self.alpha, -self.n)


def rotated(R: Array, points: Array) -> Array:
    """Points, shape (..., 3) [m], turned by R, shape (3, 3)."""
    # Not `@`: BLAS may sum in another order for another number of points, and a point's
    # distance must not depend on its company.
    x, y, z = points[..., :1], points[..., 1:2], points[..., 2:]
    turned = x * R[:, 0] + y * R[:, 1] + z * R[:, 2]
    return np.asarray(turned + 0.0)  # -0.0 is written 0.0
