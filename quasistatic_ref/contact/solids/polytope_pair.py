"""Closest points of two convex polytopes: a closed form, apart and in penetration.

Let s(n) be the gap between the two along a unit vector n. The signed distance is the largest
s(n): apart, that is the distance; in penetration, minus the least translation that parts them.
It is attained at a face of the Minkowski difference, that is at a normal of a face of either,
or at the common normal of an edge of each whose arcs on the Gauss sphere cross; apart, also
between two corners, or a corner and an edge.
"""

import numpy as np

from quasistatic_ref.contact.shape_in_world import Witness
from quasistatic_ref.contact.solids.polytope import Polytope
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.numbers.ordered import dot, norm, product
from quasistatic_ref.shapes.placed_shape import Capsule
from quasistatic_ref.tolerances import ON_SURFACE, OUTSIDE_FACE


def polytope_pair(
    a: Polytope, b: Polytope, R: Array, t: Array, gaps: tuple[Array, Array]
) -> Witness:
    """Signed distance, closest points and normal of two polytopes, in the frame of `a`.

    Parameters
    ----------
    a, b : Polytope
        Each in its own frame.
    R, t : ndarray, shapes (3, 3) and (3,)
        Pose of b's frame in a's.
    gaps : (ndarray, ndarray)
        Of :func:`gaps_between` them [m], [-].
    """
    if isinstance(a.shape, Capsule) and isinstance(b.shape, Capsule):
        return _capsule_pair(a, b.moved(R, t))
    best = int(gaps[0].argmax())
    gap = float(gaps[0][best])
    n = gaps[1][best]
    size = float(max(np.abs(a.vertices).max(), np.abs(b.vertices).max(), np.abs(t).max()))
    if gap > 0:
        on_a, on_b, miss = _nearest(a, b, R, t, gap * n, size)
        between = on_b - on_a
        distance = float(norm(between))
        if miss > OUTSIDE_FACE * size and distance > ON_SURFACE * size:
            gap = distance
            n = between / distance
    else:
        # Parted along n, they touch: where they do is where they are deepest now.
        on_a, _, _ = _nearest(a, b, R, t - gap * n, 0 * n, size)
    return _with_margins(a, b, gap, on_a, n)


def _with_margins(a: Polytope, b: Polytope, gap: float, on_a: Array, n: Array) -> Witness:
    on_b = on_a + gap * n
    return Witness(gap - a.margin - b.margin, on_a + a.margin * n, on_b - b.margin * n, n)


def _capsule_pair(a: Polytope, b: Polytope) -> Witness:
    """Two segments have no volume: the distance is never negative, but may be without direction."""
    tail_a = a.tails[:1]
    tail_b = b.tails[:1]
    way_a = a.ways[:1]
    way_b = b.ways[:1]
    s, r = nearest_on_segments(tail_a, way_a, tail_b, way_b)
    on_a = tail_a + s * way_a
    on_b = tail_b + r * way_b
    apart = (on_b - on_a)[0]
    gap = float(norm(apart))
    size = float(np.abs([a.vertices, b.vertices]).max())
    across = np.cross(way_a, way_b)[0]
    steepness = float(np.sqrt(dot(across, across) / (dot(way_a, way_a) * dot(way_b, way_b))[0]))
    inside = 0 < s[0] < 1 and 0 < r[0] < 1
    n = apart
    if gap <= ON_SURFACE * size:  # axes that cross, or lie in each other
        n = across if norm(across) > ON_SURFACE * size**2 else a.normals[0]
    elif inside and steepness * size > gap:  # the difference of near points has few digits
        n = across
    if n is not apart:
        n = n * (1.0 if dot(n, apart) >= 0 else -1.0)
        gap = float(dot(n, apart) / norm(n))
    return _with_margins(a, b, gap, on_a[0], n / norm(n))


def gaps_between(a: Polytope, b: Polytope) -> tuple[Array, Array]:
    """Gaps along the normals of all faces of the Minkowski difference.

    Parameters
    ----------
    a, b : Polytope
        In one frame.

    Returns
    -------
    gaps : ndarray, shape (N,)
        [m].
    normals : ndarray, shape (N, 3)
        From a to b [-].
    """
    along_a = product(a.normals, b.vertices.T).min(axis=1) - a.offsets
    along_b = product(b.normals, a.vertices.T).min(axis=1) - b.offsets
    crossing, gaps = _crossing_edges(a, b)
    normals = np.concatenate([a.normals, -b.normals, crossing])
    return np.concatenate([along_a, along_b, gaps]), normals


