"""The triangles of a convex mesh: which may be nearest to a point, and how near it is at least."""

from collections.abc import Iterator
from typing import Final

import numpy as np

from quasistatic_ref.numbers.arrays import Array, Indices
from quasistatic_ref.numbers.ordered import dot, norm, product
from quasistatic_ref.shapes.shape import CHUNK

FEW_FACETS: Final = 64
"""Triangles of which none are left out, nor of that many points: to tell which would take as long
as their distances."""
SAFE: Final = 1e-6
"""How much bounds give way, of sizes and places [-]: far more than what rounds, and far less than
what parts most points of a cloud."""
NEEDLE: Final = 1e-13
"""How much they give way over the sine of a triangle's least angle [-]: a foot by its tip is less
sure."""

WIDTHS: Final = 4 ** np.arange(16)
"""Most triangles of a point of each group."""

_GRID = np.stack(np.meshgrid(*3 * [[-1.0, 0.0, 1.0]]), axis=-1).reshape(-1, 3)
_AROUND = _GRID[_GRID.any(axis=1)]
WAYS: Final = _AROUND / norm(_AROUND)[:, None]
"""26 unit vectors to the middles of faces and edges of a cube and to its corners [-]."""


class Facets:
    """Arrays of a mesh's T triangles that its distances need, formed once.

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
        longest = self.along[np.arange(len(corners)), self.square.argmax(axis=1)]
        longest = longest / norm(longest)[:, None]
        self._axes = [longest, np.cross(normals, longest), normals]
        ends = [dot(axis[:, None], corners) for axis in self._axes]
        self._boxes = [(x.min(axis=1) + x.max(axis=1), np.ptp(x, axis=1)) for x in ends]
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

    def near(self, points: Array) -> Iterator[tuple[Indices, Indices]]:
        """Triangles among which are all that are nearest to each point, of groups of points.

        A triangle is no nearer than the rectangle about it along its longest edge; the nearest is
        no farther than the one whose rectangle is nearest.

        Parameters
        ----------
        points : ndarray, shape (N, 3)
            [m].

        Yields
        ------
        some : ndarray of int, shape (M,)
            Numbers of points that have about as many.
        near : ndarray of int, shape (M, C)
            Of triangles, in ascending order, the last one several times.
        """
        T = len(self.normals)
        if T <= FEW_FACETS or T * len(points) <= FEW_FACETS**2:
            yield np.arange(len(points)), np.arange(T)[None]
            return
        squares = np.zeros((len(points), T))
        for axis, (twice_the_middle, length) in zip(self._axes, self._boxes, strict=True):
            beyond = np.abs(points @ axis.T - twice_the_middle / 2) - length / 2
            squares += np.maximum(beyond, 0.0) ** 2
        least = np.sqrt(squares)
        first = least.argmin(axis=1)[:, None]
        most = norm(self._offsets(points, first)) + self.margin(points)
        point, face = np.nonzero(least <= most[:, None])
        count = np.bincount(point)
        start = np.cumsum(count) - count
        of_width = np.searchsorted(WIDTHS, count)
        for width in np.unique(of_width):
            some = np.flatnonzero(of_width == width)
            place = np.minimum(np.arange(count[some].max()), count[some, None] - 1)
            yield some, face[start[some, None] + place]

    def offsets_from(self, points: Array) -> Array:
        """Vectors to `points` outside of the hull from its nearest points, (N, 3) [m]."""
        offsets = np.empty_like(points)
        for some, near in self.near(points):
            offsets[some] = self._offsets(points[some], near)
        return offsets

    def _offsets(self, points: Array, near: Indices) -> Array:
        """The same from the nearest points of some triangles, (N, C) or (1, C)."""
        every = np.arange(len(points))
        n = self.normals[near]
        along = self.along[near]
        # The nearest point of each edge, clamped to its ends; of equal ones the first edges' first.
        arm = points[:, None, None] - self.corners[near]
        s = np.clip(dot(arm, along) / self.square[near], 0.0, 1.0)
        away = arm - s[..., None] * along
        square = dot(away, away).swapaxes(1, 2)
        k, i = np.divmod(square.reshape(len(points), -1).argmin(axis=1), square.shape[2])
        best = square[every, k, i]
        offset = away[every, i, k]
        # Whether the projection on a face's plane is on its side of each edge.
        within = (dot(arm, self.inward[near]) >= 0).all(axis=2)
        level = dot(arm[:, :, 0], n)
        above = within & (level > 0)
        # A point above the inside of a face is nearest to that face. If an edge seems nearer, that
        # is rounding, and the edge's direction is the less accurate one. For a point on a face,
        # rounding decides the sign of its level.
        some = np.asarray(above.any(axis=1))
        best = np.where(some, np.inf, best)
        heights = np.where(np.where(some[:, None], above, within), level * level, np.inf)
        i = heights.argmin(axis=1)
        nearer = heights[every, i] < best
        facing = self.normals[np.broadcast_to(near, level.shape)[every, i]]
        return np.where(nearer[:, None], level[every, i, None] * facing, offset)
