"""Signed distances of two shapes in plain NumPy.

Sphere, point, capsule, box and convex hull are cores, points with a radius about them. Apart, the
shortest vector of two cores is Wolfe's; in penetration the best of all normals of faces and
pairs of edges. A half-space meets the farthest point. Cylinder, cone and ellipsoid have the
signed distance of a point, and so that of a sphere.
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
    size, before, best = max(np.abs(P).max() ** 2, 1e-300), np.inf, (S, w)
    while True:
        x = w @ P[S]
        if x @ x >= before:  # it would shrink, were it not for rounding
            break
        before, best = x @ x, (S, w)
        j = int(np.argmin(P @ x))
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
    alpha, beta = weights.sum(axis=1) @ A, weights.sum(axis=0) @ B
    d = np.linalg.norm(beta - alpha)
    if d > 0.1 * size and P.shape[0] > 4:
        return d, alpha, beta, (beta - alpha) / d
    N, sine = normals(A, B)
    gap = (B @ N.T).min(axis=0) - (A @ N.T).max(axis=0)
    # Of the same face's normals, the one from the least acute pair of edges.
    best = int(np.argmax(np.where(gap >= gap.max() - 4e-15 * size, sine, -1.0)))
    if d > 1e-13 * size and gap[best] < d - 1e-14 * size:
        return d, alpha, beta, (beta - alpha) / d
    n, phi = N[best], gap[best]
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
    N, sine = N[real] / length[real, None], sine[real]
    return np.concatenate([N, -N]), np.concatenate([sine, sine])


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
    """The root s of sum (a_i p_i / (a_i^2 - a_min^2 + s))^2 = 1, s >= 0, by bisection."""
    above, least = a * a - a.min() ** 2, int(np.argmin(a))
    low, high = 0.0, a.max() * np.linalg.norm(p) + a.min() ** 2
    for _ in range(1100):  # float64 may have to be halved that often to reach 0
        s = (low + high) / 2
        if not low < s < high:
            break
        with np.errstate(over="ignore"):
            low, high = (s, high) if np.sum((a * p / (above + s)) ** 2) > 1 else (low, s)
    below = above + high
    x = np.where(p == 0, 0.0, a * a * p / np.where(below > 0, below, 1.0))
    if p[least] == 0 and high < 1e-300:  # on the plane from which two ways out are as short
        x[least] = a[least] * np.sqrt(max(1 - np.sum(np.delete(x / a, least) ** 2), 0.0))
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


def points_on(shape, P):
    """Signed distances and outward normals of many points in the frame of a shape."""
    kind = shape["kind"]
    if kind == "halfspace":
        length = np.linalg.norm(shape["normal"])
        n = np.array(shape["normal"]) / length
        return P @ n - shape["offset"] / length, np.tile(n, (len(P), 1))
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
    if core(alpha, pose_alpha) is None:
        return swapped(closest_points(beta, pose_beta, alpha, pose_alpha))
    # In the frame of beta, whose corners are then not rounded.
    R, t = pose_beta
    a, r = core(alpha, (R.T @ pose_alpha[0], R.T @ (pose_alpha[1] - t)))
    b = core(beta, (np.eye(3), np.zeros(3)))
    if b is not None:
        phi, x, y, n = core_pair(a, b[0])
        phi, y = phi - b[1], y - b[1] * n
    elif len(a) == 1:
        phi, n = point_on(beta, a[0])
        x, y, n = a[0], a[0] - phi * n, -n
    else:
        raise NotImplementedError(f"{kinds} would need an iteration; the vectors have none")
    return phi - r, R @ (x + r * n) + t, R @ y + t, R @ n
