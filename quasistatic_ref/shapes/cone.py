"""The cone."""

import math
from functools import cached_property

import numpy as np

from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.numbers.ordered import dot, norm
from quasistatic_ref.shapes.revolved import Revolved, from_axis, rim_corners, rim_point
from quasistatic_ref.tolerances import ON_SURFACE


class Cone(Revolved):
    """A cone about its local z axis: its base at z = -half_length, its tip at z = +half_length.

    radius [m] is that of the base.

    Examples
    --------
    >>> phi, n = qr.Cone(radius=0.02, half_length=0.05).signed_distance(np.array([[0, 0, 0.06]]))
    >>> phi.round(12)  # [m]
    array([0.01])
    """

    kind = "cone"

    @property
    def rim_radius(self) -> float:
        """Radius of the rim of the base [m]."""
        return self.radius

    def signed_distance(self, points: Array) -> tuple[Array, Array]:
        """Signed distances and outward normals of `points`, shape (N, 3) [m].

        In the half-plane (r, z) it is a triangle with the edges rim - tip and axis - rim.
        """
        radius = self.radius
        half_length = self.half_length
        p, outward = _half_plane(points)
        rim = np.array([radius, -half_length])
        tip = np.array([0.0, half_length])
        slant = norm(tip - rim)
        above_side, above_base = self._heights(p)
        along = (tip - rim) / slant
        s = (p[:, 0] - rim[0]) * along[0] + (p[:, 1] - rim[1]) * along[1]
        on_side = rim + np.clip(s, 0.0, slant)[:, None] * along
        on_base = np.stack([np.minimum(p[:, 0], radius), np.full(len(p), -half_length)], axis=1)
        d_side = norm(p - on_side)
        d_base = norm(p - on_base)
        side_nearest = d_side <= d_base
        nearest = np.where(side_nearest[:, None], on_side, on_base)
        away = p - nearest
        distance = norm(away)
        flat = np.where((above_side >= above_base)[:, None], self._side, np.array([0.0, -1.0]))
        level = np.maximum(above_side, above_base)
        # Inside, and wherever a face is the closest feature, its normal; else that of an edge or
        # tip. By where the closest point is, not by its distance: next to the surface that is all
        # rounding, and on an edge or the tip so is its direction.
        within = np.where(side_nearest, (s > 0) & (s < slant), p[:, 0] < radius)
        face = (level <= 0) | within | (distance <= ON_SURFACE * slant)
        flat = np.where(face[:, None], flat, away / np.where(face, 1.0, distance)[:, None])
        phi = np.where(face, level, distance)
        return phi, np.concatenate([flat[:, :1] * outward, flat[:, 1:]], axis=1)

    def faces(self, points: Array) -> tuple[Array, Array]:
        """Heights of `points`, shape (N, 3) [m], above the side and the base, and normals."""
        p, outward = _half_plane(points)
        heights = np.stack(self._heights(p), axis=1)
        normals = np.zeros((len(points), 2, 3))
        normals[:, 0, :2] = self._side[0] * outward
        normals[:, 0, 2] = self._side[1]
        normals[:, 1, 2] = -1.0
        return heights, normals

    @cached_property
    def _side(self) -> Array:
        """Outward normal of the edge rim - tip, shape (2,)."""
        side = np.array([2 * self.half_length, self.radius])
        return np.asarray(side / norm(side))

    def _heights(self, p: Array) -> tuple[Array, Array]:
        """Heights of points (r, z) above the side and above the base."""
        beyond = p[:, 0] - self.radius
        above_side = beyond * self._side[0] + (p[:, 1] + self.half_length) * self._side[1]
        return above_side, -self.half_length - p[:, 1]

    @property
    def volume(self) -> float:
        """A third of base times length [m^3]."""
        return 2 * math.pi * self.radius**2 * self.half_length / 3

    def support_point(self, direction: Array) -> Array:
        """The tip or a point of the rim, by the `direction`; both of shape (3,), [m] and [-]."""
        tip = np.array([0.0, 0.0, self.half_length])
        rim = np.array([*rim_point(self.radius, direction), -self.half_length])
        return tip if dot(tip, direction) > dot(rim, direction) else rim

    def support_value(self, directions: Array) -> Array:
        """The larger reach of tip and rim along `directions` (N, 3) [-], shape (N,) [m]."""
        radial = norm(directions[:, :2])
        axial = directions[:, 2]
        tip = self.half_length * axial
        return np.maximum(tip, self.radius * radial - tip)

    def corners(self, towards: Array) -> tuple[Array, float]:
        """Tip, and four points of the rim, the first `towards` [-] the other; shape (5, 3) [m]."""
        tip = np.array([[0, 0, self.half_length]])
        return np.concatenate([tip, rim_corners(self.radius, -self.half_length, towards)]), 0.0


def _half_plane(points: Array) -> tuple[Array, Array]:
    """(r, z) of points, and the unit vectors (N, 2) away from the axis."""
    r, outward = from_axis(points)
    return np.stack([r, points[:, 2]], axis=1), outward[:, :2]
