"""The questions that every shape answers, in its own frame; by default a shape refuses them."""

import math
from functools import cached_property
from typing import Any, ClassVar, Self

import numpy as np

from quasistatic_ref.errors import ContactError
from quasistatic_ref.numbers.arrays import Array, Indices, Mask
from quasistatic_ref.text.plain import Plain

DIRECTIONS = np.concatenate([np.eye(3), -np.eye(3)])
BALL = 4 / 3 * math.pi
"""Volume of a ball over the third power of its radius [-]."""
CHUNK = 1 << 17
"""Points times faces handled at once: some tens of megabytes."""


class Shape(Plain):
    """A shape; a subclass is a frozen dataclass of its sizes.

    Attributes
    ----------
    kind : str
        What files call it; of a cloud or a mesh, nothing.
    """

    kind: ClassVar[str] = ""

    def __hash__(self) -> int:
        return self._hash

    @cached_property
    def _hash(self) -> int:
        return super().__hash__()

    def signed_distance(self, points: Array) -> tuple[Array, Array]:
        """Signed distance and outward normal of points.

        Parameters
        ----------
        points : ndarray, shape (N, 3)
            [m].

        Returns
        -------
        phi : ndarray, shape (N,)
            [m], negative inside.
        normal : ndarray, shape (N, 3)
            Unit normals: the gradient of phi; the closest point on the shape is p - phi n. Where
            it is not unique (the centre of a sphere, a tie of two faces), one of them, always the
            same: results are deterministic.

        Raises
        ------
        ContactError
            If the shape is not solid.
        """
        raise self.lacks("signed distance", "a solid", "its signed_distance")

    def at_points(self, some: Indices | Mask | slice) -> Self:
        """The shape as some of the points see it; most shapes are the same for all points."""
        return self

    def faces(self, points: Array) -> tuple[Array, Array]:
        """Heights of points above each face, and the faces' outward normals there.

        Faces are flat, or the side of a cylinder or a cone. Inside of a shape that has faces only,
        the signed distance is the largest height. By default there are none.

        Parameters
        ----------
        points : ndarray, shape (N, 3)
            [m].

        Returns
        -------
        heights : ndarray, shape (N, F)
            [m], negative below a face.
        normals : ndarray, shape (N, F, 3)
            Unit vectors [-].
        """
        return np.zeros((len(points), 0)), np.zeros((len(points), 0, 3))

    def support_point(self, direction: Array) -> Array:
        """A point that is farthest along a direction.

        Parameters
        ----------
        direction : ndarray, shape (3,)
            Unit vector [-].

        Returns
        -------
        ndarray, shape (3,)
            [m]. Where a face, an edge or a generator is perpendicular to the direction, its middle;
            but of a convex mesh the first vertex, and of a cone's generator one of its ends.

        Raises
        ------
        ContactError
            If the shape is not bounded, or a cloud.
        """
        raise self.lacks("farthest point", "a bounded solid", "its support_point")

    def support_value(self, directions: Array) -> Array:
        """How far the shape reaches along unit vectors n: max n . x, shape (N,) [m].

        Parameters
        ----------
        directions : ndarray, shape (N, 3)
            [-].

        Raises
        ------
        ContactError
            If the shape is not bounded, or a cloud.
        """
        raise self.lacks("closed-form reach", "a bounded solid", "its support_value")

    def corners(self, towards: Array) -> tuple[Array, float]:
        """The points that can carry a load where the shape lies flat on another; by default none.

        Parameters
        ----------
        towards : ndarray, shape (3,)
            Unit vector [-] from this shape to the other.

        Returns
        -------
        points : ndarray, shape (corner_count, 3)
            [m]. Corners on rims come last, four on each rim: the first lies farthest towards the
            other body. If all points of the rim are equally far, the first is on the x axis.
        radius : float
            Radius of the ball about each corner [m].
        """
        return np.zeros((0, 3)), 0.0

    @property
    def rim_radius(self) -> float | None:
        """Radius of the rims about z that have corners [m]; None where there are none."""
        return None

    @cached_property
    def corner_count(self) -> int:
        """Number of corners, which does not depend on the direction."""
        return len(self.corners(DIRECTIONS[0])[0])

    @property
    def edge_count(self) -> int:
        """Most pieces of its edges that can touch another body at once; by default none."""
        return 0

    @cached_property
    def extent(self) -> float:
        """Longest edge of the bounding box along its own axes [m]; of a half-space, infinity."""
        reach = self.support_value(DIRECTIONS)
        return float((reach[:3] + reach[3:]).max())

    @property
    def volume(self) -> float:
        """Volume [m^3].

        Raises
        ------
        ContactError
            If the shape is not bounded, or a cloud.
        """
        raise self.lacks("known volume", "a bounded solid", "its volume")

    @property
    def sizes(self) -> dict[str, Any]:
        """The sizes of the shape by their names in files [m, -].

        Raises
        ------
        ContactError
            If it is a cloud or a mesh.
        """
        raise self.lacks("sizes", "a solid that is no mesh", "its sizes")

    def words(self) -> str:
        """Kind and sizes, e.g. ``box 0.1 x 0.2 x 0.3 m`` or ``sphere of radius 0.1 m``."""
        sizes = self.sizes
        if "size" in sizes:
            return f"{self.kind} {dimensions(sizes['size'])}"
        return f"{self.kind} of {', '.join(f'{name} {size:g} m' for name, size in sizes.items())}"

    def lacks(self, what: str, instead: str, part: str) -> ContactError:
        """The error that a shape of this kind lacks something: what to take or to write."""
        problem = f"has no {what}: take {instead}, or write {part}"
        return ContactError(problem, field="shape", value=type(self).__name__)


def dimensions(values: Array) -> str:
    """Lengths as in ``0.1 x 0.2 x 0.3 m``.

    Parameters
    ----------
    values : ndarray, shape (3,)
        [m].
    """
    return " x ".join(f"{value:.4g}" for value in values) + " m"
