"""All pairs of a cloud and a solid in arrays, so that a few NumPy calls measure them at once.

Each number has the bits that :mod:`~quasistatic_ref.contact.distance` gives it pair by pair.
"""

from collections.abc import Callable, Sequence
from functools import partial
from itertools import groupby, pairwise

import numpy as np

from quasistatic_ref.contact.distance import ClosestPoints
from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.contact.separations import OWN
from quasistatic_ref.contact.shape_in_world import ShapeInWorld
from quasistatic_ref.contact.tied_faces import cloud_surface
from quasistatic_ref.optional.fast.tracker.tracker_bound import Shortlist
from quasistatic_ref.shapes.placed_shape import Box, HalfSpace, PlacedShape, PointCloud, Shape
from quasistatic_ref.shapes.rounded import Rounded, distance_to_rounded_box
from quasistatic_ref.step.data import Array, Indices
from quasistatic_ref.step.ordered import product, rotated
from quasistatic_ref.tolerances import TIED_FACES

Distance = Callable[[Array], tuple[Array, Array]]
"""As the signed distance of a shape."""


class CloudPairs:
    """Pairs of a cloud and a solid, and the short lists of their points.

    Parameters
    ----------
    pairs : sequence of ContactPair
        Each with one cloud.

    Attributes
    ----------
    P : int
        How many they are.
    link : ndarray of int, shape (2 P,)
        Links of all solids, then of all clouds.
    on_link : ndarray, shape (2 P, 3, 4)
        Where these are on their links: [R, t] [-, m].
    solid_is_beta : ndarray of bool, shape (P,)
        Whether the solid's normal is the contact's the other way round.
    first, last : ndarray of int, shape (P,)
        Each pair's nearest and its farthest contact.
    index : ndarray of int, shape (N,)
        Numbers of all listed points in their clouds.
    points : ndarray, shape (N, 3)
        In their clouds' frames [m].
    start : ndarray of int, shape (P + 1,)
        Where the list of each pair begins among these, and where the last ends.
    slope, offset : ndarray, shapes (P, B, 12) and (P, B)
        The bounds of the lists, as ``Shortlist`` has them.
    """

    def __init__(self, pairs: Sequence[ContactPair]) -> None:
        self.pairs = tuple(pairs)
        self.P = len(pairs)
        self.solids = [sides(pair)[0] for pair in pairs]
        self.clouds = [sides(pair)[1] for pair in pairs]
        every = [*self.solids, *self.clouds]
        self.link = np.array([side.link for side in every], dtype=np.int64)
        self.on_link = np.array([np.column_stack([side.R, side.t]) for side in every])
        self.solid_is_beta = np.array(
            [isinstance(pair.alpha.shape, PointCloud) for pair in pairs], dtype=bool
        )
        count = np.array([pair.n_c for pair in pairs], dtype=np.int64)
        ends = starts(count)
        self.first = ends[:-1]
        self.last = ends[1:] - 1
        pair_of = np.repeat(np.arange(len(pairs)), count)
        self.pair_of = pair_of
        self.no_ties = np.full(len(pair_of), OWN)
        self.sides = np.concatenate([pair_of, len(pairs) + pair_of])
        swapped = self.solid_is_beta[pair_of]
        self.sign = np.where(swapped, -1.0, 1.0)[:, None]
        # alpha and beta of each contact, among all feet on the solids and then all points
        of_solid = np.arange(len(pair_of))
        of_cloud = of_solid + len(pair_of)
        self.alpha_beta = np.where(swapped, [of_cloud, of_solid], [of_solid, of_cloud])
        extents = np.array([solid.shape.extent for solid in self.solids])
        self.extent = float(extents[np.isfinite(extents)].max(initial=0.0))
        shapes = [self.solids[i].shape for i in pair_of]
        self.has_edges = np.array([not isinstance(shape, HalfSpace) for shape in shapes])
        no_box = np.full(3, np.nan)
        half_extents = [
            shape.half_extents if isinstance(shape, Box) else no_box for shape in shapes
        ]
        self.box = np.tile(half_extents, 2)

    def put(self, lists: Sequence[Shortlist]) -> None:
        """Take over the short lists of all pairs."""
        lengths = np.array([len(made.index) for made in lists])
        self.index = np.concatenate([made.index for made in lists])
        self.start = starts(lengths)
        clouds = [cloud.shape for cloud in self.clouds]
        points = [
            cloud.points[made.index]
            for cloud, made in zip(clouds, lists, strict=True)
            if isinstance(cloud, PointCloud)
        ]
        self.points = np.concatenate(points)
        self.slope = np.array([made.bounds[0] for made in lists])
        self.offset = np.array([made.bounds[1] for made in lists])
        self.owner = np.repeat(np.arange(len(lists)), lengths)
        own = [slice(a, b) for a, b in pairwise(self.start.tolist())]
        self.distances = distances([solid.shape for solid in self.solids], own)
        # Where the first n_c of each list are, once each is in ascending order.
        self.leading = np.arange(len(self.pair_of)) + (self.start[:-1] - self.first)[self.pair_of]

    def poses(self, R: Array, t: Array) -> tuple[Array, Array]:
        """Where the solids and the clouds are, at poses (L, 3, 3) and (L, 3) of the links.

        Returns
        -------
        world : ndarray, shape (2 P, 3, 4)
            [R, t] of all solids, then of all clouds [-, m].
        relative : ndarray, shape (P, 3, 4)
            From the cloud's frame to the solid's [-, m].
        """
        P = self.P
        world = product(R.take(self.link, axis=0), self.on_link)
        # Views: `world[:, :, 3] += ...` would write the sums a second time.
        origin = world[:, :, 3]
        origin += t.take(self.link, axis=0)
        apart = world[P:].copy()
        displacement = apart[:, :, 3]
        displacement -= origin[:P]
        return world, product(world[:P, :, :3].transpose(0, 2, 1), apart)

    def measured(self, relative: Array) -> tuple[Array, Array, Array]:
        """Of all listed points: where they are, their signed distances and normals.

        Parameters
        ----------
        relative : ndarray, shape (P, 3, 4)
            [R, t] from the clouds' frames to the solids' [-, m].

        Returns
        -------
        x, phi, normal : ndarray, shapes (N, 3), (N,) and (N, 3)
            In the solids' frames [m], [m] and [-].
        """
        pose = relative.take(self.owner, axis=0)
        x = rotated(pose[:, :, :3], self.points) + pose[:, :, 3]
        found = [distance(x[some]) for some, distance in self.distances]
        phi, normal = map(np.concatenate, zip(*found, strict=True))
        return x, phi, normal

    def kept(self, phi: Array) -> Indices:
        """The n_c closest points of each pair, in ascending distance, of `phi` (N,) [m]."""
        return np.lexsort((phi, self.owner)).take(self.leading)  # ties stay in order

    def limits(self, relative: Array) -> Array:
        """The limit of each list, shape (P,) [m], at `relative` (P, 3, 4) [-, m]."""
        bounds = (self.slope @ relative.reshape(-1, 12, 1))[:, :, 0] + self.offset
        return np.asarray(np.minimum.reduce(bounds, axis=1))

    def contacts(
        self, world: Array, relative: Array, kept: Indices, x: Array, phi: Array, normal: Array
    ) -> ClosestPoints:
        """The contacts in the world frame.

        Parameters
        ----------
        world, relative : ndarray, shapes (2 P, 3, 4) and (P, 3, 4)
            As of :meth:`poses` [-, m].
        kept : ndarray of int, shape (n_c,)
        x, phi, normal : ndarray, shapes (n_c, 3), (n_c,) and (n_c, 3)
            As of :meth:`measured`, of the points that are kept [m], [m] and [-].
        """
        tie = self.no_ties.copy()
        for i in self.open_pairs(world, x, phi):
            own = slice(self.first[i], self.last[i] + 1)
            solid, cloud = (
                ShapeInWorld(side.shape, pose[:, :3], pose[:, 3])
                for side, pose in ((self.solids[i], world[i]), (self.clouds[i], world[self.P + i]))
            )
            name = self.pairs[i].name
            decided = cloud_surface(name, solid, cloud, relative[i], x[own], phi[own], normal[own])
            normal[own] = decided.normal
            tie[own] = decided.tie
        pose = world.take(self.sides, axis=0)
        local = np.concatenate([normal, self.points.take(kept, axis=0)])
        n, point = rotated(pose[:, :, :3], local).reshape(2, -1, 3)
        point += pose[len(phi) :, :, 3]
        foot = point - phi[:, None] * n
        alpha, beta = np.concatenate([foot, point]).take(self.alpha_beta, axis=0)
        n = self.sign * n + 0.0
        return ClosestPoints(phi + 0.0, alpha, beta, n, self.index.take(kept), tie)

    def open_pairs(self, world: Array, x: Array, phi: Array) -> list[int]:
        """Pairs of which a contact touches or is inside, as near to two faces, or may be.

        Parameters
        ----------
        world, x, phi : ndarray, shapes (2 P, 3, 4), (n_c, 3) and (n_c,)
            As of :meth:`contacts` [-, m], [m] and [m].
        """
        within = TIED_FACES * max(self.extent, float(np.abs(world[:, :, 3]).max()))
        (touching,) = ((phi <= within) & self.has_edges).nonzero()
        at = x.take(touching, axis=0)
        heights = np.concatenate([at, -at], axis=1) - self.box.take(touching, axis=0)
        heights.sort(axis=1)
        one_nearest = heights[:, -2] < heights[:, -1] - within  # never of NaN, where no box is
        if np.logical_and.reduce(one_nearest):
            return []
        return sorted({*self.pair_of[touching[~one_nearest]].tolist()})


