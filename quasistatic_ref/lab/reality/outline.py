"""The outline of a flat body: its centre, and where a round finger is closest to it."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from quasistatic_ref.errors import InputError
from quasistatic_ref.step.data import Array


@dataclass(frozen=True, eq=False)
class Outline:
    """A simple polygon in the body's frame.

    Parameters
    ----------
    vertices : ndarray, shape (n, 2)
        In turn, either way round [m].

    Raises
    ------
    InputError
        If there are fewer than three, or they enclose no area.
    """

    vertices: Array

    def __post_init__(self) -> None:
        vertices = np.asarray(self.vertices, dtype=np.float64)
        if vertices.ndim != 2 or vertices.shape[1] != 2 or len(vertices) < 3:
            problem = "must be three or more points in the plane"
            raise InputError(problem, field="outline", value=np.shape(vertices))
        doubled = float(np.sum(_crosses(vertices)))
        if not np.isfinite(doubled) or doubled == 0:
            raise InputError("must enclose an area", field="outline", value=doubled / 2)
        object.__setattr__(self, "vertices", vertices if doubled > 0 else vertices[::-1].copy())

    @cached_property
    def edges(self) -> Array:
        """From each vertex to the next, counter-clockwise, shape (n, 2) [m]."""
        edges: Array = np.roll(self.vertices, -1, axis=0) - self.vertices
        return edges

    @cached_property
    def area(self) -> float:
        """Its area [m^2]."""
        return float(np.sum(_crosses(self.vertices))) / 2

    @cached_property
    def centre(self) -> Array:
        """The centroid of its area, shape (2,) [m]."""
        a = self.vertices
        b = np.roll(self.vertices, -1, axis=0)
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

        From the centre an edge is seen at a distance d between two angles from its normal; the
        integral of r over that triangle is d^3 / 6 (sec tan + log(sec + tan)) between them.
        """
        a = self.vertices - self.centre
        b = self.vertices + self.edges - self.centre
        along = self.edges / np.sqrt(self._squares)[:, None]
        d = along[:, 1] * a[:, 0] - along[:, 0] * a[:, 1]
        d = np.where(np.abs(d) < TOUCHING, TOUCHING, d)  # an edge through the centre spans nothing
        ends = [np.einsum("ij,ij->i", end, along) / d for end in (a, b)]  # tangents of the angles
        parts = [t * np.sqrt(1 + t * t) + np.arcsinh(t) for t in ends]
        return float(np.sum(d**3 / 6 * (parts[1] - parts[0])) / self.area)

    def closest(self, point: Array) -> tuple[float, Array, Array]:
        """Where a point is closest to it.

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
        vertices = self.vertices
        edges = self.edges
        along = np.einsum("ij,ij->i", point - vertices, edges) / self._squares
        feet = vertices + np.clip(along, 0.0, 1.0)[:, None] * edges
        gaps = point - feet
        i = int(np.argmin(np.einsum("ij,ij->i", gaps, gaps)))
        distance = float(np.hypot(*gaps[i]))
        inside = self._inside(point)
        if distance < TOUCHING:  # the gap has no direction: that of the edge
            normal = np.array([-edges[i, 1], edges[i, 0]]) / np.sqrt(self._squares[i])
        else:
            normal = gaps[i] / (distance if inside else -distance)
        return -distance if inside else distance, feet[i], normal

    def line_at(self, pose: Array, origin: Array) -> Array:
        """The closed line at a pose, (3,) [m, rad], from an origin, (2,) [m], shape (2, n) [mm]."""
        points = 1e3 * (self.vertices @ rotation(pose[2]).T + pose[:2] - origin[:2])
        closed: Array = np.vstack([points, points[:1]]).T
        return closed

    @cached_property
    def _squares(self) -> Array:
        squares: Array = np.einsum("ij,ij->i", self.edges, self.edges)
        if not squares.min() > 0:
            raise InputError("has the same vertex twice in turn", field="outline")
        return squares

    def _inside(self, point: Array) -> bool:
        """Whether a ray along x crosses the outline an odd number of times."""
        a = self.vertices - point
        b = self.vertices + self.edges - point
        spans = (a[:, 1] > 0) != (b[:, 1] > 0)
        a = a[spans]
        b = b[spans]
        right = a[:, 0] - a[:, 1] * (b[:, 0] - a[:, 0]) / (b[:, 1] - a[:, 1]) > 0
        return bool(right.sum() % 2)


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
