"""What two convex sets in one plane have in common: points, segments and polygons, in rationals."""

from collections.abc import Iterator, Sequence

import numpy as np

from quasistatic_ref.lab.vectors.exact.algebra import Vector

Edge = tuple[Vector, Vector]


def common_points(a: Sequence[Vector], b: Sequence[Vector], normal: Vector) -> list[Vector]:
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
    found: list[Vector] = []
    for points, others, edges in ((a, b, edges_b), (b, a, edges_a)):
        found += [x for x in points if _inside(x, others, edges, normal)]
    for one in edges_a:
        for other in edges_b:
            found += _crossing(one, other, normal)
    once = dict.fromkeys(tuple(x) for x in found)
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
