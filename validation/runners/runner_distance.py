"""Signed distances of two shapes in plain NumPy.

Sphere, point, capsule, box and convex hull are cores, points with a radius about them. Apart, the
shortest vector of two cores is Wolfe's; in penetration the best of all normals of faces and
pairs of edges. A half-space meets the farthest point of a shape. Cylinder, cone and ellipsoid have
the signed distance of a point, that of a sphere, and by it that of anything found by descent.
"""

import numpy as np

AXES = np.eye(3)


def transformed(pose, points):
    """Points of a shape in the world."""
    return np.atleast_2d(points) @ pose[0].T + pose[1]


def core(shape, pose):
    """(points, radius) of a shape that has a core; None if not."""
    kind = shape["kind"]
    if kind == "sphere":
        return transformed(pose, np.zeros((1, 3))), shape["radius"]
    if kind == "capsule":
        z = shape["length"] / 2
        return transformed(pose, [[0, 0, -z], [0, 0, z]]), shape["radius"]
    if kind == "box":
        signs = 2 * ((np.arange(8)[:, None] >> np.arange(3)) & 1) - 1
        return transformed(pose, signs * np.array(shape["size"]) / 2), 0.0
    if kind == "convex":
        return transformed(pose, shape["vertices"]), 0.0
    return None


def shortest(P):
    """Weights of the convex combination of points of least length (Wolfe 1976)."""
    S = [int(np.argmin(np.einsum("ij,ij->i", P, P)))]
    w = np.ones(1)
    for _ in range(1000):
        x = w @ P[S]
        j = int(np.argmin(P @ x))
        size = max(np.abs(P).max() ** 2, 1e-300)
        if x @ x - P[j] @ x <= 1e-16 * size or j in S:
            break
        S, w = [*S, j], np.append(w, 0.0)
        while True:
            v = affine(P[S])
            if np.all(v > 0):
                w = v
                break
            low = v <= 0
            t = np.min(w[low] / np.where(w[low] - v[low] > 0, w[low] - v[low], 1.0))
            w = w + t * (v - w)
            keep = w > 1e-15
            keep[int(np.argmin(np.where(low, w, np.inf)))] = False
            S, w = [s for s, k in zip(S, keep, strict=True) if k], w[keep] / w[keep].sum()
    weights = np.zeros(len(P))
    weights[S] = w
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
    alpha, beta = weights.sum(axis=1) @ A, weights.sum(axis=0) @ B
    d = np.linalg.norm(beta - alpha)
    if d > 1e-3 * size:
        return d, alpha, beta, (beta - alpha) / d
    N = normals(A, B)
    gap = (B @ N.T).min(axis=0) - (A @ N.T).max(axis=0)
    best = int(np.argmax(gap))
    if d > 1e-13 * size and gap[best] < d - 1e-14 * size:
        return d, alpha, beta, (beta - alpha) / d
    n, phi = N[best], gap[best]
    front = A[A @ n > (A @ n).max() - 1e-12 * size]
    back = B[B @ n < (B @ n).min() + 1e-12 * size]
    Q = (back[None] - front[:, None]).reshape(-1, 3) - phi * n
    weights = shortest(Q).reshape(len(front), len(back))
    alpha = weights.sum(axis=1) @ front
    return phi, alpha, alpha + phi * n, n


def normals(A, B):
    """Unit normals of all triangles, and of all pairs of edges, in both directions."""

    def edges(P):
        i, j = np.triu_indices(len(P), 1)
        return P[j] - P[i]

    a, b = edges(A), edges(B)
    found = [np.cross(a[:, None], b).reshape(-1, 3)]
    for e in (a, b):
        i, j = np.triu_indices(len(e), 1)
        found.append(np.cross(e[i], e[j]))
    if len(a) + len(b) == 1:  # a point on a segment: any direction across
        found.append(np.cross([*a, *b], AXES))
    N = np.concatenate(found)
    length = np.linalg.norm(N, axis=1)
    N = (
        N[length > 1e-9 * length.max(initial=0)]
        / length[length > 1e-9 * length.max(initial=0), None]
    )
    return np.concatenate([N, -N]) if len(N) else AXES


