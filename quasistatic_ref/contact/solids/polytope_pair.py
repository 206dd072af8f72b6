"""Closest points of two convex polytopes: a closed form, apart and in penetration.

Let s(n) be the gap between the two along a unit vector n. The signed distance is the largest
s(n): apart, that is the distance; in penetration, minus the least translation that parts them.
It is attained at a face of the Minkowski difference, that is at a normal of a face of either,
or at the common normal of an edge of each whose arcs on the Gauss sphere cross; apart, also
between two corners, or a corner and an edge.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from quasistatic_ref.contact.ranks import cannot_be_excluded
from quasistatic_ref.contact.shape_in_world import Pose, Witnesses
from quasistatic_ref.contact.solids.near_features import (
    are_fine,
    edges_within,
    giving_way,
    near_features,
)
from quasistatic_ref.contact.solids.polytope import Polytope
from quasistatic_ref.numbers.arrays import Array, Indices
from quasistatic_ref.numbers.ordered import crossed, dot, norm, product, rotated, total
from quasistatic_ref.shapes.convex_mesh import ConvexMesh
from quasistatic_ref.shapes.placed_shape import Capsule
from quasistatic_ref.tolerances import ON_SURFACE, OUTSIDE_FACE


def polytope_pairs(
    a: Polytope, b: Polytope, pose_a: Pose, pose_b: Pose, within: float = np.inf
) -> tuple[Witnesses, tuple[Array, Array]]:
    """Closest points of P pairs of polytopes in the world frame, and gaps along normals.

    Parameters
    ----------
    a, b : Polytope
        P of each, as of :func:`~quasistatic_ref.contact.solids.polytope.stacked`.
    pose_a, pose_b : tuple of ndarray
        Of their frames in the world.
    within : float
        How much smaller than the largest gap those may be that are wanted [m].

    Returns
    -------
    points : Witnesses
    gaps, normals : ndarray, shapes (P, N) and (P, N, 3)
        Along the normals of wanted gaps, and of others [m], [-].
    """
    back = pose_a.R.mT
    R = product(back, pose_b.R)
    t = rotated(back, pose_b.t - pose_a.t)
    if isinstance(a.shape, Capsule) and isinstance(b.shape, Capsule):
        phi, alpha, beta, n = _capsule_pairs(a, b.in_frame(R, t))
        gaps = -(phi + a.margin + b.margin)[:, None]  # the other way, as wide where axes meet
        normals = -n[:, None]
    else:
        gaps, normals = gaps_between(a, b.in_frame(R, t), within)
        phi, alpha, beta, n = _closest(a, b, R, t, gaps, normals)
    turn = pose_a.R[:, None]
    alpha, beta, n = rotated(turn, np.stack([alpha, beta, n], axis=1)).swapaxes(0, 1)
    points = Witnesses(phi, alpha + pose_a.t, beta + pose_a.t, n)
    return points, (gaps - a.margin[:, None] - b.margin[:, None], rotated(turn, normals))


def _closest(
    a: Polytope, b: Polytope, R: Array, t: Array, gaps: Array, normals: Array
) -> Witnesses:
    """The closest points in the frames of `a`, from the gaps of the cores along all normals."""
    every = np.arange(len(t))
    best = gaps.argmax(axis=1)
    gap = gaps[every, best]
    n = normals[every, best]
    sizes = [np.abs(points).max(axis=(1, 2)) for points in (a.vertices, b.vertices, t[:, None])]
    size = np.maximum.reduce(sizes)
    apart = gap > 0
    push = gap[:, None] * n
    # Of those in penetration: parted along n, they touch where they are deepest now.
    shift = np.where(apart[:, None], t, t - push)
    on_a, on_b, miss = _nearest(a, b, R, shift, np.where(apart[:, None], push, 0.0), n, size)
    between = on_b - on_a
    distance = norm(between)
    edge = apart & (miss > OUTSIDE_FACE * size) & (distance > ON_SURFACE * size)
    gap = np.where(edge, distance, gap)
    n = np.where(edge[:, None], between / np.where(edge, distance, 1.0)[:, None], n)
    return _with_margins(a, b, gap, on_a, n)


def _with_margins(a: Polytope, b: Polytope, gap: Array, on_a: Array, n: Array) -> Witnesses:
    on_b = on_a + gap[:, None] * n
    alpha = on_a + a.margin[:, None] * n
    return Witnesses(gap - a.margin - b.margin, alpha, on_b - b.margin[:, None] * n, n)


def _capsule_pairs(a: Polytope, b: Polytope) -> Witnesses:
    """Two segments have no volume: the distance is never negative, but may be without direction."""
    tail_a = a.tails[:, 0]
    tail_b = b.tails[:, 0]
    way_a = a.ways[:, 0]
    way_b = b.ways[:, 0]
    s, r = nearest_on_segments(tail_a, way_a, tail_b, way_b)
    on_a = tail_a + s[:, None] * way_a
    on_b = tail_b + r[:, None] * way_b
    apart = on_b - on_a
    gap = norm(apart)
    size = np.maximum(*(np.abs(one.vertices).max(axis=(1, 2)) for one in (a, b)))
    across = crossed(way_a, way_b)
    steepness = np.sqrt(dot(across, across) / (dot(way_a, way_a) * dot(way_b, way_b)))
    inside = (s > 0) & (s < 1) & (r > 0) & (r < 1)
    meet = gap <= ON_SURFACE * size  # axes that cross, or lie in each other
    oblique = norm(across) > ON_SURFACE * size**2
    # Elsewhere inside of both, the difference of near points has few digits.
    along = np.where(meet, oblique, inside & (steepness * size > gap))
    n = np.where(along[:, None], across, np.where(meet[:, None], a.normals[:, 0], apart))
    chosen = along | meet
    n = np.where((chosen & (dot(n, apart) < 0))[:, None], -n, n)
    length = norm(n)
    gap = np.where(chosen, dot(n, apart) / length, gap)
    return _with_margins(a, b, gap, on_a, n / length[:, None])


def gaps_between(a: Polytope, b: Polytope, within: float) -> tuple[Array, Array]:
    """Gaps along the normals of the faces of the Minkowski differences.

    Parameters
    ----------
    a, b : Polytope
        P of each, in one frame a pair.
    within : float
        As of :func:`polytope_pairs` [m].

    Returns
    -------
    gaps : ndarray, shape (P, N)
        [m]; -inf where there is none.
    normals : ndarray, shape (P, N, 3)
        From a to b [-].
    """
    corners_a = a.vertices.mT
    corners_b = b.vertices.mT
    normals_a = a.normals
    normals_b = b.normals
    offsets_a = a.offsets
    offsets_b = b.offsets
    if within < np.inf and are_fine(a, b):
        faces_a, faces_b, edges_a, edges_b = near_features(a, b, within)
        normals_a = normals_a[:, faces_a]
        normals_b = normals_b[:, faces_b]
        offsets_a = offsets_a[:, faces_a]
        offsets_b = offsets_b[:, faces_b]
        a = a.part(edges_a)
        b = b.part(edges_b)
    along_a = product(normals_a, corners_b).min(axis=2) - offsets_a
    along_b = product(normals_b, corners_a).min(axis=2) - offsets_b
    pair, crossing, gaps = _crossing_edges(a, b)
    along_edges = padded(gaps, pair, len(along_a), -np.inf)
    crossing = padded(crossing, pair, len(along_a), 0.0)
    normals = np.concatenate([normals_a, -normals_b, crossing], axis=1)
    return np.concatenate([along_a, along_b, along_edges], axis=1), normals


def padded(values: NDArray[Any], pair: Indices, count: int, filling: float) -> NDArray[Any]:
    """Values of P pairs as one row for each pair, short rows filled up.

    Parameters
    ----------
    values : ndarray, shape (N, ...)
        [any unit].
    pair : ndarray of int, shape (N,)
        Of which pair each is, in ascending order.
    count : int
        Number of pairs, P.
    filling : float
        Where a pair has fewer values than another [their unit].

    Returns
    -------
    ndarray, shape (P, M, ...)
        M being the largest number of values of a pair.
    """
    if count == 1:
        return values[None]
    place = np.arange(len(pair)) - np.searchsorted(pair, pair)
    shape = (count, place.max(initial=-1) + 1, *values.shape[1:])
    together = np.full(shape, filling, values.dtype)
    together[pair, place] = values
    return together


def _crossing_edges(a: Polytope, b: Polytope) -> tuple[Indices, Array, Array]:
    """Normals from a to b of edges whose arcs cross, and the gaps along the normals.

    Before them stands of which pair each is. The arc of an edge joins the normals of its two faces;
    those of b count negated. (D. Gregorius, "The separating axis test between convex polyhedra".)
    """
    b_on_a = product(-a.ways, b.normals.mT)
    a_on_b = product(b.ways, a.normals.mT)
    c = b_on_a[..., b.sides[:, 0]]
    d = b_on_a[..., b.sides[:, 1]]
    e = a_on_b[..., a.sides[:, 0]].mT
    f = a_on_b[..., a.sides[:, 1]].mT
    # Each arc has its ends on different sides of the plane of the other ...
    pair, i, j = np.nonzero((c * d < 0) & (e * f < 0))
    if not len(pair):
        return pair, np.zeros((0, 3)), np.zeros(0)
    way_a = a.ways[pair, i]
    way_b = b.ways[pair, j]
    n = crossed(way_a, way_b)
    length = norm(n)
    steep = length > ON_SURFACE * np.sqrt(dot(way_a, way_a) * dot(way_b, way_b))
    n = n / np.where(steep, length, 1.0)[:, None]
    # ... and they are on the same hemisphere: n is on the side of a's normals and of -b's.
    side_a = dot(n, a.normals[pair, a.sides[i, 0]] + a.normals[pair, a.sides[i, 1]])
    side_b = -dot(n, b.normals[pair, b.sides[j, 0]] + b.normals[pair, b.sides[j, 1]])
    n *= np.sign(side_a)[:, None]
    gaps = dot(n, b.tails[pair, j] - a.tails[pair, i])
    crossing = steep & (side_a * side_b > 0)
    return pair[crossing], n[crossing], gaps[crossing]


def _nearest(
    a: Polytope, b: Polytope, R: Array, t: Array, way: Array, n: Array, size: Array
) -> tuple[Array, Array, Array]:
    """Closest points of cores without overlap, and their distance from rays (P, 3) [m].

    The largest gap of each pair is along n, (P, 3) [-].

    They are a corner and a face, or an edge and an edge. Near a rim both are as near as each other
    in float64, and that which the way leads to is right.
    """
    every = np.arange(len(t))
    moved = b.in_frame(R, t)
    fine = are_fine(a, b)
    gives = giving_way(a, moved) if fine else np.inf
    i, phi_b, normal_a = _nearest_corner(a, moved.vertices, n, gives)
    corners_in_b = product(a.vertices - t[:, None], R)
    j, phi_a, normal_b = _nearest_corner(b, corners_in_b, rotated(R.mT, -n), gives)
    tip_b = moved.vertices[every, i]
    tip_a = a.vertices[every, j]
    foot_a = tip_b - phi_b[:, None] * normal_a
    foot_b = tip_a - phi_a[:, None] * rotated(R, normal_b)
    bound = np.maximum(np.minimum(phi_a, phi_b), 0.0)
    some_a = a
    if fine:
        ways = np.concatenate([n, normal_a, -rotated(R, normal_b)])
        edges_a, edges_b = edges_within(a, moved, ways, float(bound[0]) + gives)
        some_a = a.part(edges_a)
        moved = moved.part(edges_b)
    pair, distance, on_a, on_b = _edge_distances(some_a, moved, bound)
    corners = np.stack([phi_b, phi_a], axis=1)
    distance = np.concatenate([corners, padded(distance, pair, len(t), np.inf)], axis=1)
    tips = padded(on_a, pair, len(t), 0.0)
    on_a = np.concatenate([np.stack([foot_a, tip_a], axis=1), tips], axis=1)
    tips = padded(on_b, pair, len(t), 0.0)
    on_b = np.concatenate([np.stack([tip_b, foot_b], axis=1), tips], axis=1)
    miss = norm(on_b - on_a - way[:, None])
    best = distance.argmin(axis=1)
    limit = (OUTSIDE_FACE * size)[:, None]
    as_near = (distance <= distance[every, best][:, None] + limit) & (miss <= limit)
    other = as_near.any(axis=1) & ~as_near[every, best]
    best = np.where(other, as_near.argmax(axis=1), best)
    return on_a[every, best], on_b[every, best], miss[every, best]


def _nearest_corner(
    body: Polytope, corners: Array, n: Array, gives: float
) -> tuple[Indices, Array, Array]:
    """The nearest of corners (P, N, 3) [m]: its number, signed distance and normal, of P bodies.

    All is in the frames of the bodies, out of which n points, (P, 3) [-]; bounds of distances of a
    fine mesh give way by `gives` [m].
    """
    every = np.arange(len(corners))
    number = np.arange(corners.shape[1])
    if gives < np.inf and isinstance(body.shape, ConvexMesh):
        bound = corners[0] @ n[0] - (body.vertices[0] @ n[0]).max() - gives
        number = cannot_be_excluded(body.shape, bound, corners[0, bound.argmin()][None], 1)
    phi, normal = body.core_distance(corners[:, number])
    first = phi.argmin(axis=1)
    return number[first], phi[every, first], normal[every, first]


def _edge_distances(a: Polytope, b: Polytope, bound: Array) -> tuple[Indices, Array, Array, Array]:
    """Distances (N,) and closest points (N, 3) of edges within bounds (P,), after their pairs."""
    middle_a = a.tails + a.ways / 2
    middle_b = b.tails + b.ways / 2
    reach_a = norm(a.ways) / 2
    reach_b = norm(b.ways) / 2
    # Only edges whose surrounding balls come within the bound.
    ways = zip(middle_a.transpose(2, 0, 1), middle_b.transpose(2, 0, 1), strict=True)
    apart2 = total((x_a[:, :, None] - x_b[:, None]) ** 2 for x_a, x_b in ways)
    reach = reach_a[:, :, None] + reach_b[:, None] + bound[:, None, None]
    pair, i, j = np.nonzero(apart2 <= reach**2)
    tail_a = a.tails[pair, i]
    tail_b = b.tails[pair, j]
    way_a = a.ways[pair, i]
    way_b = b.ways[pair, j]
    s, r = nearest_on_segments(tail_a, way_a, tail_b, way_b)
    on_a = tail_a + s[:, None] * way_a
    on_b = tail_b + r[:, None] * way_b
    return pair, norm(on_b - on_a), on_a, on_b


def nearest_on_segments(p: Array, u: Array, q: Array, v: Array) -> tuple[Array, Array]:
    """Parameters in [0, 1] of the closest points of segments p + s u and q + r v, shapes (N,).

    p, u, q and v have the shape (N, 3) [m].

    Between parallel segments every pair of facing points is as near as any; one is taken.
    (C. Ericson, "Real-Time Collision Detection", 5.1.9.)
    """
    w = p - q
    uu = dot(u, u)
    vv = dot(v, v)
    uv = dot(u, v)
    uw = dot(u, w)
    vw = dot(v, w)
    cross = crossed(u, v)
    det = dot(cross, cross)
    parallel = det <= (ON_SURFACE**2) * uu * vv
    # Of uv vw - vv uw, the same number, nearly parallel segments leave half of the digits.
    ahead = dot(crossed(v, w), cross)
    s = np.where(parallel, 0.0, ahead / np.where(parallel, 1.0, det))
    s = np.clip(s, 0.0, 1.0)
    r = np.clip((uv * s + vw) / vv, 0.0, 1.0)
    s = np.clip((uv * r - uw) / uu, 0.0, 1.0)
    return s, r
