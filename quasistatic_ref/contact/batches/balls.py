"""Points with a ball about each on solids with a closed form, all at once.

These are spheres on spheres, capsules, boxes and half-spaces, by their centres, and boxes, convex
meshes and capsules on half-spaces, by their corners. Each point is a candidate, and the closest
pair follows from them.
"""

from abc import abstractmethod
from collections.abc import Sequence

import numpy as np

from quasistatic_ref.contact.batches.batch import Batch
from quasistatic_ref.contact.distance import ClosestPoints, contacts_over
from quasistatic_ref.contact.normals import FAR_PLACES, TIED_FACES, UNIQUE_NORMAL
from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.contact.shape_in_world import Pose, on_plane
from quasistatic_ref.numbers.arrays import Array, Mask
from quasistatic_ref.numbers.ordered import dot, product, rotated
from quasistatic_ref.shapes.placed_shape import HalfSpace, Shape, Sphere
from quasistatic_ref.shapes.rounded import Rounded, distance_to_rounded_box
from quasistatic_ref.shapes.shape import DIRECTIONS


def points_of(solid: Shape) -> tuple[Array, float]:
    """Corners of a solid, (N, 3) [m], or its centre, and the radius of the balls there [m]."""
    if isinstance(solid, Sphere):
        return np.zeros((1, 3)), solid.radius
    return solid.corners(DIRECTIONS[0])


class RoundedPoints(Batch):
    """Pairs of a solid and N points with balls about them, searched together."""

    def __init__(self, pairs: Sequence[ContactPair]) -> None:
        super().__init__(pairs)
        one = pairs[0]
        are_beta = isinstance(one.alpha.shape, HalfSpace) or isinstance(one.beta.shape, Sphere)
        self._turn = 1 if are_beta else -1
        sides = [(pair.alpha.shape, pair.beta.shape)[:: self._turn] for pair in pairs]
        self._solids = [solid for solid, _ in sides]
        points = [points_of(other) for _, other in sides]
        self._points = np.array([corners for corners, _ in points])
        self._radius = np.array([radius for _, radius in points])[:, None]

    @abstractmethod
    def surface(self, x: Array) -> tuple[Array, Array]:
        """Signed distances, (P, N) [m], and normals of points, both (P, N, 3), on the solids."""

    @abstractmethod
    def known(self, nearest: Array, seen: Array, places: Array) -> Mask:
        """Which pairs have contacts that follow from the points, shape (P,).

        Parameters
        ----------
        nearest, seen, places : ndarray, shape (P,)
            Distance of the first contact; the largest coordinates of both places as they are seen,
            and in the world [m].
        """

    def of_poses(
        self, alpha: Pose, beta: Pose, seen: Array, places: Array
    ) -> tuple[Mask, ClosestPoints]:
        """The contacts at the n_c points that rank first; `seen` and `places` are (P,) [m]."""
        solid, other = (alpha, beta)[:: self._turn]
        back = solid.R.mT
        x = rotated(product(back, other.R)[:, None], self._points)
        x += rotated(back, other.t - solid.t)[:, None]
        phi, normal = self.surface(x)
        rank = np.rint((phi - self._radius) / self.resolution[:, None])
        order = rank.argsort(axis=1, kind="stable")[:, : self.n_c]
        first = np.arange(len(order))[:, None], order
        surface = phi[first], normal[first], np.full(order.shape, UNIQUE_NORMAL)
        points = contacts_over(solid, other, self._points[first], self._radius, surface, order)
        known = self.known(points.phi[:, 0], seen, places)
        return known, points if self._turn > 0 else points.swapped()


class OnHalfSpaces(RoundedPoints):
    """Points on half-spaces."""

    def __init__(self, pairs: Sequence[ContactPair]) -> None:
        super().__init__(pairs)
        planes = [plane for plane in self._solids if isinstance(plane, HalfSpace)]
        self._normal = np.array([plane.normal for plane in planes])[:, None]
        self._offset = np.array([plane.offset for plane in planes])

    def places(self, alpha: Pose, beta: Pose) -> Array:
        """Largest coordinate of either body's origin, or offset of its plane, shape (P,) [m]."""
        return np.asarray(np.maximum(super().places(alpha, beta), np.abs(self._offset)))

    def from_near(self, alpha: Pose, beta: Pose) -> tuple[Array, Array, Array]:
        """The foot of each body on its plane, and both origins seen from there, (P, 3) [m]."""
        plane, other = (alpha, beta)[:: self._turn]
        foot, *seen = on_plane(self._normal[:, 0], self._offset, plane, other.t)
        of_alpha, of_beta = seen[:: self._turn]
        return foot, of_alpha, of_beta

    def surface(self, x: Array) -> tuple[Array, Array]:
        """Heights (P, N) [m] over the planes, and their normals (P, N, 3), of `x` as of these."""
        return dot(x, self._normal) - self._offset[:, None], np.broadcast_to(self._normal, x.shape)

    def known(self, nearest: Array, seen: Array, places: Array) -> Mask:
        """Pairs that are not too far apart, (P,); `nearest`, `seen` and `places` are (P,) [m]."""
        return np.asarray(seen < FAR_PLACES * self.size)


class Spheres(RoundedPoints):
    """Centres of spheres on solids that are :class:`Rounded`."""

    def __init__(self, pairs: Sequence[ContactPair]) -> None:
        super().__init__(pairs)
        cores = [solid.core for solid in self._solids if isinstance(solid, Rounded)]
        self._cores = np.array([half for half, _ in cores])
        self._margins = np.array([radius for _, radius in cores])
        sides = [(pair.alpha.shape, pair.beta.shape) for pair in pairs]
        self._extent = np.array([max(shape.extent for shape in side) for side in sides])

    def surface(self, x: Array) -> tuple[Array, Array]:
        """Distances (P, 1) [m] and normals (P, 1, 3) of the spheres' centres `x` (P, 1, 3)."""
        phi, normal = distance_to_rounded_box(x[:, 0], self._cores, self._margins)
        return phi[:, None], normal[:, None]

    def known(self, nearest: Array, seen: Array, places: Array) -> Mask:
        """Pairs whose cores do not touch, (P,); `nearest`, `seen` and `places` are (P,) [m]."""
        within = TIED_FACES * np.maximum(places, self._extent)
        return np.asarray(nearest + (self._margins + self._radius[:, 0]) > within)