def point_on(shape, p):
    """Signed distance and outward normal of a point in the frame of a curved shape."""
    kind = shape["kind"]
    if kind == "ellipsoid":
        return point_on_ellipsoid(np.array(shape["half_axes"]), p)
    r, z = np.hypot(p[0], p[1]), p[2]
    outward = np.array([p[0] / r, p[1] / r, 0]) if r > 0 else AXES[0]
    R, half = shape["radius"], shape["length"] / 2
    if kind == "cylinder":
        excess, up = np.array([r - R, abs(z) - half]), -1.0 if z < 0 else 1.0
        if excess.max() > 0:
            beyond = np.maximum(excess, 0)
            phi = np.hypot(*beyond)
            n = beyond / phi
        else:
            phi, n = excess.max(), AXES[int(excess[1] > excess[0]), :2]
        return phi, n[0] * outward + n[1] * up * AXES[2]
    slant = np.array([2 * half, R]) / np.hypot(2 * half, R)  # normal of the side, in (r, z)
    side = slant @ [r, z - half]
    inside = max(side, -half - z)
    if inside <= 0:
        n = slant if side >= -half - z else np.array([0, -1.0])
        return inside, n[0] * outward + n[1] * AXES[2]
    at, rim = np.array([r, z]), np.array([R, -half])
    feet = []
    for end in (np.array([0, half]), np.array([0, -half])):
        edge = rim - end
        feet.append(end + np.clip((at - end) @ edge / (edge @ edge), 0, 1) * edge)
    away = min((at - foot for foot in feet), key=np.linalg.norm)
    phi = np.linalg.norm(away)
    return phi, away[0] / phi * outward + away[1] / phi * AXES[2]


def point_on_ellipsoid(a, p):
    """The root t of sum (a_i p_i / (a_i^2 + t))^2 = 1, by bisection and Newton's method."""

    def excess(t):
        return np.sum((a * p / (a * a + t)) ** 2) - 1

    low, high = -(a.min() ** 2), a.max() * np.linalg.norm(p) + 1e-300
    for _ in range(200):
        t = (low + high) / 2
        with np.errstate(divide="ignore", invalid="ignore"):
            low, high = (t, high) if excess(t) > 0 else (low, t)
    for _ in range(2):
        slope = -2 * np.sum((a * p) ** 2 / (a * a + high) ** 3)
        new = high - excess(high) / slope if slope < 0 else high
        high = new if new > -(a.min() ** 2) else high
    below = a * a + high
    x = np.where(below > 1e-12 * a * a, a * a * p / np.where(below > 0, below, 1), 0)
    free = int(np.argmin(a))
    if below[free] <= 1e-12 * a[free] ** 2:  # on the plane where the depth is not unique
        rest = 1 - np.sum(np.delete(x / a, free) ** 2)
        x[free] = a[free] * np.sqrt(max(rest, 0))
    n = x / a**2 / np.linalg.norm(x / a**2)
    return n @ (p - x), n


def farthest(shape, direction):
    """The point of a shape that lies farthest along a direction, in its own frame."""
    kind = shape["kind"]
    if kind == "ellipsoid":
        a = np.array(shape["half_axes"])
        return a * a * direction / np.linalg.norm(a * direction)
    r = np.hypot(direction[0], direction[1])
    rim = shape["radius"] * (direction / r if r > 1e-12 else AXES[0]) * [1, 1, 0]
    half = shape["length"] / 2
    if kind == "cone":
        ends = [np.array([0, 0, half]), rim - half * AXES[2]]
        return max(ends, key=lambda p: p @ direction)
    return rim + (half if direction[2] > 0 else -half) * AXES[2]


