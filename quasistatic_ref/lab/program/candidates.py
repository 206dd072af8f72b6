"""Layer 2, and the candidates of a pair of shapes: which points become contacts, in which frame."""

import numpy as np

from .distance import closest_points, corners, normals, points_on, swapped, transformed
from .rotation import AXES, unit

OVER, SKEW = 1e-9, 1e-6
"""How far off a face a point is on it, over the box's size; sine between edges that cross [-]."""

FACING = 0.9689124217106447
"""cos 0.25, the least between the normals of the pair and of a contact, or of a face that bears."""

FILLED = 1e6
"""Distance of what fills the number of contacts [m]."""

REPEATED = 1e-9
"""[m]: candidates that differ by less, and by less than SAME_NORMAL in the normal, are one."""

RANKED = 1e-9
"""Over the smaller shape's size: distances are rounded to multiples of it before they rank."""

SPANNED = 1e-6
"""Over the smaller shape's size: a closest pair may be out of the hull of others by it."""

SAME_NORMAL = 1e-6
"""Components of normals that differ by less are one [-]."""


TIED = 1e-12
"""[m]: faces of a solid that are as high over a cloud's point as the highest, but for rounding."""


def extent(shape):
    """Longest edge of the box about a shape, along its own axes; of a half-space, infinity."""
    kind = shape["kind"]
    if kind == "halfspace":
        return np.inf
    if kind == "box":
        return max(shape["size"])
    if kind == "ellipsoid":
        return 2 * max(shape["half_axes"])
    if kind in ("cloud", "convex"):
        points = shape["points" if kind == "cloud" else "vertices"]
        return np.ptp(points, axis=0).max()
    along = shape.get("length", 0.0) + 2 * shape["radius"] * (kind in ("sphere", "capsule"))
    return max(2 * shape["radius"], along)


def smaller(alpha, beta):
    """Size of the smaller shape; a single point has none."""
    return min((x for x in (extent(alpha), extent(beta)) if 0 < x < np.inf), default=0.0)


def gaps(phi, smaller_size):
    """Distances rounded for ranking: multiples of RANKED times the smaller size."""
    return np.rint(phi / (RANKED * smaller_size)) if smaller_size else phi


def is_spanned(phi, alpha, n, smaller_size):
    """Whether the closest pair, the last, is in the hull of others as near and with its normal.

    Of those, all in one plane, the hull holds it if in no direction all are beyond it. The
    direction in which they are the farthest beyond it is that of one of them, or across a line
    through two.
    """
    level = phi[:-1] <= phi[-1] + RANKED * smaller_size
    level &= np.all(np.abs(n[:-1] - n[-1]) <= SAME_NORMAL, axis=1)
    away = alpha[:-1][level] - alpha[-1]
    if not len(away):
        return False
    across = np.cross(n[-1], (away[:, None] - away).reshape(-1, 3))
    ways = np.concatenate([away, across])
    length = np.linalg.norm(ways, axis=1)
    ways /= np.where(length > 0, length, 1)[:, None]
    return bool(np.max(np.min(ways @ away.T, axis=1)) <= SPANNED * smaller_size)


def selection(case):
    """Layer 2: indices of the k nearest candidates; of two solids, of those that share a normal."""
    selections = []
    for g, phi in enumerate(case["phi"]):
        order = np.argsort(phi, kind="stable")
        if "normals" in case:
            n = np.array(case["normals"][g])
            order = order[n[order] @ n[-1] >= FACING]
        filling = range(len(phi), 2 * len(phi) - len(order))
        indices = [*order.tolist(), *filling][: case["k"]]
        selections.append(indices)
    return {"indices": selections}


def edges(shape):
    """Ends of the edges of a box, (12, 2, 3), along x first; and its faces' normals at each."""
    if shape["kind"] != "box":
        return np.zeros((0, 2, 3)), np.zeros((0, 2, 3))
    ends = np.array(corners(shape))
    ends_of_edges = []
    sides = []
    for axis in range(3):
        for i in range(8):
            if not i >> axis & 1:
                ends_of_edges.append((ends[i], ends[i | 1 << axis]))
                across = [other for other in range(3) if other != axis]
                sides.append([np.sign(ends[i][other]) * AXES[other] for other in across])
    return np.array(ends_of_edges), np.array(sides)


