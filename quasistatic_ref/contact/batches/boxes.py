"""Boxes on boxes, all at once; the closest pairs alone also of boxes and capsules."""

from collections.abc import Sequence

import numpy as np

from quasistatic_ref.contact.batches.batch import Batch
from quasistatic_ref.contact.crossings import bearing, crossing_number, lines_crossed
from quasistatic_ref.contact.distance import SPANNED, ClosestPoints, contacts_over, repeated
from quasistatic_ref.contact.normals import TIED_FACES, TURNED, UNIQUE_NORMAL, corner_surface
from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.contact.shape_in_world import Pose, Witnesses
from quasistatic_ref.contact.solids.polytope import Polytope, polytope, stacked
from quasistatic_ref.contact.solids.polytope_pair import padded, polytope_pairs
from quasistatic_ref.numbers.arrays import Array, Indices, Mask
from quasistatic_ref.numbers.ordered import dot, norm, product, rotated
from quasistatic_ref.shapes.placed_shape import Box, Shape
from quasistatic_ref.tolerances import FILLED, OVER_FACE, SAME_NORMAL


class BoxOfEach(Box):
    """A box for each of N points: its half extents are of shape (N, 3)."""

    def at_points(self, some: Indices | Mask | slice) -> "BoxOfEach":
        """The boxes of `some` of the points."""
        return BoxOfEach.unchecked(half_extents=self.half_extents[some])


def boxes_of(shapes: Sequence[Shape]) -> Polytope:
    """Boxes or capsules stacked as one array of polytopes."""
    return stacked([flat for flat in map(polytope, shapes) if flat is not None])


