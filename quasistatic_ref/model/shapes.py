"""Collision shapes and point clouds, each with its coal object, and where they are placed."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import coal
import numpy as np

from quasistatic_ref.errors import ModelError
from quasistatic_ref.model.convex_mesh import ConvexMesh
from quasistatic_ref.model.frozen import finite, freeze_array, freeze_lengths, freeze_size
from quasistatic_ref.plain import Plain
from quasistatic_ref.step.arrays import Array
from quasistatic_ref.tolerances import ORTHONORMAL


@dataclass(frozen=True, eq=False)
class Sphere(Plain):
    """A ball of the given radius [m] about the origin of its frame."""

    radius: float

    def __post_init__(self) -> None:
        freeze_size(self, "radius")

    @cached_property
    def coal(self) -> Any:
        """The same shape as a coal geometry."""
        return coal.Sphere(self.radius)


@dataclass(frozen=True, eq=False)
class Box(Plain):
    """A cuboid along the axes of its frame: |x_i| <= half_extents_i, shape (3,) [m]."""

    half_extents: Array

    def __post_init__(self) -> None:
        freeze_lengths(self, "half_extents")

    @cached_property
    def coal(self) -> Any:
        """The same shape as a coal geometry."""
        return coal.Box(2 * self.half_extents)


@dataclass(frozen=True, eq=False)
class Round(Plain):
    """A solid of revolution about its local z axis; radius and half_length in [m]."""

    radius: float
    half_length: float

    def __post_init__(self) -> None:
        freeze_size(self, "radius")
        freeze_size(self, "half_length")


class Cylinder(Round):
    """A cylinder about its local z axis, |z| <= half_length; radius and half_length in [m]."""

    @cached_property
    def coal(self) -> Any:
        """The same shape as a coal geometry."""
        return coal.Cylinder(self.radius, 2 * self.half_length)


class Capsule(Round):
    """All points within radius [m] of a segment of its local z axis, |z| <= half_length [m].

    half_length is that of the segment, as in URDF and coal: the caps lie beyond it.
    """

    @cached_property
    def coal(self) -> Any:
        """The same shape as a coal geometry."""
        return coal.Capsule(self.radius, 2 * self.half_length)


class Cone(Round):
    """A cone about its local z axis: its base at z = -half_length, its tip at z = +half_length.

    radius [m] is that of the base.
    """

    @cached_property
    def coal(self) -> Any:
        """The same shape as a coal geometry."""
        return coal.Cone(self.radius, 2 * self.half_length)


@dataclass(frozen=True, eq=False)
class Ellipsoid(Plain):
    """All x with sum (x_i / half_axes_i)^2 <= 1; half_axes has shape (3,) [m]."""

    half_axes: Array

    def __post_init__(self) -> None:
        freeze_lengths(self, "half_axes")

    @cached_property
    def coal(self) -> Any:
        """The same shape as a coal geometry."""
        return coal.Ellipsoid(self.half_axes)


@dataclass(frozen=True, eq=False)
class HalfSpace(Plain):
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
        freeze_array(self, "normal", (3,))
        offset = finite(self.offset, "offset")
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
class PointCloud(Plain):
    """A rigid set of points in its own frame, shape (N, 3) with N >= 1 [m]; no coal object."""

    points: Array

    def __post_init__(self) -> None:
        points = np.asarray(self.points)
        if points.ndim != 2 or points.shape[0] < 1:
            problem = "must hold at least one point, as an array of shape (N, 3)"
            raise ModelError(problem, field="points", value=points.shape)
        freeze_array(self, "points", (points.shape[0], 3))


Solid = Sphere | Box | Cylinder | Capsule | Cone | Ellipsoid | HalfSpace | ConvexMesh
Shape = Solid | PointCloud


@dataclass(frozen=True, eq=False)
class PlacedShape(Plain):
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
        freeze_array(self, "R", (3, 3))
        freeze_array(self, "t", (3,))
        defect = np.abs(self.R.T @ self.R - np.eye(3)).max()
        if not (defect <= ORTHONORMAL and np.linalg.det(self.R) > 0):
            raise ModelError("must be a rotation", field=f"{self.name}.R", value=self.R.tolist())
