"""One cloud on spheres, capsules, boxes and half-spaces: its distances to all of them at once."""

from collections.abc import Sequence
from typing import Final

import numpy as np

from quasistatic_ref.contact.batches.batch import Batch
from quasistatic_ref.contact.closest_points import ClosestPoints
from quasistatic_ref.contact.distance import contacts_over
from quasistatic_ref.contact.normals import TIED_FACES, UNIQUE_NORMAL
from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.contact.shape_in_world import Pose, poses_in_world
from quasistatic_ref.numbers.arrays import Array, Indices, Mask
from quasistatic_ref.numbers.compiled import compiled
from quasistatic_ref.numbers.ordered import product
from quasistatic_ref.shapes.placed_shape import Box, HalfSpace, PointCloud, Shape
from quasistatic_ref.shapes.rounded import Rounded, distance_to_rounded_box

BLOCKS: Final = 32
"""Of points, from whose nearest ones follows how near the first ones are."""


class Clouds(Batch):
    """Pairs of one cloud, always on the same side, with solids that have a closed form.

    Attributes
    ----------
    cloud_is_alpha : bool
    points : ndarray, shape (N, 3)
        Of the cloud [m].
    is_plane, has_faces : ndarray of bool, shape (P,)
        Of each solid: whether it is a half-space, and whether it has faces that may tie.
    sizes : ndarray, shape (P, 4)
        Half extents of its core and radius [m]; of a half-space normal [-] and offset [m].
    extent : ndarray, shape (P,)
        Of each solid [m]; 0 of a half-space.
    """

    def __init__(self, pairs: Sequence[ContactPair]) -> None:
        super().__init__(pairs)
        self.cloud_is_alpha = isinstance(pairs[0].alpha.shape, PointCloud)
        sides = [(pair.alpha.shape, pair.beta.shape) for pair in pairs]
        solids = [side[self.cloud_is_alpha] for side in sides]
        cloud = sides[0][not self.cloud_is_alpha]
        assert isinstance(cloud, PointCloud)
        self.points = cloud.points
        self.is_plane = np.array([isinstance(solid, HalfSpace) for solid in solids])
        self.has_faces = np.array([isinstance(solid, Box) for solid in solids])
        self.extent = np.where(self.is_plane, 0.0, [solid.extent for solid in solids])
        self.sizes = np.array([closed_form(solid) for solid in solids])
        self._coordinates = np.ascontiguousarray(cloud.points.T)
        self._planes = np.flatnonzero(self.is_plane)
        self._normals, self._offsets = np.split(self.sizes[self._planes], [3], axis=1)
        self._rounded = np.flatnonzero(~self.is_plane)
        self._halves, self._radii = np.split(self.sizes[self._rounded], [3], axis=1)

    @compiled
    def contacts(self, R: Array, t: Array) -> tuple[Mask, ClosestPoints]:
        """The points that rank first on each solid, at poses of the links (L, 3, 3), (L, 3) [m].

        A pair is known where no two faces of its solid are as near to one of them.
        """
        alpha, beta = poses_in_world(self.links, self.poses, R, t)
        places = self.places(alpha, beta)
        return self.of_poses(alpha, beta, places, places)

    def of_poses(
        self, alpha: Pose, beta: Pose, seen: Array, places: Array
    ) -> tuple[Mask, ClosestPoints]:
        """The points that rank first at poses of both; `seen` and `places` are (P,) [m]."""
        cloud, solid = (alpha, beta) if self.cloud_is_alpha else (beta, alpha)
        away = (cloud.t - solid.t)[..., None]
        relative = product(solid.R.mT, np.concatenate([cloud.R, away], axis=2))[..., None]
        x = relative[:, :, 0] * self._coordinates[0]  # in the frame of each solid, (P, 3, N)
        x += relative[:, :, 1] * self._coordinates[1]
        x += relative[:, :, 2] * self._coordinates[2]
        x += relative[:, :, 3]
        phi = self._distances(x)
        first = self._first(phi)
        kept = np.arange(len(x))[:, None], first
        phi = phi[kept]
        x = x.swapaxes(1, 2)[kept]
        known = ~self._ties(x, phi, places)
        surface = phi, self._normals_at(x), np.full(first.shape, UNIQUE_NORMAL)
        points = contacts_over(solid, cloud, self.points[first], 0.0, surface, first)
        return known, points.swapped() if self.cloud_is_alpha else points

    def _distances(self, x: Array) -> Array:
        """Signed distances, (P, N) [m], of points in the frames of the solids, (P, 3, N) [m]."""
        phi = np.empty((len(x), x.shape[2]))
        if len(self._planes):
            along = x[self._planes] * self._normals[..., None]
            height = along[:, 0] + along[:, 1] + along[:, 2]
            phi[self._planes] = height - self._offsets
        if len(self._rounded):  # as distance_to_rounded_box
            excess = np.abs(x[self._rounded]) - self._halves[..., None]
            inside = np.maximum.reduce(excess, axis=1)
            beyond = np.maximum(excess, 0.0, out=excess)
            beyond *= beyond
            outside = np.sqrt(beyond[:, 0] + beyond[:, 1] + beyond[:, 2])
            phi[self._rounded] = outside + np.minimum(inside, 0.0) - self._radii
        return phi

    def _first(self, phi: Array) -> Indices:
        """Numbers of the points that rank first, (P, n_c), of their distances (P, N) [m]."""
        # The n_c-th least of the least of many blocks is no less than the n_c-th least of all.
        blocks = min(phi.shape[1], max(BLOCKS, self.n_c))
        length = phi.shape[1] // blocks
        least = phi[:, : blocks * length].reshape(-1, blocks, length).min(axis=2)
        last = np.partition(least, self.n_c - 1, axis=1)[:, self.n_c - 1]
        pair, point = (~(phi > (last + 2 * self.resolution)[:, None])).nonzero()
        order = np.lexsort((np.rint(phi[pair, point] / self.resolution[pair]), pair))
        start = np.searchsorted(pair, np.arange(len(phi)))
        return np.asarray(point[order[start[:, None] + np.arange(self.n_c)]])

    def _normals_at(self, x: Array) -> Array:
        """The solids' normals at some points of the cloud, both (P, n_c, 3)."""
        normal = np.empty(x.shape)
        normal[self._planes] = self._normals[:, None]
        halves = self._halves.repeat(x.shape[1], axis=0)
        _, away = distance_to_rounded_box(x[self._rounded].reshape(-1, 3), halves)
        normal[self._rounded] = away.reshape(-1, *x.shape[1:])
        return normal

    def _ties(self, x: Array, phi: Array, places: Array) -> Mask:
        """Of which pairs (P,) two faces are as high over a point that touches or is inside."""
        within = TIED_FACES * np.maximum(places, self.extent)
        pair, point = ((phi <= within[:, None]) & self.has_faces[:, None]).nonzero()
        ties = np.zeros(len(x), dtype=bool)
        if len(pair):
            at = x[pair, point]
            half = self._halves[np.searchsorted(self._rounded, pair)]
            heights = np.concatenate([at - half, -at - half], axis=1)
            heights.partition(-2, axis=1)
            ties[pair[heights[:, -2] >= heights[:, -1] - within[pair]]] = True
        return ties


def closed_form(solid: Shape) -> list[float]:
    """A solid as four numbers: half extents and radius [m], or normal [-] and offset [m]."""
    if isinstance(solid, HalfSpace):
        return [*solid.normal, solid.offset]
    assert isinstance(solid, Rounded)
    half, radius = solid.core
    return [*half, radius]
