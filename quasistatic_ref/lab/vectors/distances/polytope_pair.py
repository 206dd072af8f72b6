"""Closest points of two polytopes with margins, apart and in penetration: all in rationals.

Apart, the shortest vector between them is the point of least norm of their difference, found by
P. Wolfe's method ("Finding the nearest point in a polytope", 1976), which ends in rational
arithmetic. Otherwise the signed distance is the widest gap s(n) over the faces of the difference:
normals of faces of either, and common normals of an edge of each. What the two faces along it have
in common, points, segments and polygons of one plane, are its witnesses.
"""

from collections.abc import Iterator, Sequence

import numpy as np
from flint import fmpq, fmpq_mat

from quasistatic_ref.lab.vectors.distances.shapes import Core
from quasistatic_ref.lab.vectors.distances.witness import Witness
from quasistatic_ref.lab.vectors.exact.precision import IDENTITY, Real, Vector, length, sign

Edge = tuple[Vector, Vector]


def polytope_pair(a: Core, b: Core) -> Witness:
    """Closest points of two polytopes with margins."""
    between = shortest_difference(a.vertices, b.vertices)
    if any(between):
        normal = between
        unique = True
    else:
        normal, unique = widest_gap(a, b)
        between = gap(a, b, normal) / (normal @ normal) * normal
    n = normal / length(normal)
    # Both faces lie in one plane after b's is moved by -between; what they share are witnesses.
    face_a = _extreme(a.vertices, normal)
    face_b = [x - between for x in _extreme(b.vertices, -normal)]
    shared = _common_points(face_a, face_b, normal)
    phi = gap(a, b, normal) / length(normal)
    alpha = shared[0]
    beta = shared[0] + between
    return Witness(phi, alpha, beta, n, unique and len(shared) == 1).inflated(a.margin, b.margin)


def gap(a: Core, b: Core, normal: Vector) -> Real:
    """Gap between the cores along a normal, times the normal's length."""
    return min(normal @ x for x in b.vertices) - max(normal @ x for x in a.vertices)


def widest_gap(a: Core, b: Core) -> tuple[Vector, bool]:
    """Normal, of any length, of the widest gap of two cores that meet; and whether it is unique."""
    normals = [*a.normals, *(-x for x in b.normals)]
    crossing = [np.cross(one, other) for one in a.edges for other in b.edges]
    ways = [x for x in crossing if any(x)]
    solid = bool(normals)
    if not solid:
        # A difference without volume: the normal of its plane, or one at right angles to its line.
        edges = [*a.edges, *b.edges]
        ways += [x for edge in edges for e in IDENTITY if any(x := np.cross(edge, e))]
        ways += [*IDENTITY]
    normals += [x for way in ways for x in (way, -way)]
    best: Vector = normals[0]
    value = _signed_square(gap(a, b, best), best)
    ties = [best]
    for normal in normals[1:]:
        other = _signed_square(gap(a, b, normal), normal)
        if other > value:
            best = normal
            value = other
            ties = [normal]
        elif other == value:
            ties.append(normal)
    return best, solid and all(_parallel(best, normal) for normal in ties)


def shortest_difference(a: Sequence[Vector], b: Sequence[Vector]) -> Vector:
    """Vector of least length from the hull of some points to that of others."""
    x = b[0] - a[0]
    corral = [x]
    weights = [fmpq(1)]
    while True:
        low = min(b, key=lambda y: x @ y)
        high = max(a, key=lambda y: x @ y)
        extreme = low - high
        if x @ extreme >= x @ x:
            return x
        corral.append(extreme)
        weights.append(fmpq(0))
        while True:
            goal = _affine_weights(corral)
            if all(w > 0 for w in goal):
                weights = goal
                break
            # Towards the goal until a weight vanishes: its point leaves.
            share = min(w / (w - g) for w, g in zip(weights, goal, strict=True) if g <= 0)
            moved = [w + share * (g - w) for w, g in zip(weights, goal, strict=True)]
            kept = [k for k, w in enumerate(moved) if w > 0]
            corral = [corral[k] for k in kept]
            weights = [moved[k] for k in kept]
        x = np.array(weights) @ np.array(corral)


def _affine_weights(points: Sequence[Vector]) -> list[Real]:
    """Weights, of sum one, of the point of least norm in the affine hull of independent points."""
    n = len(points)
    A = [[p @ q for q in points] + [fmpq(1)] for p in points] + [[fmpq(1)] * n + [fmpq(0)]]
    right = [fmpq(0)] * n + [fmpq(1)]
    solution = fmpq_mat(n + 1, n + 1, [x for row in A for x in row]).solve(
        fmpq_mat(n + 1, 1, right)
    )
    return [solution[k, 0] for k in range(n)]


def _extreme(points: Sequence[Vector], direction: Vector) -> list[Vector]:
    heights = [direction @ x for x in points]
    top = max(heights)
    return [x for x, height in zip(points, heights, strict=True) if height == top]


def _signed_square(value: Real, normal: Vector) -> Real:
    """(value / |normal|)^2 with the sign of the value: ordered as value / |normal| is."""
    return sign(value) * value * value / (normal @ normal)


def _parallel(a: Vector, b: Vector) -> bool:
    return not any(np.cross(a, b)) and a @ b > 0


def _common_points(a: Sequence[Vector], b: Sequence[Vector], normal: Vector) -> list[Vector]:
    """Extreme points of the intersection of two convex hulls in a plane, each once.

    Parameters
    ----------
    a, b : sequence of vector
        Points of one plane; their hulls meet.
    normal : vector
        Of that plane.

    Returns
    -------
    list of vector
        Of a in b's hull, then of b in a's, then where edges cross; the order of what is given.
    """
    edges_a = list(_edges(a, normal))
    edges_b = list(_edges(b, normal))
    points_in_both: list[Vector] = []
    for points, others, edges in ((a, b, edges_b), (b, a, edges_a)):
        points_in_both += [x for x in points if _inside(x, others, edges, normal)]
    for one in edges_a:
        for other in edges_b:
            points_in_both += _crossing(one, other, normal)
    once = dict.fromkeys(tuple(x) for x in points_in_both)
    return [np.array(x) for x in once]


def _edges(points: Sequence[Vector], normal: Vector) -> Iterator[Edge]:
    """Pairs of points with all others on their left, or between them."""
    for k, p in enumerate(points):
        for j, q in enumerate(points):
            if j == k or all(p == q):
                continue
            inward = np.cross(normal, q - p)
            if all(inward @ (x - p) >= 0 for x in points):
                yield p, q


def _inside(x: Vector, points: Sequence[Vector], edges: Sequence[Edge], normal: Vector) -> bool:
    if len(points) == 1:
        return all(x == points[0])
    # A segment is two edges, there and back: between both lies its line alone.
    left = all(np.cross(normal, q - p) @ (x - p) >= 0 for p, q in edges)
    if not left:
        return False
    flat = all(np.cross(normal, q - p) @ (y - p) == 0 for p, q in edges for y in points)
    return not flat or any((p - x) @ (q - x) <= 0 for p, q in edges)


def _crossing(one: Edge, other: Edge, normal: Vector) -> list[Vector]:
    """Where two segments that are not parallel meet."""
    p, q = one
    r, s = other
    way = q - p
    across = s - r
    turn = normal @ np.cross(way, across)
    if turn == 0:
        return []
    apart = r - p
    at = normal @ np.cross(apart, across) / turn
    on_other = normal @ np.cross(apart, way) / turn
    return [p + at * way] if 0 <= at <= 1 and 0 <= on_other <= 1 else []
