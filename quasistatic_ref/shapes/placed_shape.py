"""Every shape that comes along, and a shape placed in the frame of a link."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from quasistatic_ref.errors import ModelError
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.shapes.box import Box as Box
from quasistatic_ref.shapes.capsule import Capsule as Capsule
from quasistatic_ref.shapes.cone import Cone as Cone
from quasistatic_ref.shapes.cylinder import Cylinder as Cylinder
from quasistatic_ref.shapes.ellipsoid import Ellipsoid as Ellipsoid
from quasistatic_ref.shapes.frozen import freeze_array
from quasistatic_ref.shapes.half_space import HalfSpace as HalfSpace
from quasistatic_ref.shapes.point_cloud import PointCloud as PointCloud
from quasistatic_ref.shapes.shape import Shape as Shape
from quasistatic_ref.shapes.sphere import Sphere as Sphere
from quasistatic_ref.text.plain import Plain
from quasistatic_ref.tolerances import ORTHONORMAL

IDENTITY = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
"""The rotation by nothing [-]."""


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
        If `shape` is no Shape, R is not a rotation or a number is not finite.

    Examples
    --------
    >>> floor = qr.PlacedShape.in_world("floor", qr.HalfSpace((0, 0, 1), 0.0))
    >>> floor.name, floor.link
    ('floor', 0)
    """

    name: str
    link: int
    R: Array
    t: Array
    shape: Shape

    if TYPE_CHECKING:  # what is made of lists, too

        def __init__(
            self, name: str, link: int, R: ArrayLike, t: ArrayLike, shape: Shape
        ) -> None: ...

    def __post_init__(self) -> None:
        if not isinstance(self.shape, Shape):
            kind = type(self.shape).__name__
            raise ModelError("must be a Shape", field=f"{self.name}.shape", value=kind)
        freeze_array(self, "R", (3, 3))
        freeze_array(self, "t", (3,))
        defect = np.abs(self.R.T @ self.R - np.eye(3)).max()
        if not (defect <= ORTHONORMAL and np.linalg.det(self.R) > 0):
            raise ModelError("must be a rotation", field=f"{self.name}.R", value=self.R.tolist())

    @classmethod
    def in_world(
        cls, name: str, shape: Shape, xyz: ArrayLike = (0, 0, 0), R: ArrayLike = IDENTITY
    ) -> PlacedShape:
        """A shape that stands still: a floor, a wall, a table.

        Parameters
        ----------
        name : str
        shape : Shape
        xyz : array_like, shape (3,)
            Origin of the shape's frame [m], world frame.
        R : array_like, shape (3, 3)
            Rotation from the shape's frame to the world's [-].

        Raises
        ------
        ModelError
            If R is no rotation, or a number is not finite.
        """
        return cls(name, 0, np.array(R), np.array(xyz), shape)
