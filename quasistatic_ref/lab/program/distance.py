"""Layer 1: signed distances of two shapes.

Sphere, point, capsule, box and convex hull are cores, points with a radius about them. Apart, the
shortest vector of two cores is Wolfe's; in penetration the best of all normals of faces and
pairs of edges. A half-space meets the farthest point. Cylinder, cone and ellipsoid have the
signed distance of a point (curved.py); other pairs of them are projected to and fro.
"""

import numpy as np

from .curved import farthest, point_on
from .rotation import AXES, frame

NEAR = 1e-3
"""Distance [m] below which the direction between two points has lost digits."""
LEAST = 1e-15
"""A weight below this is rounding: weights sum to 1, after some operations of 1e-16."""


def transformed(pose, points):
    """Points of a shape in the world."""
    return np.atleast_2d(points) @ pose[0].T + pose[1]


def corners(shape):
    """The corners of a box, the sign of x changing first; other solids have none here."""
    if shape["kind"] != "box":
        return []
    signs = 2 * ((np.arange(8)[:, None] >> np.arange(3)) & 1) - 1
    return signs * np.array(shape["size"]) / 2


def core(shape, pose):
    """(points, radius) of a shape that has a core; None if not."""
    kind = shape["kind"]
    if kind == "sphere":
        return transformed(pose, np.zeros((1, 3))), shape["radius"]
    if kind == "capsule":
        z = shape["length"] / 2
        return transformed(pose, [[0, 0, -z], [0, 0, z]]), shape["radius"]
    if kind == "box":
        return transformed(pose, corners(shape)), 0.0
    if kind == "convex":
        return transformed(pose, shape["vertices"]), 0.0
    return None


def shortest(P):
    """Weights of the convex combination of points of least length (Wolfe 1976)."""
    S = [int(np.argmin(np.einsum("ij,ij->i", P, P)))]
    w = np.ones(1)
    size = max(np.abs(P).max() ** 2, 1e-300)
    before = np.inf
    best = (S, w)
    while True:
        x = w @ P[S]
        if x @ x >= before:  # it would shrink, were it not for rounding
            break
        before = x @ x
        best = (S, w)
        j = int(np.argmin(P @ x))
        if x @ x - P[j] @ x <= 1e-16 * size or j in S:
            break
        S = [*S, j]
        w = np.append(w, 0.0)
        while True:
            v = affine(P[S])
            if np.all(v > LEAST):
                w = v
                break
            low = v <= LEAST
            t = np.min(w[low] / np.where(w[low] - v[low] > 0, w[low] - v[low], 1.0))
            w = w + t * (v - w)
            keep = w > LEAST
            keep[int(np.argmin(np.where(low, w, np.inf)))] = False
            S = [s for s, k in zip(S, keep, strict=True) if k]
            w = w[keep] / w[keep].sum()
    weights = np.zeros(len(P))
    weights[best[0]] = best[1]
    return weights


def affine(Q):
    """Weights, of sum one, of the point of least length in the affine hull of points."""
    if len(Q) == 1:
        return np.ones(1)
    rest = np.linalg.lstsq((Q[1:] - Q[0]).T, -Q[0], rcond=None)[0]
    return np.append(1 - rest.sum(), rest)


def core_pair(A, B):
    """phi, alpha, beta, n of two cores."""
    P = (B[None] - A[:, None]).reshape(-1, 3)
    size = np.abs(P).max()
    weights = shortest(P).reshape(len(A), len(B))
    alpha = weights.sum(axis=1) @ A
    beta = weights.sum(axis=0) @ B
    d = np.linalg.norm(beta - alpha)
    if d > 0.1 * size and P.shape[0] > 4:
        return d, alpha, beta, (beta - alpha) / d
    N, sine = normals(A, B)
    gap = (B @ N.T).min(axis=0) - (A @ N.T).max(axis=0)
    # Of the same face's normals, the one from the least acute pair of edges.
    best = int(np.argmax(np.where(gap >= gap.max() - 4e-15 * size, sine, -1.0)))
    if d > 1e-13 * size and gap[best] < d - 1e-14 * size:
        return d, alpha, beta, (beta - alpha) / d
    n = N[best]
    phi = gap[best]
    front = A[A @ n >= (A @ n).max() - 1e-12 * size]
    back = B[B @ n <= (B @ n).min() + 1e-12 * size]
    Q = (back[None] - front[:, None]).reshape(-1, 3) - phi * n
    weights = shortest(Q).reshape(len(front), len(back))
    alpha = weights.sum(axis=1) @ front
    return phi, alpha, alpha + phi * n, n


