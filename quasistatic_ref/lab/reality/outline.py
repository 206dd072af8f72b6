"""The outline of a flat body: its centre, and where a round finger is closest to it."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from quasistatic_ref.lab.made_steps.slider import turned
from quasistatic_ref.numbers.arrays import Array


@dataclass(frozen=True, eq=False)
class Outline:
    """A simple polygon in the body's frame.

    Parameters
    ----------
    vertices : ndarray, shape (n, 2)
        In turn, counter-clockwise [m].
    """

    vertices: Array

    @cached_property
    def edges(self) -> Array:
        """From each vertex to the next, shape (n, 2) [m]."""
        edges: Array = np.roll(self.vertices, -1, axis=0) - self.vertices
        return edges

    @cached_property
    def area(self) -> float:
        """Area inside of the outline [m^2]."""
        return float(np.sum(_crosses(self.vertices))) / 2

    @cached_property
    def centre(self) -> Array:
        """The centroid of its area, shape (2,) [m]."""
        a = self.vertices
        b = np.roll(a, -1, axis=0)
        centre: Array = (_crosses(a)[:, None] * (a + b)).sum(0) / (6 * self.area)
        return centre

    @cached_property
    def gyration(self) -> float:
        """Radius of gyration of its area about its centre [m]."""
        a = self.vertices - self.centre
        b = np.roll(a, -1, axis=0)
        squares = (a * a + a * b + b * b).sum(1)
        return float(np.sqrt(np.sum(_crosses(a) * squares) / (12 * self.area)))

    @cached_property
    def mean_distance(self) -> float:
        """Mean distance of its area from its centre [m]: mu_omega / mu_v of a uniform pressure.

        Over the triangle of the centre and an edge, the integral of r is twice its area times a
        third of the mean of r along the edge: Gauss's rule of 20 points.
        """
        a = self.vertices - self.centre
        points, weights = np.polynomial.legendre.leggauss(20)
        along = a[:, None] + (points[:, None] + 1) / 2 * self.edges[:, None]
        means = np.linalg.norm(along, axis=-1) @ weights / 2
        return float(_crosses(a) @ means / (3 * self.area))

    def closest(self, point: Array) -> tuple[float, Array, Array]:
        """The outline's closest point to a given point, with distance and normal.

        Parameters
        ----------
        point : ndarray, shape (2,)
            In the body's frame [m].

        Returns
        -------
        distance : float
            Signed, negative inside [m].
        on : ndarray, shape (2,)
            The closest point of the outline [m].
        normal : ndarray, shape (2,)
            Unit vector from the point into the body, along the shortest way.
        """
        squares = np.einsum("ij,ij->i", self.edges, self.edges)
        along = np.einsum("ij,ij->i", point - self.vertices, self.edges) / squares
        feet = self.vertices + np.clip(along, 0.0, 1.0)[:, None] * self.edges
        gaps = point - feet
        i = int(np.argmin(np.einsum("ij,ij->i", gaps, gaps)))
        distance = float(np.hypot(*gaps[i]))
        inside = self._inside(point)
        if distance < TOUCHING:  # the gap has no direction: that of the edge
            normal = turned(self.edges[i]) / np.sqrt(squares[i])
        else:
            normal = gaps[i] / (distance if inside else -distance)
        return -distance if inside else distance, feet[i], normal

    def line_at(self, pose: Array, origin: Array) -> Array:
        """The closed line at a pose, (3,) [m, rad], from an origin, (2,) [m], shape (2, n) [mm]."""
        points = 1e3 * (self.vertices @ rotation(pose[2]).T + pose[:2] - origin[:2])
        closed: Array = np.vstack([points, points[:1]]).T
        return closed

    def _inside(self, point: Array) -> bool:
        """Whether a ray along x crosses the outline an odd number of times."""
        a = self.vertices - point
        below = a[:, 1] <= 0
        rises = np.roll(~below, -1)
        crossed = (below == rises) & ((_crosses(a) > 0) == rises)
        return bool(crossed.sum() % 2)


TOUCHING = 1e-12
"""Distance below which the direction to the outline is rounding [m]."""


def rotation(angle: float) -> Array:
    """The matrix, shape (2, 2), that turns by an angle [rad]."""
    cos = np.cos(angle)
    sin = np.sin(angle)
    return np.array([[cos, -sin], [sin, cos]])


def _crosses(vertices: Array) -> Array:
    """Twice the areas of the triangles between the origin and the edges, shape (n,) [m^2]."""
    x, y = vertices.T
    crosses: Array = x * np.roll(y, -1) - np.roll(x, -1) * y
    return crosses