def _crossing_edges(a: Polytope, b: Polytope) -> tuple[Array, Array]:
    """Common normals, from a to b, of the edges whose arcs cross; and the gaps along them.

    The arc of an edge joins the normals of its two faces; those of b count negated. (D. Gregorius,
    "The separating axis test between convex polyhedra".)
    """
    b_on_a = product(-a.ways, b.normals.T)
    a_on_b = product(b.ways, a.normals.T)
    c = b_on_a[:, b.sides[:, 0]]
    d = b_on_a[:, b.sides[:, 1]]
    e = a_on_b[:, a.sides[:, 0]].T
    f = a_on_b[:, a.sides[:, 1]].T
    # Each arc has its ends on different sides of the plane of the other ...
    i, j = np.nonzero((c * d < 0) & (e * f < 0))
    if not len(i):
        return np.zeros((0, 3)), np.zeros(0)
    way_a = a.ways[i]
    way_b = b.ways[j]
    n = np.cross(way_a, way_b)
    length = norm(n)
    scale = np.sqrt(dot(way_a, way_a) * dot(way_b, way_b))
    keep = length > ON_SURFACE * scale
    i = i[keep]
    j = j[keep]
    n = n[keep] / length[keep, None]
    # ... and they are on the same hemisphere: n is on the side of a's normals and of -b's.
    middle_a = a.normals[a.sides[i, 0]] + a.normals[a.sides[i, 1]]
    middle_b = -(b.normals[b.sides[j, 0]] + b.normals[b.sides[j, 1]])
    side_a = dot(n, middle_a)
    side_b = dot(n, middle_b)
    same = side_a * side_b > 0
    i = i[same]
    j = j[same]
    n = n[same] * np.sign(side_a[same])[:, None]
    apart = b.tails[j] - a.tails[i]
    return n, dot(n, apart)


def _nearest(
    a: Polytope, b: Polytope, R: Array, t: Array, way: Array, size: float
) -> tuple[Array, Array, float]:
    """Closest points of two cores that are apart or touch, and how far they miss a way [m].

    They are a corner and a face, or an edge and an edge. Near a rim both are as near as each other
    in float64, and that which the way leads to is right.
    """
    moved = b.moved(R, t)
    phi_b, normal = a.core_distance(moved.vertices)
    i = int(phi_b.argmin())
    tip_b = moved.vertices[i]
    foot_a = moved.vertices[i] - phi_b[i] * normal[i]
    phi_a, normal = b.core_distance(product(a.vertices - t, R))
    j = int(phi_a.argmin())
    tip_a = a.vertices[j]
    foot_b = a.vertices[j] - phi_a[j] * product(R, normal[j])
    least = float(min(phi_a[j], phi_b[i]))
    distance, on_a, on_b = _edge_distances(a, moved, max(least, 0.0))
    distance = np.concatenate([[phi_b[i], phi_a[j]], distance])
    on_a = np.concatenate([[foot_a, tip_a], on_a])
    on_b = np.concatenate([[tip_b, foot_b], on_b])
    miss = norm(on_b - on_a - way)
    best = int(distance.argmin())
    as_near = (distance <= distance[best] + OUTSIDE_FACE * size) & (miss <= OUTSIDE_FACE * size)
    if not as_near[best] and as_near.any():
        best = int(as_near.argmax())
    return on_a[best], on_b[best], float(miss[best])


def _edge_distances(a: Polytope, b: Polytope, bound: float) -> tuple[Array, Array, Array]:
    """Distances (N,) and closest points (N, 3) of pairs of edges, of those within a bound."""
    middle_a = a.tails + a.ways / 2
    middle_b = b.tails + b.ways / 2
    reach_a = norm(a.ways) / 2
    reach_b = norm(b.ways) / 2
    # Only edges whose surrounding balls come within the bound.
    apart = middle_a[:, None] - middle_b
    apart2 = dot(apart, apart)
    i, j = np.nonzero(apart2 <= (reach_a[:, None] + reach_b + bound) ** 2)
    s, r = nearest_on_segments(a.tails[i], a.ways[i], b.tails[j], b.ways[j])
    on_a = a.tails[i] + s[:, None] * a.ways[i]
    on_b = b.tails[j] + r[:, None] * b.ways[j]
    return norm(on_b - on_a), on_a, on_b


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
    cross = np.cross(u, v)
    det = dot(cross, cross)
    parallel = det <= (ON_SURFACE**2) * uu * vv
    # Of uv vw - vv uw, the same number, nearly parallel segments leave half of the digits.
    ahead = dot(np.cross(v, w), cross)
    s = np.where(parallel, 0.0, ahead / np.where(parallel, 1.0, det))
    s = np.clip(s, 0.0, 1.0)
    r = np.clip((uv * s + vw) / vv, 0.0, 1.0)
    s = np.clip((uv * r - uw) / uu, 0.0, 1.0)
    return s, r