def normals(A, B):
    """Unit normals of all triangles and pairs of edges, both ways, and the sines between them."""
    edges = []
    for P in (A, B):
        i, j = np.triu_indices(len(P), 1)
        edges.append(P[j] - P[i])
    a, b = edges
    pairs = [(np.repeat(a, len(b), axis=0), np.tile(b, (len(a), 1)))]
    for e in edges:
        i, j = np.triu_indices(len(e), 1)
        pairs.append((e[i], e[j]))
    if len(a) + len(b) == 1:  # a point on a segment: any direction across
        pairs.append((np.tile([*a, *b], (3, 1)), AXES))
    first, second = (np.concatenate(side) for side in zip(*pairs, strict=True))
    N = np.cross(first, second)
    length = np.linalg.norm(N, axis=1)
    sine = length / np.maximum(
        np.linalg.norm(first, axis=1) * np.linalg.norm(second, axis=1), 1e-300
    )
    real = sine > 1e-9
    if not real.any():
        return AXES, np.ones(3)
    N = N[real] / length[real, None]
    sine = sine[real]
    return np.concatenate([N, -N]), np.concatenate([sine, sine])


def on_halfspace(half, pose_h, shape, pose):
    """phi, alpha on the half-space, beta, n."""
    normal = np.array(half["normal"])
    length = np.linalg.norm(normal)
    n = pose_h[0] @ normal / length
    offset = half["offset"] / length
    polytope = core(shape, pose)
    if polytope is None:
        beta = transformed(pose, farthest(shape, -pose[0].T @ n))[0]
    else:
        points, radius = polytope
        beta = points[int(np.argmin(points @ n))] - radius * n
    phi = n @ (beta - pose_h[1]) - offset
    return phi, beta - phi * n, beta, n


def swapped(points):
    """The closest points with alpha and beta exchanged."""
    phi, a, b, n = points
    return phi, b, a, -n


def points_on(shape, P):
    """Signed distances and outward normals of many points in the frame of a shape."""
    kind = shape["kind"]
    if kind == "halfspace":
        length = np.linalg.norm(shape["normal"])
        n = np.array(shape["normal"]) / length
        offset = shape["offset"] / length
        return P @ n - offset, np.tile(n, (len(P), 1))
    if kind in ("sphere", "capsule"):
        half = shape.get("length", 0.0) / 2
        away = P - np.clip(P[:, 2:], -half, half) * AXES[2]
        d = np.linalg.norm(away, axis=1)
        n = np.where(d[:, None] > 0, away / np.where(d > 0, d, 1)[:, None], AXES[0])
        return d - shape["radius"], n
    if kind == "box":
        sign = np.where(P < 0, -1.0, 1.0)
        excess = np.abs(P) - np.array(shape["size"]) / 2
        beyond = np.maximum(excess, 0.0)
        d = np.linalg.norm(beyond, axis=1)
        face = AXES[excess.argmax(axis=1)]
        n = np.where(d[:, None] > 0, beyond / np.where(d > 0, d, 1)[:, None], face)
        return np.where(d > 0, d, excess.max(axis=1)), sign * n
    if kind == "convex":
        each = []
        for p in P:
            phi, _, _, n = core_pair(np.array([p]), np.array(shape["vertices"]))
            each.append((phi, -n))
    else:
        each = [point_on(shape, p) for p in P]
    return np.array([phi for phi, _ in each]), np.array([n for _, n in each])


def cloud_on(cloud, pose_c, shape, pose):
    """Lists over a cloud's points as alpha."""
    x = transformed(pose_c, cloud["points"])
    phi, n = points_on(shape, (x - pose[1]) @ pose[0])
    n = -(n @ pose[0].T)
    return phi, x, x + phi[:, None] * n, n


