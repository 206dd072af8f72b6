"""A point, segment or cuboid with a ball about each of its points: sphere, capsule, box."""

import math

import numpy as np

from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.numbers.ordered import dot
from quasistatic_ref.shapes.shape import BALL, Shape

_AXES = np.eye(3)


class Rounded(Shape):
    """A cuboid, the core, whose edges may be zero, with a ball about each point of the core."""

    @property
    def core(self) -> tuple[Array, float]:
        """Half extents of the core, shape (3,) [m], and the ball's radius [m]."""
        raise self.lacks("core", "a sphere, box or capsule", "its core")

    @property
    def volume(self) -> float:
        """Volume [m^3] of the core, and of what is over its faces, edges and corners (Steiner)."""
        (a, b, c), r = self.core
        over_faces = 8 * r * (a * b + b * c + c * a)
        over_edges = 2 * math.pi * r**2 * (a + b + c)
        return float(8 * (a * b * c) + over_faces + over_edges + BALL * r**3)

    def signed_distance(self, points: Array) -> tuple[Array, Array]:
        """Distances and normals of `points`, shape (N, 3) [m], less the radius."""
        return distance_to_rounded_box(points, *self.core)

    def support_point(self, direction: Array) -> Array:
        """The core's corner along `direction`, moved out by the radius; both (3,), [m] and [-]."""
        half_extents, radius = self.core
        return np.asarray(radius * direction + half_extents * np.sign(direction))

    def support_value(self, directions: Array) -> Array:
        """Reach of the core along `directions` (N, 3) [-] plus the radius, shape (N,) [m]."""
        half_extents, radius = self.core
        return np.asarray(radius + dot(np.abs(directions), half_extents))


def distance_to_rounded_box(
    points: Array, half_extents: Array, radius: float | Array = 0.0
) -> tuple[Array, Array]:
    """Signed distance (N,) [m] and outward normal (N, 3) of points against a :class:`Rounded`.

    The distance to the core is that of each coordinate outside, and to the nearest face inside.

    Parameters
    ----------
    points : ndarray, shape (N, 3)
        [m].
    half_extents : ndarray, shape (3,) or (N, 3)
        One for all points, or one for each [m].
    radius : float or ndarray, shape (N,)
        [m].
    """
    excess = np.abs(points) - half_extents  # > 0 beyond a face
    beyond = np.maximum(excess, 0.0)
    outside = np.sqrt(dot(beyond, beyond))
    inside = np.maximum.reduce(excess, axis=1)
    is_inside = outside == 0
    nearest_face = _AXES.take(excess.argmax(axis=1), axis=1).T  # x before y before z, as beyond
    away = np.where(is_inside[..., None], nearest_face, beyond)
    away /= (outside + is_inside)[..., None]
    # Zero has the positive sign, whichever zero it is.
    normal = np.copysign(away, points + 0.0)
    return outside + np.minimum(inside, 0.0) - radius, normal