def touching_edges(shape, pose, x, n):
    """Which edges of a box may bear: those of faces through x towards n, and level ones there."""
    ends, sides = edges(shape)
    if not len(ends):
        return []
    size = np.array(shape["size"])
    x = (x - pose[1]) @ pose[0]
    n = n @ pose[0]
    on = sides @ x >= np.abs(sides) @ size / 2 - OVER * max(size)
    facing = on & (sides @ n >= FACING)
    along = ends[:, 1] - ends[:, 0]
    level = np.abs(along @ n) <= np.sin(0.25) * np.linalg.norm(along, axis=1)
    return np.flatnonzero(facing.any(axis=1) | on.all(axis=1) & level).tolist()


def crossings(alpha, pose_alpha, beta, pose_beta, nearest):
    """Edges of two boxes that cross along n, by numbers, with phi, alpha, beta and n there."""
    _, a, b, n = nearest
    ends_a, _ = edges(alpha)
    ends_b, _ = edges(beta)
    edge_pairs = []
    for i in touching_edges(alpha, pose_alpha, a, n):
        for j in touching_edges(beta, pose_beta, b, -n):
            tail, head = transformed(pose_alpha, ends_a[i])
            start, end = transformed(pose_beta, ends_b[j])
            u = head - tail
            v = end - start
            w = start - tail
            steep = np.cross(u, v) @ n
            if abs(steep) <= SKEW * np.linalg.norm(u) * np.linalg.norm(v):
                continue
            s = np.cross(w, v) @ n / steep
            t = np.cross(w, u) @ n / steep
            if min(s, t) >= 0 and max(s, t) <= 1:
                one = tail + s * u
                other = start + t * v
                edge_pairs.append((i, j, (other - one) @ n, one, other, n))
    return edge_pairs


def ways(solid, n):
    """Directions along which a corner may bear on a box: the face about it, then n."""
    if solid["kind"] != "box":
        return []
    i = int(np.argmax(np.abs(n)))
    face = np.sign(n[i]) * AXES[i]
    return [n, face] if face @ n >= FACING else [n]


def bearing(box, x, way):
    """Heights of points over a box along a way, and which of them bear there."""
    half = np.array(box["size"]) / 2
    near = 2 * OVER * max(half)
    gap = x @ way - np.abs(way) @ half
    foot, _ = points_on(box, x - gap[:, None] * way)
    return gap, (gap <= near) & (foot <= near)


def as_they_bear(solid, pose, n, points):
    """phi, alpha, beta and n of another solid's corners on this one, alpha; n is the pair's."""
    phi, alpha, x, normal = points
    at = (x - pose[1]) @ pose[0]
    for way in ways(solid, n @ pose[0]):
        gap, bears = bearing(solid, at, way)
        out = pose[0] @ way
        phi = np.where(bears, gap, phi)
        alpha = np.where(bears[:, None], x - gap[:, None] * out, alpha)
        normal = np.where(bears[:, None], out, normal)
    return phi, alpha, x, normal


def as_the_cloud_lies(solid, pose, points):
    """phi, alpha, beta and n between a solid and a cloud (beta's body); ties of faces are broken.

    A point of the cloud that is not outside may be as high over one face as over another. Then its
    normal is that of the face above which the whole cloud's least height is the largest.
    """
    phi, alpha, x, n = points
    vertices = np.array(solid.get("vertices", corners(solid)))
    inside = np.flatnonzero(phi <= TIED)
    if not len(vertices) or not len(inside):
        return points
    faces, _ = normals(np.zeros((1, 3)), vertices)
    heights = ((x - pose[1]) @ pose[0]) @ faces.T - (vertices @ faces.T).max(axis=0)
    least = heights.min(axis=0)
    for i in inside:
        tied = heights[i] >= heights[i].max() - TIED
        way = pose[0] @ faces[int(np.argmax(np.where(tied, least, -np.inf)))]
        if np.abs(way - n[i]).max() > SAME_NORMAL:
            alpha[i] = x[i] - phi[i] * way
            n[i] = way
    return phi, alpha, x, n


