"""The ellipsoid."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.numbers.ordered import dot, norm, total
from quasistatic_ref.shapes.frozen import freeze_array, positive_lengths, set_half
from quasistatic_ref.shapes.shape import BALL, Shape

STEPS = 100
"""Most Newton steps to the root of an ellipsoid's sum; about ten are usual."""


@dataclass(frozen=True, eq=False, init=False)
class Ellipsoid(Shape):
    """All x with sum (x_i / half_axes_i)^2 <= 1; half_axes has shape (3,) [m].

    It is made of its half axes or, as in files, of its `size`, twice these, shape (3,) [m].

    Examples
    --------
    >>> phi, n = qr.Ellipsoid((0.01, 0.02, 0.03)).signed_distance(np.array([[0, 0, 0.04]]))
    >>> phi.round(12)  # [m]
    array([0.01])
    """

    kind = "ellipsoid"

    half_axes: Array

    def __init__(
        self, half_axes: ArrayLike | None = None, *, size: ArrayLike | None = None
    ) -> None:
        set_half(self, "half_axes", half_axes, "size", size, positive_lengths)
        freeze_array(self, "half_axes", (3,))

    def signed_distance(self, points: Array) -> tuple[Array, Array]:
        """Signed distances and outward normals of `points`, shape (N, 3) [m].

        The closest point x of p has p = x + t grad, x_i = e_i^2 p_i / (t + e_i^2), and t is the
        largest root of sum (e_i p_i / (t + e_i^2))^2 = 1. With e the least half-axis and
        w = t / e^2 + 1, every sum of the denominators is free of cancellation. Newton's method
        starts at the largest w at which one of the three terms alone is 1: the sum is then between
        1 and 3, and it is convex and decreasing, so that w rises to the root with every step.
        (D. Eberly, "Distance from a point to an ellipse, an ellipsoid, or a hyperellipsoid".)
        """
        half_axes = self.half_axes
        least = half_axes.min()
        r = (half_axes / least) ** 2
        sign = np.where(points < 0, -1.0, 1.0)
        z = np.abs(points) / half_axes
        # On the plane of the medial axis the closest point is not unique. A point on this plane is
        # moved off it, always to the same side, by so little that no digit of the result changes.
        z[:, half_axes.argmin()] = np.maximum(z[:, half_axes.argmin()], 1e-150)
        low = np.max(np.where(r * z > r - 1, r * z - (r - 1), 0.0), axis=1)
        w = low
        for _ in range(STEPS):
            terms = (r * z / (w[:, None] + (r - 1))) ** 2
            slope = 2 * total((terms / (w[:, None] + (r - 1))).T)
            rise = (total(terms.T) - 1) / slope
            # A point that has converged is not moved again: its bits do not depend on its batch.
            moving = rise > np.spacing(w)
            if not moving.any():
                break
            w = np.where(moving, w + rise, w)
        on = z * r / (w[:, None] + (r - 1))  # x / e, of length one
        on /= norm(on)[:, None]
        normal = on / half_axes
        normal /= norm(normal)[:, None]
        # Along the normal: right to rounding also where the distance is next to nothing.
        phi = dot(np.abs(points) - on * half_axes, normal)
        return phi, sign * normal

    def support_point(self, direction: Array) -> Array:
        """Where the normal is the `direction`, both of shape (3,), [m] and [-]."""
        scaled = self.half_axes * direction
        return np.asarray(self.half_axes * scaled / norm(scaled))

    def support_value(self, directions: Array) -> Array:
        """Length of the `directions` (N, 3) [-] scaled by the half-axes, shape (N,) [m]."""
        scaled = directions * self.half_axes
        return norm(scaled)

    def curvature(self, direction: Array) -> Array:
        """Hessian of its reach at a unit vector of shape (3,) [-], shape (3, 3) [m]."""
        squares = self.half_axes**2
        height = np.sqrt(direction @ (squares * direction))
        scaled = squares * direction / height
        return np.asarray((np.diag(squares) - np.outer(scaled, scaled)) / height)

    @property
    def volume(self) -> float:
        """Volume [m^3]."""
        return BALL * float(np.prod(self.half_axes))

    @property
    def sizes(self) -> dict[str, Any]:
        """Lengths of the three axes [m], by their name in files."""
        return {"size": 2 * self.half_axes}
