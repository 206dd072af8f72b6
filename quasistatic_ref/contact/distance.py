"""Closest points, signed distances and normals of the pairs, in the world frame.

Contacts rank by their signed distances, rounded to the nearest multiple of the pair's
:attr:`~quasistatic_ref.contact.pairs.ContactPair.resolution`; among equal ones the lower number
comes first. They are listed in that order. What lies still on a face keeps its contacts and their
order, though its distances change in the last bit from step to step. The distances themselves are
not rounded.

A cloud on a solid: the k points of the cloud that rank first are the contacts. Of a cloud on a
convex mesh most points are dropped before their gaps are formed: ranks.py says why none of
them could be among the k.

Two solids:

- The candidates are alpha's corners on beta, beta's corners on alpha, the closest pair and
  crossings of their edges, numbered in that order. Those whose normal is not about the pair's are
  left out. So is the closest pair where it is in the convex hull of others that are as near and
  have its normal: its rows follow from theirs.
- The k candidates that rank first are the contacts. Candidates that repeat an earlier one rank
  after all others. Corners that cannot be among the k are left out: corners.py says which.
- No candidate is nearer than the closest pair, so k = 1 keeps that one alone.
- Where fewer than k candidates are left, the number is filled with copies of the closest pair at
  the distance ``FILLED``, or twice its own if that is more: their rows are its own, only farther,
  and bear nothing.
"""

from dataclasses import replace
from typing import Final

import numpy as np

from quasistatic_ref.contact.closest_points import ClosestPoints, joined_contacts
from quasistatic_ref.contact.corners import least_distances, towards
from quasistatic_ref.contact.crossings import crossings
from quasistatic_ref.contact.normals import (
    BISECTOR,
    FAR_PLACES,
    TURNED,
    UNIQUE_NORMAL,
    Surface,
    cloud_surface,
    corner_surface,
    pair_normal,
    rounding,
)
from quasistatic_ref.contact.outlines import NO_LIE, Lie, bearing_corners, lie
from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.contact.ranks import closest, near_points, rounded_gaps
from quasistatic_ref.contact.shape_in_world import (
    Pose,
    ShapeInWorld,
    Witness,
    Witnesses,
    on_plane,
    poses_in_world,
)
from quasistatic_ref.numbers.arrays import Array, Indices, Mask
from quasistatic_ref.numbers.ordered import crossed, dot, norm, product, rotated
from quasistatic_ref.shapes.placed_shape import HalfSpace, PointCloud
from quasistatic_ref.tolerances import FILLED, OVER_FACE, REPEATED, SAME_NORMAL

SPANNED: Final = 1e-6
"""How far out of the convex hull of other contacts a closest pair may be, relative to the smaller
shape [-], for its rows to follow from theirs: on surfaces that are nearly parallel closest points
are not known better."""

START: Final = 4
"""For how many corners of each contact distances are formed at first, and how many times more
where fewer than k of them are candidates."""

FEW_POINTS = 50
"""Most points of a plane of which each two are taken in turn; of more, those of its outline."""

WEIGHTS: Final = np.cos(np.arange(7))
"""Of a candidate's distance, place and normal, in a sum that few have in common by symmetry [-]."""


def pair_closest_points(pair: ContactPair, R: Array, t: Array) -> ClosestPoints:
    """The contacts of one pair, as they rank; R (L, 3, 3), t (L, 3) are the links'."""
    a, b = in_world(pair, R, t)
    if isinstance(b.shape, PointCloud):
        return _cloud_on_solid(pair, a, b)
    if isinstance(a.shape, PointCloud):
        return _cloud_on_solid(pair, b, a).swapped()
    if _places(a, b) < FAR_PLACES * pair.size:
        return _solid_on_solid(pair, a, b)
    a, b, origin = _from_near(a, b)
    points = _solid_on_solid(pair, a, b)
    return points._replace(alpha=points.alpha + origin, beta=points.beta + origin)


