"""Points of cylinders, cones and ellipsoids, in closed form or by bisection."""

import numpy as np

from .rotation import AXES


def point_on(shape, p):
    """Signed distance and outward normal of a point in the frame of a curved shape."""
    kind = shape["kind"]
    if kind == "ellipsoid":
        return point_on_ellipsoid(np.array(shape["half_axes"]), p)
    r = np.hypot(p[0], p[1])
    z = p[2]
    outward = np.array([p[0] / r, p[1] / r, 0]) if r > 0 else AXES[0]
    R = shape["radius"]
    half = shape["length"] / 2
    if kind == "cylinder":
        excess = np.array([r - R, abs(z) - half])
        up = -1.0 if z < 0 else 1.0
        if excess.max() > 0:
            beyond = np.maximum(excess, 0)
            phi = np.hypot(*beyond)
            n = beyond / phi
        else:
            phi = excess.max()
            n = AXES[int(excess[1] > excess[0]), :2]
        return phi, n[0] * outward + n[1] * up * AXES[2]
    slant = np.array([2 * half, R]) / np.hypot(2 * half, R)  # normal of the side, in (r, z)
    side = slant @ [r, z - half]
    inside = max(side, -half - z)
    if inside <= 0:
        n = slant if side >= -half - z else np.array([0, -1.0])
        return inside, n[0] * outward + n[1] * AXES[2]
    at = np.array([r, z])
    rim = np.array([R, -half])
    feet = []
    for end in (np.array([0, half]), np.array([0, -half])):
        edge = rim - end
        feet.append(end + np.clip((at - end) @ edge / (edge @ edge), 0, 1) * edge)
    away = min((at - foot for foot in feet), key=np.linalg.norm)
    phi = np.linalg.norm(away)
    n = away / phi if phi > 0 else slant
    return phi, n[0] * outward + n[1] * AXES[2]


def point_on_ellipsoid(a, p):
    """Signed distance of a point p from an ellipsoid of half-axes a, and the normal there.

    By bisection for the root s >= 0 of sum (a_i p_i / (a_i^2 - a_min^2 + s))^2 = 1.
    """
    above = a * a - a.min() ** 2
    least = int(np.argmin(a))
    low = 0.0
    high = float(a.max() * np.linalg.norm(p) + a.min() ** 2)
    terms = list(zip((a * p).tolist(), above.tolist(), strict=True))  # as numbers: many halvings
    while low < (s := (low + high) / 2) < high:
        ratios = [numerator / (c + s) for numerator, c in terms]
        low, high = (s, high) if sum(r * r for r in ratios) > 1 else (low, s)
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
    rim = shape["radius"] * (direction / r if r > 0 else AXES[0]) * [1, 1, 0]
    half = shape["length"] / 2
    if kind == "cone":
        ends = [np.array([0, 0, half]), rim - half * AXES[2]]
        return max(ends, key=lambda p: p @ direction)
    return rim + (half if direction[2] > 0 else -half) * AXES[2]
