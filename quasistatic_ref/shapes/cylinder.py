"""The cylinder."""

import math

import numpy as np

from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.numbers.ordered import norm
from quasistatic_ref.shapes.revolved import Revolved, from_axis, rim_corners, rim_point


class Cylinder(Revolved):
    """A cylinder about its local z axis, |z| <= half_length; radius and half_length in [m].

    Examples
    --------
    >>> phi, n = qr.Cylinder(0.02, half_length=0.05).signed_distance(np.array([[0.03, 0, 0]]))
    >>> phi.round(12)  # [m]
    array([0.01])
    """

    kind = "cylinder"

    @property
    def rim_radius(self) -> float:
        """Radius of both rims [m]."""
        return self.radius

    def signed_distance(self, points: Array) -> tuple[Array, Array]:
        """Signed distances and outward normals of `points`, shape (N, 3) [m].

        In the half-plane (r, |z|) it is a rectangle.
        """
        r, outward = from_axis(points)
        excess = np.stack([r - self.radius, np.abs(points[:, 2]) - self.half_length], axis=1)
        beyond = np.maximum(excess, 0.0)
        outside = norm(beyond)
        is_outside = outside > 0
        side = excess[:, 0] >= excess[:, 1]
        face = np.stack([side, ~side], axis=1).astype(np.float64)
        flat = beyond / np.where(is_outside, outside, 1.0)[:, None]
        weight = np.where(is_outside[:, None], flat, face)
        normal = weight[:, :1] * outward
        normal[:, 2] = weight[:, 1] * np.where(points[:, 2] < 0, -1.0, 1.0)
        return np.where(is_outside, outside, excess.max(axis=1)), normal

    def faces(self, points: Array) -> tuple[Array, Array]:
        """Heights of `points`, shape (N, 3) [m], above the side and both caps, and normals."""
        r, outward = from_axis(points)
        caps = np.stack([points[:, 2], -points[:, 2]], axis=1) - self.half_length
        heights = np.concatenate([(r - self.radius)[:, None], caps], axis=1)
        normals = np.zeros((len(points), 3, 3))
        normals[:, 0] = outward
        normals[:, 1, 2] = 1.0
        normals[:, 2, 2] = -1.0
        return heights, normals

    @property
    def volume(self) -> float:
        """Base times length [m^3]."""
        return 2 * math.pi * self.radius**2 * self.half_length

    def support_point(self, direction: Array) -> Array:
        """A point of a rim, mid-side or mid-cap, by `direction`; both (3,), [m] and [-]."""
        rim = rim_point(self.radius, direction)
        return np.array([*rim, self.half_length * np.sign(direction[2])])

    def support_value(self, directions: Array) -> Array:
        """Sum of the radial and the axial reach along `directions` (N, 3) [-], shape (N,) [m]."""
        radial = norm(directions[:, :2])
        axial = directions[:, 2]
        return self.radius * radial + self.half_length * np.abs(axial)

    def corners(self, towards: Array) -> tuple[Array, float]:
        """Four points on each rim, shape (8, 3) [m], the first of each `towards` [-] the other."""
        ends = (-self.half_length, self.half_length)
        return np.concatenate([rim_corners(self.radius, z, towards) for z in ends]), 0.0
