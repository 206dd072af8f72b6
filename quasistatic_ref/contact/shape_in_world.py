"""A shape with its pose in the world, and the closest points of a pair of them."""

from typing import NamedTuple

import numpy as np

from quasistatic_ref.numbers.arrays import Array, Indices
from quasistatic_ref.numbers.ordered import dot, product, rotated
from quasistatic_ref.shapes.placed_shape import Shape


class Pose(NamedTuple):
    """Where a frame stands in another one, outside: its points x are R x + t there.

    Parameters
    ----------
    R : ndarray, shape (3, 3), or (P, 3, 3) of P frames
        [-].
    t : ndarray, shape (3,), or (P, 3)
        [m].
    """

    R: Array
    t: Array

    def points(self, points: Array) -> Array:
        """Points (N, 3) [m] of one frame, seen from outside.

        They are stored coordinate by coordinate: of many points, loops over these are inner ones.
        """
        x: Array = self.R[:, :1] * points[:, 0]
        x += self.R[:, 1:2] * points[:, 1]
        x += self.R[:, 2:] * points[:, 2]
        x += self.t[:, None]
        return x.T

    def local(self, point: Array) -> Array:
        """A point (3,) [m] from outside, in the frame."""
        return product(self.R.T, point - self.t)

    def local_direction(self, direction: Array) -> Array:
        """A direction (3,) [-] from outside, along the axes of the frame."""
        return product(self.R.T, direction)

    def of(self, other: "Pose") -> "Pose":
        """The pose of another frame in this one; both stand in the same."""
        return Pose(product(self.R.T, other.R), self.local(other.t))


class ShapeInWorld(NamedTuple):
    """A shape and its pose in the world: x_world = R x + t.

    Of a pair that is far away, and seen from a point of it, `away` is the largest coordinate of its
    places in the world [m]: they are rounded there.
    """

    shape: Shape
    R: Array
    t: Array
    away: float = 0.0

    @property
    def pose(self) -> Pose:
        """The pose of the shape in the world: R, and t [m]."""
        return Pose(self.R, self.t)

    def farthest(self, direction: Array) -> Array:
        """The farthest point along a direction, shape (3,) [m]; both in the world frame."""
        local = self.pose.local_direction(direction)
        return rotated(self.R, self.shape.support_point(local)) + self.t

    def reach(self, directions: Array) -> Array:
        """How far the shape reaches along unit vectors (N, 3) of the world, shape (N,) [m]."""
        return self.shape.support_value(product(directions, self.R)) + dot(directions, self.t)


def poses_in_world(
    links: list[int] | Indices, poses: Array, R: Array, t: Array
) -> tuple[Pose, Pose]:
    """Poses of alpha's and of beta's shape in the world, of one pair or of each of P.

    Parameters
    ----------
    links : list or ndarray of int, shape (..., 2)
        Those of both sides.
    poses : ndarray, shape (..., 2, 3, 4)
        [R, t] of the shapes on these; R [-], t [m].
    R, t : ndarray, shapes (L, 3, 3) and (L, 3)
        Of all links [-] and [m].
    """
    world = product(R[links], poses)
    world[..., 3] += t[links]
    of_alpha, of_beta = world.swapaxes(0, -3)
    return Pose(of_alpha[..., :3], of_alpha[..., 3]), Pose(of_beta[..., :3], of_beta[..., 3])


def on_plane(
    normal: Array, offset: float | Array, plane: Pose, t: Array
) -> tuple[Array, Array, Array]:
    """Feet of points on planes, and the planes' origins and the points, seen from the feet.

    A plane's frame may stand anywhere along it; all are of shape (..., 3), in the world's axes [m].

    Parameters
    ----------
    normal : ndarray, shape (..., 3)
        Of each half-space, in its frame [-].
    offset : float or ndarray, shape (...)
        Of each along its normal [m].
    plane : Pose
        Of the half-spaces.
    t : ndarray, shape (..., 3)
        The places [m].
    """
    n = rotated(plane.R, normal)
    height = np.asarray(offset)[..., None] * n
    above = (dot(n, t - plane.t) - offset)[..., None] * n
    return t - above, -height, above


class Witness(NamedTuple):
    """Closest points of two solids, in one frame: beta - alpha = phi n."""

    phi: float
    alpha: Array
    beta: Array
    n: Array

    def swapped(self) -> "Witness":
        """The closest points with alpha and beta exchanged."""
        return Witness(self.phi, self.beta, self.alpha, -self.n)


class Witnesses(NamedTuple):
    """Closest points of P pairs of solids, with fields of shape (P, ...)."""

    phi: Array
    alpha: Array
    beta: Array
    n: Array