class Boxes(Batch):
    """Pairs of boxes; of boxes and capsules, if only one contact of each is kept."""

    def __init__(self, pairs: Sequence[ContactPair]) -> None:
        super().__init__(pairs)
        self._solids = (
            boxes_of([pair.alpha.shape for pair in pairs]),
            boxes_of([pair.beta.shape for pair in pairs]),
        )
        self._extents = (
            np.array([pair.alpha.shape.extent for pair in pairs]),
            np.array([pair.beta.shape.extent for pair in pairs]),
        )
        each = [np.repeat(one.half_extents, one.vertices.shape[1], axis=0) for one in self._solids]
        self._of_corners = [BoxOfEach.unchecked(half_extents=half) for half in each]
        self._corners = pairs[0].corners

    def of_poses(
        self, alpha: Pose, beta: Pose, seen: Array, places: Array
    ) -> tuple[Mask, ClosestPoints]:
        """The candidates that rank first; `seen` and `places` are (P,) [m].

        A pair is known where it has one normal, and where a candidate is at the place of the
        closest pair or none is as near: whether others span it is then plain.
        """
        poses = alpha, beta
        nearest, (gaps, normals) = polytope_pairs(*self._solids, *poses)
        phi, on_alpha, _, n = nearest
        extent = np.maximum(*self._extents)
        within = TIED_FACES * np.maximum(places, extent)
        rivals = np.abs(normals - n[:, None]).max(axis=2) > SAME_NORMAL / 4
        rivals &= gaps >= (phi - within)[:, None]
        a, b = self._solids
        known = (phi + (a.margin + b.margin) > within) | ~rivals.any(axis=1)
        if self.n_c == 1:
            return known, self._alone(nearest)

        on_b = self._corners_on(1, poses, -n, within).swapped()
        on_a = self._corners_on(0, poses, n, within)
        on_a = on_a._replace(point=on_b.point.shape[1] + on_a.point)
        lists = [on_b, on_a, self._alone(nearest), self._crossings(poses, nearest)]
        every = ClosestPoints(
            *(np.concatenate(field, axis=1) for field in zip(*lists, strict=True))
        )
        there = every.point >= 0
        alone = every.point == self._corners

        level = there & ~alone & (every.phi <= (phi + self.resolution)[:, None])
        level &= np.abs(every.n - n[:, None]).max(axis=2) <= SAME_NORMAL
        away = norm(every.alpha - on_alpha[:, None])
        at_its_place = (level & (away <= SPANNED / 2 * self.size[:, None])).any(axis=1)
        known &= at_its_place | ~level.any(axis=1)
        there &= ~(alone & at_its_place[:, None]) & (dot(every.n, n[:, None]) >= TURNED)

        rank = np.full(there.shape, np.nan)
        some = there.nonzero()
        ranks = np.rint(every.phi / self.resolution[:, None])[some]
        rank[some] = np.where(repeated(every.chosen(some), some[0]), np.inf, ranks)
        order = rank.argsort(axis=1, kind="stable")[:, : self.n_c]
        first = np.arange(len(order))[:, None], order
        return known, self._filled(
            every.chosen(first), nearest, np.count_nonzero(there, axis=1)[:, None]
        )

    def _filled(self, kept: ClosestPoints, nearest: Witnesses, count: Indices) -> ClosestPoints:
        """The candidates that rank first, `count` (P, 1) of each pair, and copies that fill up."""
        beyond = np.arange(self.n_c) - count
        far = nearest._replace(phi=np.maximum(FILLED, 2 * nearest.phi))
        points = self._alone(far)._replace(point=self._corners + 1 + beyond)
        missing = beyond >= 0
        return ClosestPoints._make(
            np.where(missing if one.ndim == 2 else missing[..., None], copy, one)
            for one, copy in zip(kept, points, strict=True)
        )

    def _alone(self, nearest: Witnesses) -> ClosestPoints:
        """The closest pairs, as candidates."""
        number = np.full(len(nearest.phi), self._corners if self.n_c > 1 else 0)
        points = ClosestPoints(*nearest, number, np.full_like(number, UNIQUE_NORMAL))
        return ClosestPoints._make(field[:, None] for field in points)

    def _corners_on(
        self, on: int, poses: tuple[Pose, Pose], n: Array, within: Array
    ) -> ClosestPoints:
        """The corners of the other side on side `on`, out of which n points."""
        R, t = poses[on]
        R_other, t_other = poses[1 - on]
        corners = self._solids[1 - on].vertices
        back = R.mT
        x = rotated(product(back, R_other)[:, None], corners)
        x += rotated(back, t_other - t)[:, None]
        count = corners.shape[1]
        ways = np.repeat(rotated(back, n), count, axis=0)
        near = np.repeat(OVER_FACE * self._extents[on] + within, count)
        within = np.repeat(within, count)
        shape = self._of_corners[on]
        phi, normal, tie = corner_surface(shape, x.reshape(-1, 3), ways, within, near)
        surface = phi.reshape(-1, count), normal.reshape(corners.shape), tie.reshape(-1, count)
        number = np.broadcast_to(np.arange(count), (len(n), count))
        return contacts_over(poses[on], poses[1 - on], corners, 0.0, surface, number)

    def _crossings(self, poses: tuple[Pose, Pose], nearest: Witnesses) -> ClosestPoints:
        """Crossings of edges; a pair of edges that do not cross has a negative number."""
        some: list[Mask] = []
        ends: list[Array] = []
        of_side = zip(self._solids, self._extents, poses, nearest[1:3], (1, -1), strict=True)
        for flat, extent, (R, t), x, sign in of_side:
            back = R.mT
            way = rotated(back, sign * nearest.n)
            some.append(bearing(flat, extent[:, None], rotated(back, x - t), way))
            world = rotated(R[:, None], flat.vertices) + t[:, None]
            ends.append(world[:, flat.edges])
        pair, i, j = np.nonzero(some[0][:, :, None] & some[1][:, None])
        n = nearest.n[pair]
        crossing, alpha, beta = lines_crossed(ends[0][pair, i], ends[1][pair, j], n)
        number = self._corners + self.n_c + crossing_number(i, j, some[1].shape[1])
        points = ClosestPoints(dot(beta - alpha, n), alpha, beta, n, number, 0 * number)
        pair = pair[crossing]
        count = len(nearest.phi)
        return ClosestPoints._make(padded(one, pair, count, -1) for one in points.chosen(crossing))
