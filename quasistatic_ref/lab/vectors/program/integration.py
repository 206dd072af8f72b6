"""Layer 7: q (+) delta_q, joint by joint, and its inverse (-)."""

import numpy as np

from .mechanism import slices
from .rotation import coefficients, quaternion_product, rotation, skew, unit_quaternion


def moved(body, q, d):
    """The q (+) d of one joint."""
    kind = body["joint"]
    if kind == "floating":
        R, p = rotation(q[3:]), unit_quaternion(q[3:])
        v = d[:3]
        w = d[3:]
        t = np.linalg.norm(w)
        _, b, c = coefficients(t)
        shift = v + b * np.cross(w, v) + c * np.cross(w, np.cross(w, v))
        half = np.append(coefficients(t / 2)[0] / 2 * w, np.cos(t / 2))
        turned = quaternion_product(p, half)
        turned /= np.linalg.norm(turned)
        return np.concatenate([q[:3] + R @ shift, turned])
    if kind in ("planar", "continuous"):
        c, s = q[-2:] / np.hypot(*q[-2:])
        turned = np.array([[c, -s], [s, c]]) @ [np.cos(d[-1]), np.sin(d[-1])]
        turned /= np.hypot(*turned)
        if kind == "continuous":
            return turned
        a, b, _ = coefficients(abs(d[2]))
        x, y = a * d[0] - b * d[2] * d[1], a * d[1] + b * d[2] * d[0]
        return np.array([q[0] + c * x - s * y, q[1] + s * x + c * y, *turned])
    return q + d


def difference(body, target, q):
    """The least d with q (+) d = target, of one joint."""
    kind = body["joint"]
    if kind == "floating":
        inverse = unit_quaternion(q[3:]) * [-1, -1, -1, 1]
        p = quaternion_product(inverse, unit_quaternion(target[3:]))
        p = -p if p[3] < 0 else p
        s = np.linalg.norm(p[:3])
        w = p[:3] * (2 * np.arctan2(s, p[3]) / s if s > 0 else 2.0)
        _, b, c = coefficients(np.linalg.norm(w))
        W = skew(w)
        V = np.eye(3) + b * W + c * W @ W
        return np.concatenate([np.linalg.solve(V, rotation(q[3:]).T @ (target[:3] - q[:3])), w])
    if kind in ("planar", "continuous"):
        (c, s), (c1, s1) = q[-2:], target[-2:]
        w = np.arctan2(c * s1 - s * c1, c * c1 + s * s1)
        if kind == "continuous":
            return np.array([w])
        a, b, _ = coefficients(abs(w))
        c, s = np.array([c, s]) / np.hypot(c, s)
        shift = np.array([[c, s], [-s, c]]) @ (target[:2] - q[:2])
        return np.append(np.linalg.solve([[a, -b * w], [b * w, a]], shift), w)
    return target - q


def integrate(case):
    """Layer 7."""
    at, _, _ = slices(case["mechanism"])
    q, delta_q = np.array(case["q"]), np.array(case["delta_q"])
    for body in case["mechanism"]["bodies"]:
        i, k = at.get(body["name"], (slice(0, 0), slice(0, 0)))
        if i.stop > i.start:
            q[i] = moved(body, q[i], delta_q[k])
    return {"q": q}