def closest_points(alpha, pose_alpha, beta, pose_beta):
    """phi, alpha, beta, n of two shapes; lists of them where one is a cloud.

    n points from alpha's body to beta's, also in penetration, where phi is negative.
    """
    kinds = alpha["kind"], beta["kind"]
    if kinds[0] == "cloud":
        return cloud_on(alpha, pose_alpha, beta, pose_beta)
    if kinds[1] == "cloud":
        return swapped(cloud_on(beta, pose_beta, alpha, pose_alpha))
    if kinds[0] == "halfspace":
        return on_halfspace(alpha, pose_alpha, beta, pose_beta)
    if kinds[1] == "halfspace":
        return swapped(on_halfspace(beta, pose_beta, alpha, pose_alpha))
    if core(alpha, pose_alpha) is None:
        if core(beta, pose_beta) is None:
            return by_projections(alpha, pose_alpha, beta, pose_beta)
        return swapped(closest_points(beta, pose_beta, alpha, pose_alpha))
    # In the frame of beta, whose corners are then not rounded.
    R, t = pose_beta
    a, r = core(alpha, (R.T @ pose_alpha[0], R.T @ (pose_alpha[1] - t)))
    b = core(beta, (np.eye(3), np.zeros(3)))
    if b is not None:
        phi, x, y, n = core_pair(a, b[0])
        phi = phi - b[1]
        y = y - b[1] * n
    elif len(a) == 1:
        phi, n = point_on(beta, a[0])
        x = a[0]
        y = a[0] - phi * n
        n = -n
    else:
        return by_projections(alpha, pose_alpha, beta, pose_beta)
    return phi - r, R @ (x + r * n) + t, R @ y + t, R @ n


def projected(shape, pose, x):
    """The point of a solid shape nearest to x, radius left aside."""
    polytope = core(shape, pose)
    if polytope is not None:
        return shortest(polytope[0] - x) @ polytope[0]
    phi, n = point_on(shape, pose[0].T @ (x - pose[1]))
    return x - phi * (pose[0] @ n) if phi > 0 else x


def by_projections(alpha, pose_alpha, beta, pose_beta):
    """Curved shapes apart: project to and fro (Cheney & Goldstein 1959), with Newton's method."""

    def image(x):
        return projected(alpha, pose_alpha, projected(beta, pose_beta, x))

    x = image(pose_beta[1])
    for _ in range(40):
        for _ in range(5):
            x = image(x)
        rest = image(x) - x
        step = min(1e-5, np.linalg.norm(projected(beta, pose_beta, x) - x) / 4)
        if np.abs(rest).max() < 1e-17 or step == 0:
            break
        slope = np.array([(image(x + step * e) - image(x - step * e)) / (2 * step) for e in AXES])
        new = image(x + np.linalg.lstsq(AXES - slope.T, rest, rcond=1e-9)[0])
        if np.abs(image(new) - new).max() < np.abs(rest).max():
            x = new
        elif np.abs(rest).max() < 1e-15:
            break
    y = projected(beta, pose_beta, x)
    d = np.linalg.norm(y - x)
    n = (y - x) / d if d > 0 else AXES[0]  # curved shapes that overlap: the vectors have none
    radii = [shape["radius"] if shape["kind"] == "capsule" else 0.0 for shape in (alpha, beta)]
    if 0 < d < NEAR:
        x, y, n = from_afar(alpha, pose_alpha, beta, pose_beta, n)
    return n @ (y - x) - sum(radii), x + radii[0] * n, y - radii[1] * n, n


def from_afar(alpha, pose_alpha, beta, pose_beta, n):
    """Closest points of shapes that nearly touch, found after moving them apart along n."""

    def normal(n):
        _, x, y, n_afar = by_projections(
            alpha, pose_alpha, beta, (pose_beta[0], pose_beta[1] + n / 8)
        )
        return n_afar, x, y

    slope = np.array([(normal(n + 1e-6 * e)[0] - normal(n - 1e-6 * e)[0]) / 2e-6 for e in AXES])
    for _ in range(6):
        n_afar, x, y = normal(n)
        rest = n_afar - n
        if np.abs(rest).max() < 4e-16:
            break
        n = n + np.linalg.lstsq(AXES - slope.T, rest, rcond=1e-9)[0]
        n = n / np.linalg.norm(n)
    radii = [shape["radius"] if shape["kind"] == "capsule" else 0.0 for shape in (alpha, beta)]
    return x - radii[0] * n, y + radii[1] * n - n / 8, n


def distance(case):
    """Layer 1: phi, alpha, beta and n of a case, two shapes in their poses."""
    pose_alpha = frame(case["pose_alpha"])
    pose_beta = frame(case["pose_beta"])
    phi, alpha, beta, n = closest_points(case["alpha"], pose_alpha, case["beta"], pose_beta)
    return {"phi": phi, "alpha": alpha, "beta": beta, "n": n}