def _places(a: ShapeInWorld, b: ShapeInWorld) -> float:
    """The largest coordinate of the places of two solids [m]."""
    offsets = [abs(s.shape.offset) for s in (a, b) if isinstance(s.shape, HalfSpace)]
    return float(max(np.abs(a.t).max(), np.abs(b.t).max(), *offsets, 0.0))


def _from_near(a: ShapeInWorld, b: ShapeInWorld) -> tuple[ShapeInWorld, ShapeInWorld, Array]:
    """Two solids as they are seen from a point of them, and that point, shape (3,) [m]."""
    if isinstance(b.shape, HalfSpace):
        b, a, foot = _from_near(b, a)
        return a, b, foot
    if isinstance(a.shape, HalfSpace):
        foot, of_plane, above = on_plane(a.shape.normal, a.shape.offset, a.pose, b.t)
        return a._replace(t=of_plane), b._replace(t=above), foot
    away = _places(a, b)
    seen = a._replace(t=a.t - b.t, away=away), b._replace(t=np.zeros(3), away=away)
    return *seen, b.t


def _solid_on_solid(pair: ContactPair, a: ShapeInWorld, b: ShapeInWorld) -> ClosestPoints:
    """The contacts of two solids."""
    nearest = nearest_of_solids(pair, a, b)
    if pair.n_c == 1:
        return nearest
    candidates, rank, grain = ranked_candidates(pair, a, b, nearest)
    order = closest(rounded_gaps(rank, max(pair.resolution, grain)), pair.k)
    kept = candidates.chosen(order)
    missing = np.arange(pair.n_c - len(order))
    copies = filling(Witnesses(*nearest[:4]), pair.corners + 1 + missing)
    return joined_contacts([kept, copies.chosen((np.array(0), missing))])


def closest_alone(nearest: Witnesses, number: int) -> ClosestPoints:
    """P closest pairs as contacts of a `number`, with fields of shape (P, 1, ...)."""
    numbers = np.full(len(nearest.phi), number)
    points = ClosestPoints(*nearest, numbers, np.full_like(numbers, UNIQUE_NORMAL))
    return ClosestPoints._make(field[:, None] for field in points)


def filling(nearest: Witnesses, number: Indices) -> ClosestPoints:
    """Copies of P closest pairs, farther than these, that fill up contacts: shape (P, N).

    Parameters
    ----------
    nearest : Witnesses
    number : ndarray of int, shape (N,) or (P, N)
        Their numbers.
    """
    far = nearest._replace(phi=np.maximum(FILLED, 2 * nearest.phi))
    pair = np.arange(len(far.phi))[:, None]
    copies = closest_alone(far, 0).chosen((pair, 0 * number + 0 * pair))
    return copies._replace(point=np.broadcast_to(number, copies.point.shape))


def ranked_candidates(
    pair: ContactPair, a: ShapeInWorld, b: ShapeInWorld, nearest: ClosestPoints
) -> tuple[ClosestPoints, Array, float]:
    """Candidates of two solids among which are the k that rank first, in order.

    Returns
    -------
    candidates : ClosestPoints
    rank : ndarray, shape (N,)
        Their distances, infinite of those that repeat an earlier one [m].
    grain : float
        Of faces that lie on each other; 0 of others [m].
    """
    n = nearest.n[0]
    faces = lie(pair.grain, a, b, Witness(nearest.phi[0], nearest.alpha[0], nearest.beta[0], n))
    grain = faces.grain
    of_a = Corners(b, a, nearest.alpha[0], -n, faces)
    of_b = Corners(a, b, nearest.beta[0], n, faces)
    crossing = _crossings(pair, a, b, nearest, grain)
    split = len(of_a.least)
    least = np.concatenate([of_a.least, of_b.least])
    order = least.argsort()[: np.count_nonzero(least < np.inf)]
    count = START * pair.k
    while True:
        some = np.sort(order[:count])
        on_b = of_a.contacts(some[some < split]).swapped()
        on_a = of_b.contacts(some[some >= split] - split)
        on_a = on_a._replace(point=split + on_a.point)
        candidates = _candidates(pair, nearest, on_b, on_a, crossing, grain)
        repeats = repeated(candidates, np.zeros_like(candidates.point), grain)
        rank = np.where(repeats, np.inf, candidates.phi)
        limit = _limit(rank[candidates.point != pair.corners], pair, nearest, grain)
        needed = int(np.count_nonzero(least[order] <= limit))
        if needed <= count:
            return candidates, rank, grain
        count = needed if limit < np.inf else START * count