def without_repeats(shape):
    """The shape; a cloud keeps the first of points that are equal."""
    if shape["kind"] != "cloud":
        return shape
    return shape | {"points": list(dict.fromkeys(map(tuple, shape["points"])))}


def candidates(alpha, pose_alpha, beta, pose_beta, k):
    """phi, alpha, beta, n and index of all candidates, and which come after all others."""
    alpha = without_repeats(alpha)
    beta = without_repeats(beta)
    nearest = closest_points(alpha, pose_alpha, beta, pose_beta)
    if beta["kind"] == "cloud":
        nearest = as_the_cloud_lies(alpha, pose_alpha, nearest)
    elif alpha["kind"] == "cloud":
        nearest = swapped(as_the_cloud_lies(beta, pose_beta, swapped(nearest)))
    parts = [nearest]
    _, _, _, way = nearest
    clouds = "cloud" in (alpha["kind"], beta["kind"])
    if k > 1 and not clouds:
        if len(corners(beta)):
            points = {"kind": "cloud", "points": corners(beta)}
            corner_points = closest_points(alpha, pose_alpha, points, pose_beta)
            parts.insert(0, as_they_bear(alpha, pose_alpha, way, corner_points))
        if len(corners(alpha)):
            points = {"kind": "cloud", "points": corners(alpha)}
            corner_points = swapped(closest_points(points, pose_alpha, beta, pose_beta))
            parts.insert(0, swapped(as_they_bear(beta, pose_beta, -way, corner_points)))
    phi = np.concatenate([np.atleast_1d(one[0]) for one in parts])
    a, b, n = (np.concatenate([np.reshape(one[i], (-1, 3)) for one in parts]) for i in (1, 2, 3))
    late = np.zeros(len(phi), dtype=bool)
    index = np.arange(len(phi))
    if clouds or k == 1:
        return phi, a, b, n, index, late
    last = len(phi) - 1
    number = most_candidates(alpha, beta, last)
    crossed = crossings(alpha, pose_alpha, beta, pose_beta, nearest)
    if crossed:
        *edge, corner_points, on_a, on_b, normal = zip(*crossed, strict=True)
        index = np.insert(index, last, crossing_index(last, k, *map(np.array, edge)))
        phi = np.insert(phi, last, corner_points)
        a = np.insert(a, last, on_a, axis=0)
        b = np.insert(b, last, on_b, axis=0)
        n = np.insert(n, last, normal, axis=0)
    about = np.flatnonzero(n @ way >= FACING)
    if is_spanned(phi[about], a[about], n[about], smaller(alpha, beta)):
        about = about[:-1]
    late = repeats(phi[about], a[about], n[about])
    filling = np.arange(max(0, min(k, number) - len(about)))
    kept = np.append(about, 0 * filling + len(phi) - 1)
    phi = np.append(phi[about], 0.0 * filling + FILLED)
    index = np.append(index[about], last + 1 + filling)
    return phi, a[kept], b[kept], n[kept], index, np.append(late, filling >= 0)


def most_candidates(alpha, beta, last):
    """The largest number of candidates that two solids with `last` corners can have."""
    return last + 9 if alpha["kind"] == beta["kind"] == "box" else last + 1


def crossing_index(last, k, i, j):
    """The index of the crossing of alpha's edge i and beta's edge j among candidates."""
    return last + np.minimum(k, last + 9) + 2 * (12 * i + j)


def repeats(phi, alpha, n):
    """Which candidates repeat an earlier one."""
    every = np.column_stack([phi, alpha, n * (REPEATED / SAME_NORMAL)])
    same = np.all(np.abs(every[:, None] - every) <= REPEATED, axis=2)
    return np.tril(same, -1).any(axis=1)


def k_first(rank, index, late, k):
    """The k candidates of the first ranks, late ones last, in the order of their index."""
    order = np.lexsort((index, rank, late))[:k]
    return order[np.argsort(index[order])]


def tangents(n):
    """d1, d2 of a normal."""
    i = int(np.argmin(np.abs(n)))
    d1 = unit(AXES[i] - n[i] * n)
    return d1, np.cross(n, d1)