def sides(pair: ContactPair) -> tuple[PlacedShape, PlacedShape]:
    """The solid and the cloud of a pair."""
    if isinstance(pair.beta.shape, PointCloud):
        return pair.alpha, pair.beta
    return pair.beta, pair.alpha


def starts(lengths: Indices) -> Indices:
    """Where each of some parts begins, and where the last ends, shape (parts + 1,)."""
    return np.concatenate([np.zeros(1, np.int64), np.cumsum(lengths)])


def distances(solids: Sequence[Shape], lists: Sequence[slice]) -> list[tuple[slice, Distance]]:
    """What measures the listed points: boxes, spheres and capsules in a row together.

    Parameters
    ----------
    solids : sequence of Shape
        One for each pair.
    lists : sequence of slice
        The points of each pair among all.
    """
    found: list[tuple[slice, Distance]] = []
    pairs = zip(solids, lists, strict=True)
    for rounded, group in groupby(pairs, lambda pair: isinstance(pair[0], Rounded)):
        each = [*group]
        if not rounded or len(each) == 1:
            found += [(own, solid.signed_distance) for solid, own in each]
            continue
        count = [own.stop - own.start for _, own in each]
        cores = [solid.core for solid, _ in each if isinstance(solid, Rounded)]
        half_extents = np.repeat([half for half, _ in cores], count, axis=0)
        radius = np.repeat([ball for _, ball in cores], count)
        every = slice(each[0][1].start, each[-1][1].stop)
        found.append(
            (every, partial(distance_to_rounded_box, half_extents=half_extents, radius=radius))
        )
    return found