def _limit(rank: Array, pair: ContactPair, nearest: ClosestPoints, grain: float) -> float:
    """The distance beyond which no other candidate counts [m], given the ranks of some.

    One beyond it neither ranks before the k-th of these, nor is repeated by it, nor spans the
    closest pair.
    """
    if pair.k > len(rank):
        return np.inf
    kth = np.partition(rank, pair.k - 1)[pair.k - 1]
    return float(max(kth, nearest.phi[0]) + 2 * max(pair.resolution, grain) + max(REPEATED, grain))


def number_within(pair: ContactPair, R: Array, t: Array, within: float) -> int:
    """How many candidates of a pair are at most that much farther than its nearest one.

    Parameters
    ----------
    pair : ContactPair
        Of any k.
    R, t : ndarray, shapes (L, 3, 3) and (L, 3)
        The links'.
    within : float
        [m].
    """
    a, b = in_world(pair, R, t)
    if isinstance(b.shape, PointCloud):
        a, b = b, a
    if isinstance(a.shape, PointCloud):
        grain = 0.0
        phi, _ = b.shape.signed_distance(b.pose.of(a.pose).points(a.shape.points))
    else:
        if _places(a, b) >= FAR_PLACES * pair.size:
            a, b, _ = _from_near(a, b)
        pair = replace(pair, k=pair.candidates)
        _, phi, grain = ranked_candidates(pair, a, b, nearest_of_solids(pair, a, b))
    return int(np.count_nonzero(phi <= phi.min() + within + max(pair.resolution, grain)))


def nearest_of_solids(pair: ContactPair, a: ShapeInWorld, b: ShapeInWorld) -> ClosestPoints:
    """The closest pair of two solids, numbered after the corners if several contacts are kept."""
    nearest, tie = pair_normal(pair.name, a, b, pair.n_c < pair.candidates)
    return ClosestPoints(
        phi=np.array([nearest.phi]),
        alpha=nearest.alpha[None],
        beta=nearest.beta[None],
        n=nearest.n[None],
        point=np.array([pair.corners if pair.n_c > 1 else 0]),
        tie=np.array([tie]),
    )


def _candidates(
    pair: ContactPair,
    nearest: ClosestPoints,
    on_b: ClosestPoints,
    on_a: ClosestPoints,
    crossing: ClosestPoints,
    grain: float,
) -> ClosestPoints:
    """All candidates: alpha's corners on beta, beta's on alpha, the closest pair, crossings.

    Corners whose normal is not about the pair's are none: they cannot bear with it. The closest
    pair is none where others span it.
    """
    n = nearest.n[0]
    others = joined_contacts([on_b, on_a, crossing])
    alone = [] if spanned(nearest, others, pair, grain) else [nearest]
    every = joined_contacts([on_b, on_a, *alone, crossing])
    if nearest.tie[0] == BISECTOR:
        alike = np.abs(every.n - n).max(axis=1) <= SAME_NORMAL
        every = every._replace(tie=np.where(alike, BISECTOR, every.tie))
    return every.chosen(np.flatnonzero(dot(every.n, n) >= TURNED))


