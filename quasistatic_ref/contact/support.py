"""The farthest point of each shape along a direction, and what it proves about a pair."""

import numpy as np

from quasistatic_ref.contact.cloud import Rounded, rounded_box
from quasistatic_ref.errors import ContactError
from quasistatic_ref.model.convex_mesh import ConvexMesh
from quasistatic_ref.model.shapes import Cone, Cylinder, Ellipsoid, HalfSpace, PointCloud, Shape
from quasistatic_ref.step.data import Array


def support_point(shape: Shape, direction: Array) -> Array:
    """A point of the shape that is farthest along a direction; the first of several.

    Parameters
    ----------
    shape : any bounded solid
    direction : ndarray, shape (3,)
        Unit vector in the shape's own frame.

    Returns
    -------
    ndarray, shape (3,)
        [m], in the shape's own frame. Where a face, an edge or a generator is perpendicular to
        the direction, its middle.

    Raises
    ------
    ContactError
        If the shape is not bounded, or a cloud.
    """
    x, y, z = direction
    if isinstance(shape, Rounded):
        half_extents, radius = rounded_box(shape)
        return np.asarray(radius * direction + half_extents * np.sign(direction))
    match shape:
        case Cylinder():
            return np.array([*_rim(shape.radius, x, y), shape.half_length * np.sign(z)])
        case Cone():
            tip = np.array([0.0, 0.0, shape.half_length])
            rim = np.array([*_rim(shape.radius, x, y), -shape.half_length])
            return tip if tip @ direction > rim @ direction else rim
        case Ellipsoid():
            scaled = shape.half_axes * direction
            return np.asarray(shape.half_axes * scaled / np.sqrt(scaled @ scaled))
        case ConvexMesh():
            return np.asarray(shape.vertices[(shape.vertices @ direction).argmax()])
        case _:
            kind = type(shape).__name__
            raise ContactError("has no farthest point", field="shape", value=kind)


def support_value(shape: Shape, directions: Array) -> Array:
    """How far the shape reaches along unit vectors (N, 3) of its own frame: max n . x, shape (N,).

    Raises
    ------
    ContactError
        If the shape is none of these.
    """
    radial, axial = np.hypot(directions[:, 0], directions[:, 1]), directions[:, 2]
    if isinstance(shape, Rounded):
        half_extents, radius = rounded_box(shape)
        return np.asarray(radius + np.abs(directions) @ half_extents)
    match shape:
        case Cylinder():
            return shape.radius * radial + shape.half_length * np.abs(axial)
        case Cone():
            tip = shape.half_length * axial
            return np.maximum(tip, shape.radius * radial - tip)
        case Ellipsoid():
            scaled = directions * shape.half_axes
            return np.asarray(np.sqrt(np.sum(scaled * scaled, axis=1)))
        case ConvexMesh():
            return np.asarray((directions @ shape.vertices.T).max(axis=1))
        case _:
            kind = type(shape).__name__
            raise ContactError("has no closed-form reach", field="shape", value=kind)


def _rim(radius: float, x: float, y: float) -> tuple[float, float]:
    length = np.hypot(x, y)
    return (radius * x / length, radius * y / length) if length else (0.0, 0.0)


def extent(shape: Shape) -> float:
    """Longest edge of the box about a shape along its own axes [m]; of a half-space, infinity."""
    match shape:
        case HalfSpace():
            return np.inf
        case PointCloud():
            return float(np.ptp(shape.points, axis=0).max())
        case _:
            reach = support_value(shape, np.concatenate([np.eye(3), -np.eye(3)]))
            return float((reach[:3] + reach[3:]).max())
