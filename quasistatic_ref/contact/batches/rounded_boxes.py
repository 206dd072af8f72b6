"""Boxes, capsules and spheres on each other, all at once: boxes of three edges, one or none."""

from collections.abc import Sequence
from functools import cached_property
from typing import Any

import numpy as np

from quasistatic_ref.contact.batches.balls import Spheres
from quasistatic_ref.contact.batches.batch import Batch
from quasistatic_ref.contact.closest_points import ClosestPoints
from quasistatic_ref.contact.crossings import (
    ROUND,
    bearing,
    crossing_number,
    lines_crossed,
)
from quasistatic_ref.contact.distance import (
    SPANNED,
    closest_alone,
    contacts_over,
    filling,
    repeated,
)
from quasistatic_ref.contact.normals import TIED_FACES, TURNED, corner_surface
from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.contact.shape_in_world import Pose, Witnesses
from quasistatic_ref.contact.solids.polytope import UP, Polytope, polytope, stacked
from quasistatic_ref.contact.solids.polytope_pair import padded, polytope_pairs
from quasistatic_ref.numbers.arrays import Array, Indices, Mask
from quasistatic_ref.numbers.ordered import dot, norm, product, rotated
from quasistatic_ref.shapes.placed_shape import Box, Shape, Sphere
from quasistatic_ref.shapes.rounded import Rounded
from quasistatic_ref.tolerances import OVER_FACE, SAME_NORMAL


class BoxOfEach(Box):
    """A box for each of N points: its half extents are of shape (N, 3)."""

    def at_points(self, some: Indices | Mask | slice) -> "BoxOfEach":
        """The boxes of `some` of the points."""
        return BoxOfEach.unchecked(half_extents=self.half_extents[some])


class RoundOfEach(Rounded):
    """A capsule or sphere for each of N points.

    Parameters
    ----------
    half_extents : ndarray, shape (N, 3)
        Of the cores [m].
    radius : ndarray, shape (N,)
        [m].
    """

    def __init__(self, half_extents: Array, radius: Array) -> None:
        self.half_extents = half_extents
        self.radius = radius

    @property
    def core(self) -> tuple[Array, Any]:
        """Half extents of the cores, (N, 3) [m], and radii, (N,) [m]."""
        return self.half_extents, self.radius

    def at_points(self, some: Indices | Mask | slice) -> "RoundOfEach":
        """The solids of `some` of the points."""
        return RoundOfEach(self.half_extents[some], self.radius[some])


class Side:
    """One side of P pairs: boxes, capsules or spheres.

    Parameters
    ----------
    shapes : sequence of Box, of Capsule or of Sphere, length P
    V : int
        Number of corners of a solid of the other side.

    Attributes
    ----------
    half_extents : ndarray, shape (P, 3)
        Of the cores [m].
    radius, extents : ndarray, shape (P,)
        [m].
    corners : ndarray, shape (P, N, 3)
        [m].
    polytopes : list of Polytope
        None of spheres.
    for_corners : Shape
        The solids, each as often as there are corners of the other side.
    """

    def __init__(self, shapes: Sequence[Shape], V: int) -> None:
        cores = [shape.core for shape in shapes if isinstance(shape, Rounded)]
        self.half_extents = np.array([half for half, _ in cores])
        self.radius = np.array([radius for _, radius in cores])
        self.extents = np.array([shape.extent for shape in shapes])
        self.corners = np.array([shape.corners(UP)[0] for shape in shapes])
        self.polytopes = [flat for flat in map(polytope, shapes) if flat is not None]
        self.kind = type(shapes[0])
        half_extents = np.repeat(self.half_extents, V, axis=0)
        self.for_corners: Shape = (
            BoxOfEach.unchecked(half_extents=half_extents)
            if self.kind is Box
            else RoundOfEach(half_extents, np.repeat(self.radius, V))
        )

    @cached_property
    def solids(self) -> Polytope:
        """The polytopes, stacked."""
        return stacked(self.polytopes)

    @property
    def curves_of_each(self) -> int:
        """Number of all edges, or of lines and rims, of a solid."""
        return len(self.solids.edges) if self.kind is Box else ROUND

    def curves(self, pose: Pose, x: Array, n: Array) -> tuple[Array, Mask]:
        """Ends of edges or lines, (P, S, 2, 3) [m] in the world, and which may bear, (P, S).

        As :func:`~quasistatic_ref.contact.crossings.edges` has them of single solids.

        Parameters
        ----------
        pose : Pose
        x, n : ndarray, shape (P, 3)
            Closest points [m], and the pairs' normals out of the solids [-].
        """
        R, t = pose
        way = rotated(R.mT, n)
        if self.kind is not Box:
            ends, borne = capsule_lines(self.half_extents[:, 2], self.radius, way)
            return rotated(R[:, None, None], ends) + t[:, None, None], borne
        borne = bearing(self.solids, self.extents[:, None], rotated(R.mT, x - t), way)
        vertices = rotated(R[:, None], self.solids.vertices) + t[:, None]
        return vertices[:, self.solids.edges], borne


