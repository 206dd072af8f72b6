"""Collision shapes and point clouds, each with its coal object, and where they are placed."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import coal
import numpy as np
from numpy.typing import NDArray

from quasistatic_ref.errors import ModelError
from quasistatic_ref.tolerances import ORTHONORMAL

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Sphere:
    """A ball of the given radius [m] about the origin of its frame."""

    radius: float

    def __post_init__(self) -> None:
        _freeze_size(self, "radius")

    @cached_property
    def coal(self) -> Any:
        """The same shape as a coal geometry."""
        return coal.Sphere(self.radius)


@dataclass(frozen=True, eq=False)
class Box:
    """A cuboid along the axes of its frame: |x_i| <= half_extents_i, shape (3,) [m]."""

    half_extents: Array

    def __post_init__(self) -> None:
        _freeze_array(self, "half_extents", (3,))
        if not (self.half_extents > 0).all():
            raise ModelError(
                "must be three positive lengths",
                field="half_extents",
                value=self.half_extents.tolist(),
            )

    @cached_property
    def coal(self) -> Any:
        """The same shape as a coal geometry."""
        return coal.Box(2 * self.half_extents)


@dataclass(frozen=True)
class Cylinder:
    """A cylinder about its local z axis, |z| <= half_length; radius and half_length in [m]."""

    radius: float
    half_length: float

    def __post_init__(self) -> None:
        _freeze_size(self, "radius")
        _freeze_size(self, "half_length")

    @cached_property
    def coal(self) -> Any:
        """The same shape as a coal geometry."""
        return coal.Cylinder(self.radius, 2 * self.half_length)


@dataclass(frozen=True)
class Capsule:
    """All points within radius [m] of a segment of its local z axis, |z| <= half_length [m].

    half_length is that of the segment, as in URDF and coal: the caps lie beyond it.
    """

    radius: float
    half_length: float

    def __post_init__(self) -> None:
        _freeze_size(self, "radius")
        _freeze_size(self, "half_length")

    @cached_property
    def coal(self) -> Any:
        """The same shape as a coal geometry."""
        return coal.Capsule(self.radius, 2 * self.half_length)


@dataclass(frozen=True, eq=False)
class HalfSpace:
    """The solid {x : normal . x <= offset}; the normal points out of it.

    Parameters
    ----------
    normal : ndarray, shape (3,)
        Any length but zero; stored with length one, the offset divided by the same length,
        so that the solid is the one that was written.
    offset : float
        Signed distance of the surface from the origin [m].
    """

    normal: Array
    offset: float

    def __post_init__(self) -> None:
        _freeze_array(self, "normal", (3,))
        offset = _finite(self.offset, "offset")
        # hypot scales first: a tiny or huge normal neither underflows nor overflows.
        length = float(np.hypot.reduce(self.normal))
        if not (length > 0 and np.isfinite(offset / length)):
            raise ModelError("must not be zero", field="normal", value=self.normal.tolist())
        unit = self.normal / length
        unit.setflags(write=False)
        object.__setattr__(self, "normal", unit)
        object.__setattr__(self, "offset", offset / length)

    @cached_property
    def coal(self) -> Any:
        """The same shape as a coal geometry."""
        return coal.Halfspace(self.normal, self.offset)


@dataclass(frozen=True, eq=False)
class PointCloud:
    """A rigid set of points in its own frame, shape (N, 3) with N >= 1 [m]; no coal object."""

    points: Array

    def __post_init__(self) -> None:
        points = np.asarray(self.points)
        if points.ndim != 2 or points.shape[0] < 1:
            raise ModelError(
                "must hold at least one point, as an array of shape (N, 3)",
                field="points",
                value=points.shape,
            )
        _freeze_array(self, "points", (points.shape[0], 3))


Primitive = Sphere | Box | Cylinder | Capsule | HalfSpace
Shape = Primitive | PointCloud


@dataclass(frozen=True, eq=False)
class PlacedShape:
    """A shape placed in the frame of a link.

    Parameters
    ----------
    name : str
        E.g. ``gripper/left_finger#0``.
    link : int
        Number of the link; 0 is the world.
    R : ndarray, shape (3, 3)
        Rotation from the shape's frame to the link's [-].
    t : ndarray, shape (3,)
        Origin of the shape's frame in the link's [m].
    shape : Shape

    Raises
    ------
    ModelError
        If R is not a rotation or a number is not finite.
    """

    name: str
    link: int
    R: Array
    t: Array
    shape: Shape

    def __post_init__(self) -> None:
        _freeze_array(self, "R", (3, 3))
        _freeze_array(self, "t", (3,))
        defect = np.abs(self.R.T @ self.R - np.eye(3)).max()
        if not (defect <= ORTHONORMAL and np.linalg.det(self.R) > 0):
            raise ModelError("must be a rotation", field=f"{self.name}.R", value=self.R.tolist())


def _finite(value: Any, key: str) -> float:
    try:
        number = float(value)
    except (TypeError, ValueError, OverflowError):
        raise ModelError("must be a finite number", field=key, value=value) from None
    if not np.isfinite(number):
        raise ModelError("must be a finite number", field=key, value=value)
    return number


def _freeze_size(owner: Any, key: str) -> None:
    """Replace a field by a float, which must be positive."""
    value = getattr(owner, key)
    number = _finite(value, key)
    # Twice the size is what coal is given.
    if not (number > 0 and np.isfinite(2 * number)):
        raise ModelError("must be a positive length", field=key, value=value)
    object.__setattr__(owner, key, number)


def _freeze_array(owner: Any, key: str, shape: tuple[int, ...]) -> None:
    """Replace a field by a read-only float64 copy, finite and of the given shape."""
    value = getattr(owner, key)
    try:
        array = np.array(value, dtype=np.float64) + 0.0
    except (TypeError, ValueError):
        raise ModelError("must be numbers", field=key, value=value) from None
    if array.shape != shape:
        raise ModelError(f"must have shape {shape}", field=key, value=array.shape)
    if not np.isfinite(array).all():
        raise ModelError("must hold finite numbers only", field=key, value=array.tolist())
    array.setflags(write=False)
    object.__setattr__(owner, key, array)
