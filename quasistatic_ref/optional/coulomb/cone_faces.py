"""The faces of a friction cone, as far as the coordinates of a step tell them apart."""

from collections.abc import Sequence
from itertools import combinations
from typing import TypeAlias

from flint import fmpz, fmpz_mat

Rows: TypeAlias = "tuple[int, ...]"
Point: TypeAlias = "list[fmpz]"


def faces(points: Sequence[Point]) -> list[Rows]:
    """The faces of the convex hull of points, each by all points in it; the last is the hull.

    A face consists of the points at which some linear function is least. Points may coincide, and
    may span fewer dimensions than they have.

    Parameters
    ----------
    points : sequence of list of fmpz, each of length n
        In any unit [-]; they span three dimensions at most.

    Returns
    -------
    list of tuple of int
        By size; the points of each in increasing order.
    """
    count = len(points)
    away = [_difference(point, points[0]) for point in points]
    echelon, _, dimension = fmpz_mat(away).rref()
    pivots = [next(v for v, a in enumerate(row) if a) for row in echelon.tolist()[:dimension]]
    # These coordinates alone determine a point of the hull.
    placed = [[point[v] for v in pivots] for point in away]
    facets = set()
    for corners in combinations(placed, dimension) if dimension else ():
        normal = _normal([_difference(corner, corners[0]) for corner in corners[1:]])
        heights = [_inner(normal, point) for point in placed]
        level = _inner(normal, corners[0])
        if any(normal) and level in (min(heights), max(heights)):
            facets.add(frozenset(i for i in range(count) if heights[i] == level))
    found = {frozenset(range(count))}
    new = facets
    while new:
        found |= new
        new = {a & b for a in new for b in facets} - found - {frozenset()}
    listed = [tuple(sorted(face)) for face in found]
    return sorted(listed, key=lambda face: (len(face), face))


def _normal(edges: Sequence[Point]) -> Point:
    """What is orthogonal to no, one or two edges in as many dimensions and one more."""
    if not edges:
        return [fmpz(1)]
    if len(edges) == 1:
        x, y = edges[0]
        return [-y, x]
    (a, b, c), (u, v, w) = edges
    return [b * w - c * v, c * u - a * w, a * v - b * u]


def _inner(a: Point, b: Point) -> fmpz:
    return sum((x * y for x, y in zip(a, b, strict=True)), fmpz(0))


def _difference(a: Point, b: Point) -> Point:
    return [x - y for x, y in zip(a, b, strict=True)]
