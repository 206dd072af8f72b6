"""Points of a scan: strays left out, and thinned."""

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import ConvexHull, cKDTree

from quasistatic_ref.numbers.arrays import Array, Indices, Mask

LINKED = 6.0
"""Points of one surface are linked by gaps of at most so many median distances to the nearest."""
LINKS = 8
"""Nearest points that a point may be linked with: a few stray points close together stay stray."""
SURFACE = 10
"""So many linked points are a part of the surface."""
AWAY = 0.05
"""A stray point is so far from the surface, over its extent [-]: islands within the unseen parts of
a scan are nearer."""
COVERING = 20_000
"""Points among which those are looked for that cover a surface evenly."""


def spacing(points: Array) -> float:
    """Median distance of a point to the nearest other, of points of shape (N, 3) [m]."""
    distances, _ = cKDTree(points).query(points, k=2)
    return float(np.median(distances[:, 1]))


def stray(points: Array) -> Mask:
    """Mask of the points, shape (N,), that are far from the surface of all others."""
    n = len(points)
    tree = cKDTree(points)
    for count in (LINKS // 2, LINKS):  # half of them join most surfaces, in less time
        away, near = tree.query(points, k=min(count, n))
        of, place = np.nonzero(away < LINKED * np.median(away[:, 1]))
        links = coo_array((np.ones(len(of)), (of, near[of, place])), shape=(n, n))
        _, group = connected_components(links, directed=False)
        few = np.bincount(group)[group] < SURFACE
        if not few.any():
            break
    if not few.any() or few.all():
        return np.zeros(n, dtype=bool)
    surface = points[~few]
    away, _ = cKDTree(surface).query(points[few])
    apart = few.copy()
    apart[few] = away > AWAY * np.ptp(surface, axis=0).max()
    return np.asarray(apart)


def thinned(points: Array, count: int) -> Indices:
    """Numbers of `count` of the points, shape (N, 3) [m]: corners of the hull, then the farthest.

    Corners of the convex hull are what the body can lie on, and stand first: of equally low points
    the first ones become contacts. Each further point is, of all, the farthest from those before
    it, so that the whole surface is covered evenly; of very many points, it is so of those whose
    numbers are equally far apart.
    """
    corners = ConvexHull(points).vertices
    if len(points) <= count:
        return np.concatenate([np.sort(corners), np.setdiff1d(np.arange(len(points)), corners)])
    corners = corners[:: -(-len(corners) // COVERING)]
    chosen = _farthest(points[corners], [], min(count // 2, len(corners)))
    some = np.arange(0, len(points), -(-len(points) // COVERING))
    some = np.concatenate([corners[chosen], np.setdiff1d(some, corners[chosen])])
    return np.asarray(some[_farthest(points[some], list(range(len(chosen))), count)])


def _farthest(points: Array, chosen: list[int], count: int) -> Indices:
    """Numbers of points: the chosen ones, then again and again the farthest from all before."""
    chosen = list(chosen or [0])
    distance, _ = cKDTree(points[chosen]).query(points)
    while len(chosen) < count:
        chosen.append(int(distance.argmax()))
        distance = np.minimum(distance, np.linalg.norm(points - points[chosen[-1]], axis=1))
    return np.array(chosen)