def on_halfspace(half, pose_h, shape, pose):
    """phi, alpha on the half-space, beta, n."""
    normal = np.array(half["normal"])
    length = np.linalg.norm(normal)
    n, origin = pose_h[0] @ normal / length, half["offset"] / length
    found = core(shape, pose)
    if found is None:
        beta = transformed(pose, farthest(shape, -pose[0].T @ n))[0]
    else:
        points, radius = found
        beta = points[int(np.argmin(points @ n))] - radius * n
    phi = n @ (beta - pose_h[1]) - origin
    return phi, beta - phi * n, beta, n


def swapped(found):
    """The same with alpha and beta exchanged."""
    phi, a, b, n = found
    return phi, b, a, -n


def cloud_on(cloud, pose_c, shape, pose):
    """Lists over a cloud's points as alpha."""
    point = {"kind": "sphere", "radius": 0.0}
    each = [
        closest_points(point, (np.eye(3), x), shape, pose)
        for x in transformed(pose_c, cloud["points"])
    ]
    return tuple(np.array(column) for column in zip(*each, strict=True))


def closest_points(alpha, pose_alpha, beta, pose_beta):
    """phi, alpha, beta, n of two shapes; lists of them where one is a cloud."""
    kinds = alpha["kind"], beta["kind"]
    if kinds[0] == "cloud":
        return cloud_on(alpha, pose_alpha, beta, pose_beta)
    if kinds[1] == "cloud":
        return swapped(cloud_on(beta, pose_beta, alpha, pose_alpha))
    if kinds[0] == "halfspace":
        return on_halfspace(alpha, pose_alpha, beta, pose_beta)
    if kinds[1] == "halfspace":
        return swapped(on_halfspace(beta, pose_beta, alpha, pose_alpha))
    a, b = core(alpha, pose_alpha), core(beta, pose_beta)
    if a is None and b is None:
        return by_projections(alpha, pose_alpha, beta, pose_beta)
    if a is None:
        return swapped(closest_points(beta, pose_beta, alpha, pose_alpha))
    if b is None:
        if len(a[0]) > 1:
            return by_projections(alpha, pose_alpha, beta, pose_beta)
        phi, n = point_on(beta, pose_beta[0].T @ (a[0][0] - pose_beta[1]))
        n = -(pose_beta[0] @ n)
        at, radius = a[0][0], a[1]
        return phi - radius, at + radius * n, at + phi * n, n
    phi, x, y, n = core_pair(a[0], b[0])
    return phi - a[1] - b[1], x + a[1] * n, y - b[1] * n, n


def projected(shape, pose, x):
    """The point of a solid shape nearest to x, radius left aside."""
    found = core(shape, pose)
    if found is not None:
        return shortest(found[0] - x) @ found[0]
    phi, n = point_on(shape, pose[0].T @ (x - pose[1]))
    return x - max(phi, 0.0) * (pose[0] @ n)


def by_projections(alpha, pose_alpha, beta, pose_beta):
    """Curved shapes apart: project to and fro (Cheney & Goldstein 1959), with Anderson's mixing."""
    x, past, images = projected(alpha, pose_alpha, pose_beta[1]), [], []
    for _ in range(400):
        y = projected(beta, pose_beta, x)
        image = projected(alpha, pose_alpha, y)
        if np.abs(image - x).max() < 1e-16 * (1 + np.abs(x).max()):
            break
        past, images = [*past[-3:], x], [*images[-3:], image]
        F = np.array(images) - np.array(past)
        weights = affine(F)
        mixed = weights @ np.array(images)
        x = mixed if np.abs(mixed - image).max() < np.linalg.norm(y - image) else image
        x = projected(alpha, pose_alpha, x)
    n = (y - x) / np.linalg.norm(y - x)
    radii = [shape["radius"] if shape["kind"] == "capsule" else 0.0 for shape in (alpha, beta)]
    return np.linalg.norm(y - x) - sum(radii), x + radii[0] * n, y - radii[1] * n, n
