"""Points with a ball about each on solids with a closed form, all at once.

These are spheres on spheres, capsules, boxes and half-spaces, by their centres, and boxes, convex
meshes and capsules on half-spaces, by their corners. Each point is a candidate, and the closest
pair follows from them.
"""

from abc import abstractmethod
from collections.abc import Sequence

import numpy as np

from quasistatic_ref.contact.batches.batch import Batch
from quasistatic_ref.contact.closest_points import ClosestPoints
from quasistatic_ref.contact.distance import closest_alone, contacts_over, filling
from quasistatic_ref.contact.normals import FAR_PLACES, TIED_FACES, UNIQUE_NORMAL
from quasistatic_ref.contact.outlines import bearing_corners
from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.contact.shape_in_world import Pose, Witnesses, on_plane
from quasistatic_ref.numbers.arrays import Array, Mask
from quasistatic_ref.numbers.compiled import compiled
from quasistatic_ref.numbers.ordered import dot, product, rotated
from quasistatic_ref.shapes.convex_mesh import ConvexMesh
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
        self.turn = 1 if are_beta else -1
        sides = [(pair.alpha.shape, pair.beta.shape)[:: self.turn] for pair in pairs]
        self._solids = [solid for solid, _ in sides]
        points = [points_of(other) for _, other in sides]
        self.points = np.array([corners for corners, _ in points])
        self.radius = np.array([radius for _, radius in points])[:, None]
        self.grain = np.array([pair.grain for pair in pairs])
        self.no_corners = np.zeros(self.points.shape[:2], dtype=bool)
        for no_corners, (_, other) in zip(self.no_corners, sides, strict=True):
            if isinstance(other, ConvexMesh):
                no_corners[:] = ~bearing_corners(other)

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
        solid, other = (alpha, beta)[:: self.turn]
        back = solid.R.mT
        x = rotated(product(back, other.R)[:, None], self.points)
        x += rotated(back, other.t - solid.t)[:, None]
        phi, normal = self.surface(x)
        gaps = phi - self.radius
        resolution = self.resolution
        if self.grain.any():
            gaps[self.no_corners] = np.inf
            level = gaps <= gaps.min(axis=1, keepdims=True) + 2 * self.grain[:, None]
            lies = np.count_nonzero(level, axis=1) > 2
            resolution = np.where(lies, np.maximum(resolution, self.grain), resolution)
        rank = np.rint(gaps / resolution[:, None])
        order = rank.argsort(axis=1, kind="stable")[:, : self.n_c]
        first = np.arange(len(order))[:, None], order
        surface = phi[first], normal[first], np.full(order.shape, UNIQUE_NORMAL)
        points = contacts_over(solid, other, self.points[first], self.radius, surface, order)
        known = self.known(points.phi[:, 0], seen, places)
        return known, points if self.turn > 0 else points.swapped()


class OnHalfSpaces(RoundedPoints):
    """Points on half-spaces."""

    def __init__(self, pairs: Sequence[ContactPair]) -> None:
        super().__init__(pairs)
        planes = [plane for plane in self._solids if isinstance(plane, HalfSpace)]
        self.normal = np.array([plane.normal for plane in planes])[:, None]
        self.offset = np.array([plane.offset for plane in planes])
        sides = [(pair.alpha.shape, pair.beta.shape)[:: self.turn] for pair in pairs]
        cores = [other.core for _, other in sides if isinstance(other, Rounded)]
        self._half_extents = np.array([half for half, _ in cores])

    @compiled
    def contacts(self, R: Array, t: Array) -> tuple[Mask, ClosestPoints]:
        """Ranked contacts at poses of the links, (L, 3, 3) and (L, 3) [m], as of all batches."""
        return super().contacts(R, t)

    def places(self, alpha: Pose, beta: Pose) -> Array:
        """Largest coordinate of either body's origin, or offset of its plane, shape (P,) [m]."""
        return np.asarray(np.maximum(super().places(alpha, beta), np.abs(self.offset)))

    def from_near(self, alpha: Pose, beta: Pose) -> tuple[Array, Array, Array]:
        """The foot of each body on its plane, and both origins seen from there, (P, 3) [m]."""
        plane, other = (alpha, beta)[:: self.turn]
        foot, *seen = on_plane(self.normal[:, 0], self.offset, plane, other.t)
        of_alpha, of_beta = seen[:: self.turn]
        return foot, of_alpha, of_beta

    def surface(self, x: Array) -> tuple[Array, Array]:
        """Heights (P, N) [m] over the planes, and their normals (P, N, 3), of `x` as of these."""
        return dot(x, self.normal) - self.offset[:, None], np.broadcast_to(self.normal, x.shape)

    def known(self, nearest: Array, seen: Array, places: Array) -> Mask:
        """Pairs that are not too far apart, (P,); `nearest`, `seen` and `places` are (P,) [m]."""
        return np.asarray(seen < FAR_PLACES * self.size)

    def of_poses(
        self, alpha: Pose, beta: Pose, seen: Array, places: Array
    ) -> tuple[Mask, ClosestPoints]:
        """The contacts at the points, and the closest pair: alone, or copies that fill up.

        `seen` and `places` are (P,) [m].
        """
        N = self.points.shape[1]
        if 1 < self.n_c <= N or N == 1:
            return super().of_poses(alpha, beta, seen, places)
        nearest = self._nearest(*(alpha, beta)[:: self.turn])
        if self.n_c == 1:
            points = closest_alone(nearest, 0)
            known = self.known(nearest.phi, seen, places)
            return known, points if self.turn > 0 else points.swapped()
        known, points = super().of_poses(alpha, beta, seen, places)
        copies = filling(nearest, N + 1 + np.arange(self.n_c - N))
        copies = copies if self.turn > 0 else copies.swapped()
        every = zip(points, copies, strict=True)
        return known, ClosestPoints(*(np.concatenate(both, axis=1) for both in every))

    def _nearest(self, plane: Pose, other: Pose) -> Witnesses:
        """Closest points of the planes and of solids that are :class:`Rounded`."""
        n = rotated(plane.R, self.normal[:, 0])
        way = rotated(other.R.mT, -n)
        core = self._half_extents * np.sign(way)
        lowest = rotated(other.R, self.radius * way + core) + other.t
        phi = dot(n, lowest - plane.t) - self.offset
        return Witnesses(phi, lowest - phi[:, None] * n, lowest, n)


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
        return np.asarray(nearest + (self._margins + self.radius[:, 0]) > within)
