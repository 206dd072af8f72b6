"""Corners: the points of a shape that can carry a load where it lies flat on another."""

import numpy as np

from quasistatic_ref.model.convex_mesh import ConvexMesh
from quasistatic_ref.model.shapes import Box, Capsule, Cone, Cylinder, Shape
from quasistatic_ref.step.data import Array
from quasistatic_ref.tolerances import UPRIGHT

QUARTERS = np.array([[1, 0], [0, 1], [-1, 0], [0, -1]])
"""(cos, sin) of the four points of a rim, from the one nearest to the other body."""


def corner_count(shape: Shape) -> int:
    """How many corners a shape has, whatever its pose."""
    return len(corners(shape, np.array([1.0, 0.0, 0.0]))[0])


def corners(shape: Shape, towards: Array) -> tuple[Array, float]:
    """Corners of a shape, and the radius of the ball about each.

    A box and a convex mesh have their vertices; a capsule the centres of its two caps, with its
    radius; a cylinder four points on each rim and a cone its tip and four points on its rim,
    a quarter turn apart; in this order, the lower cap and rim first. Of the points of a rim, the
    first is the one that lies farthest towards the other body; of an upright shape, where all are
    as far, it is on the x axis.

    Parameters
    ----------
    shape : Shape
    towards : ndarray, shape (3,)
        Unit vector [-] from this shape to the other, in this shape's frame.

    Returns
    -------
    points : ndarray, shape (corner_count, 3)
        [m], in the shape's frame.
    radius : float
        [m].
    """
    match shape:
        case Box():
            bits = (np.arange(8)[:, None] >> np.array([0, 1, 2])) & 1
            return (2 * bits - 1) * shape.half_extents, 0.0
        case ConvexMesh():
            return shape.vertices, 0.0
        case Capsule():
            return np.array([[0, 0, -shape.half_length], [0, 0, shape.half_length]]), shape.radius
        case Cylinder():
            ends = (-shape.half_length, shape.half_length)
            return np.concatenate([_rim(shape.radius, z, towards) for z in ends]), 0.0
        case Cone():
            tip = np.array([[0, 0, shape.half_length]])
            return np.concatenate([tip, _rim(shape.radius, -shape.half_length, towards)]), 0.0
        case _:
            return np.zeros((0, 3)), 0.0


def _rim(radius: float, z: float, towards: Array) -> Array:
    x, y = towards[:2]
    length = np.hypot(x, y)
    x, y = (x / length, y / length) if length > UPRIGHT else (1.0, 0.0)
    around = QUARTERS @ np.array([[x, y], [-y, x]])
    return np.column_stack([radius * around, np.full(4, z)])