def spanned(nearest: ClosestPoints, others: ClosestPoints, pair: ContactPair, grain: float) -> bool:
    """Whether a closest pair is in the convex hull of others that are as near and have its normal.

    Contacts of one normal have rows that are affine in their places and distances, so that the rows
    of the closest pair then follow from the others'. As a contact it would only take the place of a
    corner: on the middle of an edge that lies on a floor, that of the next corner.

    Points of one plane have x in their hull if no line parts it from them. Of the ways out of x the
    farthest is towards one of them, or across the line through two.

    Parameters
    ----------
    nearest : ClosestPoints
        One contact.
    others : ClosestPoints
        The other candidates.
    pair : ContactPair
    grain : float
        Of faces that lie on each other; 0 of others [m].
    """
    n = nearest.n[0]
    level = others.phi <= nearest.phi + max(pair.resolution, grain)
    level &= np.abs(others.n - n).max(axis=1) <= SAME_NORMAL
    away = others.alpha[level] - nearest.alpha
    if not len(away):
        return False
    if len(away) > FEW_POINTS:
        away = away[_outline(away, n)]
        between = away - np.roll(away, 1, axis=0)
        between = np.concatenate([between, -between])
    else:
        between = (away[:, None] - away).reshape(-1, 3)
    ways = np.concatenate([away, crossed(n[None], between)])
    length = norm(ways)
    ways = ways / np.where(length > 0, length, 1.0)[:, None]
    apart = product(ways, away.T).min(axis=1).max()
    return bool(apart <= max(SPANNED * pair.size, grain))


def _outline(points: Array, n: Array) -> Indices:
    """Numbers of the corners of the hull of points (N, 3), seen along n, one after another."""
    from scipy.spatial import ConvexHull  # takes as long as a short run

    flat = np.delete(points, np.abs(n).argmax(), axis=1)  # it has the same corners
    return np.asarray(ConvexHull(flat, qhull_options="QJ").vertices)  # QJ: all in a line, as well


def _crossings(
    pair: ContactPair, a: ShapeInWorld, b: ShapeInWorld, nearest: ClosestPoints, grain: float
) -> ClosestPoints:
    """Crossings of edges, with the pair's normal, numbered after contacts that fill the number."""
    n = nearest.n[0]
    crossed = crossings(a, b, nearest.alpha[0], nearest.beta[0], n, grain)
    count = len(crossed.number)
    if not count:
        return joined_contacts([])
    return ClosestPoints(
        phi=dot(crossed.beta - crossed.alpha, n),
        alpha=crossed.alpha,
        beta=crossed.beta,
        n=np.tile(n, (count, 1)),
        point=pair.corners + pair.n_c + crossed.number,
        tie=np.full(count, UNIQUE_NORMAL),
    )


def repeated(candidates: ClosestPoints, pair: Indices, grain: float = 0.0) -> Mask:
    """Mask of candidates, shape (N,), that repeat an earlier one of their `pair`, (N,).

    Those that are alike in all entries are near to each other in a weighted sum of these as well,
    so that only neighbours in its order are compared: next ones, next but one and so on.

    Parameters
    ----------
    candidates : ClosestPoints
    pair : ndarray of int, shape (N,)
    grain : float
        Of the pair's meshes: places within it are one [m].
    """
    gives = max(REPEATED, grain)
    every = np.column_stack(
        [candidates.phi, candidates.alpha, candidates.n * (gives / SAME_NORMAL)]
    )
    total = (every * WEIGHTS).sum(axis=1)
    order = np.lexsort((total, pair))
    near = 2 * len(WEIGHTS) * gives  # twice, for what the sums round
    repeats = np.zeros(len(total), dtype=bool)
    for shift in range(1, len(total)):
        a = order[:-shift]
        b = order[shift:]
        close = np.flatnonzero((pair[a] == pair[b]) & (total[b] - total[a] <= near))
        if not close.size:
            break
        a = a[close]
        b = b[close]
        same = np.abs(every[a] - every[b]).max(axis=1) <= gives
        repeats[np.maximum(a, b)[same]] = True
    return repeats