def capsule_lines(half_length: Array, radius: Array, way: Array) -> tuple[Array, Mask]:
    """The lines of P capsules that face directions, (P, 1, 2, 3) [m], and which do, (P, 1).

    Parameters
    ----------
    half_length, radius : ndarray, shape (P,)
        [m].
    way : ndarray, shape (P, 3)
        In the capsules' frames [-].
    """
    radial = norm(way[:, :2])
    borne = radial >= TURNED
    outward = way * [1.0, 1.0, 0.0] / np.where(borne, radial, 1.0)[:, None]
    middle = radius[:, None] * outward
    tip = half_length[:, None] * UP
    ends = np.stack([middle - tip, middle + tip], axis=1)
    return ends[:, None], borne[:, None]


class RoundedBoxes(Batch):
    """Pairs of boxes and capsules; of either and spheres, where several contacts are kept."""

    def __init__(self, pairs: Sequence[ContactPair]) -> None:
        super().__init__(pairs)
        alphas = [pair.alpha.shape for pair in pairs]
        betas = [pair.beta.shape for pair in pairs]
        self._sides = (
            Side(alphas, betas[0].corner_count),
            Side(betas, alphas[0].corner_count),
        )
        self._corners = pairs[0].corners
        is_sphere = [side.kind is Sphere for side in self._sides]
        self._spheres = Spheres(pairs) if any(is_sphere) else None

    def of_poses(
        self, alpha: Pose, beta: Pose, seen: Array, places: Array
    ) -> tuple[Mask, ClosestPoints]:
        """The candidates that rank first; `seen` and `places` are (P,) [m].

        A pair is known where it has one normal, and where a candidate is at the place of the
        closest pair or none is as near: whether others span it is then plain.
        """
        poses = alpha, beta
        extent = np.maximum(*(side.extents for side in self._sides))
        within = TIED_FACES * np.maximum(places, extent)
        if self._spheres is None:
            known, nearest = self._nearest(poses, within)
        else:
            known, points = self._spheres.of_poses(alpha, beta, seen, places)
            nearest = Witnesses(*(field[:, 0] for field in points[:4]))
        if self.n_c == 1:
            return known, closest_alone(nearest, 0)

        phi, on_alpha, _, n = nearest
        on_b = self._corners_on(1, poses, -n, within).swapped()
        on_a = self._corners_on(0, poses, n, within)
        on_a = on_a._replace(point=on_b.point.shape[1] + on_a.point)
        spare = np.full(max(0, self.n_c - self._corners - 1), -1)  # numbers of none
        lists = [on_b, on_a, closest_alone(nearest, self._corners), filling(nearest, spare)]
        if self._spheres is None:
            lists.append(self._crossings(poses, nearest))
        every = ClosestPoints(
            *(np.concatenate(field, axis=1) for field in zip(*lists, strict=True))
        )
        there = every.point >= 0
        closest = every.point == self._corners

        level = there & ~closest & (every.phi <= (phi + self.resolution)[:, None])
        level &= np.abs(every.n - n[:, None]).max(axis=2) <= SAME_NORMAL
        away = norm(every.alpha - on_alpha[:, None])
        at_its_place = (level & (away <= SPANNED / 2 * self.size[:, None])).any(axis=1)
        known &= at_its_place | ~level.any(axis=1)
        there &= ~(closest & at_its_place[:, None]) & (dot(every.n, n[:, None]) >= TURNED)

        rank = np.full(there.shape, np.nan)
        some = there.nonzero()
        ranks = np.rint(every.phi / self.resolution[:, None])[some]
        rank[some] = np.where(repeated(every.chosen(some), some[0]), np.inf, ranks)
        order = rank.argsort(axis=1, kind="stable")[:, : self.n_c]
        first = np.arange(len(order))[:, None], order
        return known, self._filled(
            every.chosen(first), nearest, np.count_nonzero(there, axis=1)[:, None]
        )

    def _nearest(self, poses: tuple[Pose, Pose], within: Array) -> tuple[Mask, Witnesses]:
        """Closest points of boxes and capsules, known where no other normal is `within` (P,) [m].

        As of :meth:`of_poses`.
        """
        a, b = (side.solids for side in self._sides)
        nearest, (gaps, normals) = polytope_pairs(a, b, *poses)
        rivals = np.abs(normals - nearest.n[:, None]).max(axis=2) > SAME_NORMAL / 4
        rivals &= gaps >= (nearest.phi - within)[:, None]
        cores_apart = nearest.phi + (a.margin + b.margin) > within
        return cores_apart | ~rivals.any(axis=1), nearest

    def _filled(self, kept: ClosestPoints, nearest: Witnesses, count: Indices) -> ClosestPoints:
        """The candidates that rank first, `count` (P, 1) of each pair, and copies that fill up."""
        beyond = np.arange(self.n_c) - count
        points = filling(nearest, self._corners + 1 + beyond)
        missing = beyond >= 0
        return ClosestPoints._make(
            np.where(missing if one.ndim == 2 else missing[..., None], copy, one)
            for one, copy in zip(kept, points, strict=True)
        )

    def _corners_on(
        self, on: int, poses: tuple[Pose, Pose], n: Array, within: Array
    ) -> ClosestPoints:
        """The corners of the other side on side `on`, out of which n points."""
        R, t = poses[on]
        R_other, t_other = poses[1 - on]
        other = self._sides[1 - on]
        corners = other.corners
        back = R.mT
        x = rotated(product(back, R_other)[:, None], corners)
        x += rotated(back, t_other - t)[:, None]
        count = corners.shape[1]
        ways = np.repeat(rotated(back, n), count, axis=0)
        near = np.repeat(OVER_FACE * self._sides[on].extents + within, count)
        within = np.repeat(within, count)
        shape = self._sides[on].for_corners
        phi, normal, tie = corner_surface(shape, x.reshape(-1, 3), ways, within, near)
        each = corners.shape[:2]
        surface = phi.reshape(each), normal.reshape(corners.shape), tie.reshape(each)
        number = np.broadcast_to(np.arange(count), (len(n), count))
        radius = other.radius[:, None]
        return contacts_over(poses[on], poses[1 - on], corners, radius, surface, number)

    def _crossings(self, poses: tuple[Pose, Pose], nearest: Witnesses) -> ClosestPoints:
        """Crossings of edges and lines; a number is negative where there are fewer."""
        (ends_a, borne_a), (ends_b, borne_b) = (
            side.curves(pose, x, sign * nearest.n)
            for side, pose, x, sign in zip(self._sides, poses, nearest[1:3], (1, -1), strict=True)
        )
        pair, i, j = np.nonzero(borne_a[:, :, None] & borne_b[:, None])
        n = nearest.n[pair]
        crossing, alpha, beta = lines_crossed(ends_a[pair, i], ends_b[pair, j], n)
        total = self._sides[1].curves_of_each
        number = self._corners + self.n_c + crossing_number(i, j, total)
        points = ClosestPoints(dot(beta - alpha, n), alpha, beta, n, number, 0 * number)
        pair = pair[crossing]
        count = len(nearest.phi)
        return ClosestPoints._make(padded(one, pair, count, -1) for one in points.chosen(crossing))
