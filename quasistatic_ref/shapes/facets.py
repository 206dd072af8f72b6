"""The triangles of a convex mesh: which may be nearest to a point, and how near it is at least."""

from typing import Final

import numpy as np

from quasistatic_ref.numbers.arrays import Array, Indices
from quasistatic_ref.numbers.ordered import dot, norm, product
from quasistatic_ref.shapes.shape import CHUNK

FEW: Final = 64
"""Triangles of which none are left out: to tell which would take as long as their distances."""
SAFE: Final = 1e-6
"""How much bounds give way, of sizes and places [-]: far more than what rounds, and far less than
what parts most points of a cloud."""
NEEDLE: Final = 1e-13
"""How much they give way over the sine of a triangle's least angle [-]: a foot by its tip is less
sure."""

_GRID = np.stack(np.meshgrid(*3 * [[-1.0, 0.0, 1.0]]), axis=-1).reshape(-1, 3)
_AROUND = _GRID[_GRID.any(axis=1)]
WAYS: Final = _AROUND / norm(_AROUND)[:, None]
"""26 unit vectors to the middles of faces and edges of a cube and to its corners [-]."""


class Facets:
    """What is formed of a mesh once. Its T triangles may stand in any order.

    Parameters
    ----------
    corners : ndarray, shape (T, 3, 3)
        Of each triangle, counter-clockwise from outside [m].
    normals, offsets : ndarray, shapes (T, 3) and (T,)
        Of their planes [-], [m].

    Attributes
    ----------
    along, inward : ndarray, shape (T, 3, 3)
        Of each edge, which begins at the corner of its number: the way to its end, and one at right
        angles to that, into the triangle [m].
    square : ndarray, shape (T, 3)
        Of the length of each edge [m^2].
    """

    def __init__(self, corners: Array, normals: Array, offsets: Array) -> None:
        self.corners = corners
        self.normals = normals
        self.offsets = offsets
        self.along = np.roll(corners, -1, axis=1) - corners
        self.square = dot(self.along, self.along)
        self.inward = np.cross(normals[:, None], self.along)
        self._middle = corners.mean(axis=1)
        self._reach = norm(corners - self._middle[:, None]).max(axis=1)
        self._supports = product(WAYS, corners.reshape(-1, 3).T).max(axis=1)
        twice_the_area = norm(np.cross(self.along[:, 0], self.along[:, 1]))
        slimmest = float((twice_the_area / self.square.max(axis=1)).min())
        self._gives = max(SAFE, NEEDLE / max(slimmest, 1e-99))
        self._size = float(np.abs(corners).max())

    def margin(self, points: Array) -> float:
        """How much a bound on distances of `points` (N, 3) [m] gives way [m]."""
        return self._gives * (self._size + float(np.abs(points).max()))

    def above_planes(self, points: Array) -> Array:
        """A lower bound of signed distances of `points` (N, 3) [m], shape (N,): by 26 planes."""
        over = product(WAYS, points.T) - self._supports[:, None]
        return np.asarray(over.max(axis=0) - self.margin(points))

    def above_faces(self, points: Array) -> Array:
        """A better one, shape (N,), by the planes of all faces: of `points` inside nearly exact."""
        blocks = np.array_split(points, 1 + len(points) * len(self.normals) // CHUNK)
        above = [(product(some, self.normals.T) - self.offsets).max(axis=1) for some in blocks]
        return np.concatenate(above) - self.margin(points)

    def near(self, points: Array) -> Indices:
        """Numbers of triangles among which are all that are nearest to each point.

        The nearest triangle is no farther than the middle that is nearest, and a triangle is no
        nearer than the ball about it.

        Parameters
        ----------
        points : ndarray, shape (N, 3)
            [m].

        Returns
        -------
        ndarray of int, shape (N, C)
            In ascending order; or (1, T), of all, where that is as good.
        """
        every = np.arange(len(self._middle))[None]
        if every.size <= FEW:
            return every
        apart = norm(points[:, None] - self._middle)
        most = apart.min(axis=1) + self.margin(points)
        apart -= self._reach
        count = int(np.count_nonzero(apart <= most[:, None], axis=1).max())
        if 2 * count >= every.size:
            return every
        return np.sort(apart.argpartition(count - 1, axis=1)[:, :count], axis=1)