def _cloud_on_solid(pair: ContactPair, solid: ShapeInWorld, cloud: ShapeInWorld) -> ClosestPoints:
    """The k points of a cloud that are nearest to a solid, by rounded distance."""
    assert isinstance(cloud.shape, PointCloud)
    relative = solid.pose.of(cloud.pose)
    near, x = near_points(solid.shape, cloud.shape, relative, pair.k, pair.resolution)
    phi, normal = solid.shape.signed_distance(x)
    kept = closest(rounded_gaps(phi, pair.resolution), pair.k)
    surface = cloud_surface(pair.name, solid, cloud, relative, x[kept], phi[kept], normal[kept])
    point = near[kept]
    return contacts_over(solid.pose, cloud.pose, cloud.shape.points[point], 0.0, surface, point)


class Corners:
    """The corners of one solid as candidates for contacts with another solid.

    Parameters
    ----------
    solid, other : ShapeInWorld
    nearest : ndarray, shape (3,)
        The closest point of the other [m].
    n : ndarray, shape (3,)
        The pair's normal out of the solid [-].
    faces : Lie
        How faces of both lie on each other.

    Attributes
    ----------
    least : ndarray, shape (N,)
        Lower bounds of their distances as candidates, infinite of those that are none [m].
    """

    def __init__(
        self,
        solid: ShapeInWorld,
        other: ShapeInWorld,
        nearest: Array,
        n: Array,
        faces: Lie = NO_LIE,
    ) -> None:
        self._points, self._radius = other.shape.corners(towards(other, nearest, -n))
        self._solid = solid
        self._other = other
        self._x = solid.pose.of(other.pose).points(self._points)
        self._way = solid.pose.local_direction(n)
        self._within = rounding(solid, other)
        self._near = max(OVER_FACE * solid.shape.extent + self._within, faces.grain)
        self._tilt = faces.tilt
        least = least_distances(solid.shape, self._x, self._way, self._near)
        self.least = least - self._radius
        self.least[~bearing_corners(other.shape)] = np.inf

    def contacts(self, some: Indices) -> ClosestPoints:
        """Closest points of the corners of some numbers, the solid being alpha's."""
        if not len(some):
            return joined_contacts([])
        x = self._x[some]
        surface = corner_surface(self._solid.shape, x, self._way, self._within, self._near)
        if self._tilt > SAME_NORMAL:
            phi, normal, tie = surface
            on_face = np.abs(normal - self._way).max(axis=1) <= self._tilt
            surface = phi, np.where(on_face[:, None], self._way, normal), tie
        poses = self._solid.pose, self._other.pose
        return contacts_over(*poses, self._points[some], self._radius, surface, some)


def contacts_over(
    solid: Pose,
    other: Pose,
    points: Array,
    radius: float | Array,
    surface: Surface,
    number: Indices,
) -> ClosestPoints:
    """Contacts of a solid, alpha's, with points of beta's body, each the middle of a ball.

    Parameters
    ----------
    solid, other : Pose
    points : ndarray, shape (..., N, 3)
        In the frame of the other body [m].
    radius : float or ndarray, shape (..., 1)
        [m].
    surface : tuple of ndarray
        What the points have on the solid, in its frame, of shape (..., N) and (..., N, 3).
    number : ndarray of int, shape (..., N)
        Of the points.
    """
    phi, normal, tie = surface
    n = rotated(solid.R[..., None, :, :], normal)
    centre = rotated(other.R[..., None, :, :], points) + other.t[..., None, :]
    return ClosestPoints(
        phi=phi - radius,
        alpha=centre - phi[..., None] * n,
        beta=centre - np.asarray(radius)[..., None] * n,
        n=n,
        point=number,
        tie=tie,
    )


def in_world(pair: ContactPair, R: Array, t: Array) -> tuple[ShapeInWorld, ShapeInWorld]:
    """Alpha's and beta's shapes in the world; R (L, 3, 3), t (L, 3) [m] are the links'."""
    pose_a, pose_b = poses_in_world([pair.alpha.link, pair.beta.link], pair.poses, R, t)
    return ShapeInWorld(pair.alpha.shape, *pose_a), ShapeInWorld(pair.beta.shape, *pose_b)
