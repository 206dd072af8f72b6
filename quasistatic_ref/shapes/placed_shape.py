"""Every shape that comes along, and a shape placed in the frame of a link."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from quasistatic_ref.errors import ModelError
from quasistatic_ref.formats.plain import Plain
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
from quasistatic_ref.step.arrays import Array
from quasistatic_ref.tolerances import ORTHONORMAL


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

    Examples
    --------
    >>> ground = qr.HalfSpace((0, 0, 1), 0.0)
    >>> floor = qr.PlacedShape("floor", link=0, R=np.eye(3), t=np.zeros(3), shape=ground)
    >>> floor.name
    'floor'
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
