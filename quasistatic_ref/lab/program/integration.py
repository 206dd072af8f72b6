"""Layer 7: q (+) delta_q, joint by joint, and its inverse (-)."""

import numpy as np

from .mechanism import slices
from .rotation import AXES, quaternion_product, rotation, skew, unit


def coefficients(t):
    """The ratios sin t / t, (1 - cos t) / t^2 and (t - sin t) / t^3; by series for small t."""
    if t < 0.3:
        ratios = []
        for first in (1, 2, 3):
            term = total = 1 / np.prod(np.arange(1, first + 1))
            for k in range(first + 1, first + 16, 2):
                term *= -t * t / (k * (k + 1))
                total += term
            ratios.append(total)
        return ratios
    return [np.sin(t) / t, (1 - np.cos(t)) / t**2, (t - np.sin(t)) / t**3]


def moved(body, q, d):
    """The q (+) d of one joint."""
    kind = body["joint"]
    if kind == "floating":
        p = q[3:]
        v = d[:3]
        w = d[3:]
        t = np.sqrt(w @ w)
        _, b, c = coefficients(t)
        shift = v + b * np.cross(w, v) + c * np.cross(w, np.cross(w, v))
        half = np.append(coefficients(t / 2)[0] / 2 * w, np.cos(t / 2))
        turned = unit(quaternion_product(p, half))
        return np.concatenate([q[:3] + rotation(p) @ shift, turned])
    if kind in ("planar", "continuous"):
        c, s = unit(q[-2:])
        turned = unit(np.array([[c, -s], [s, c]]) @ [np.cos(d[-1]), np.sin(d[-1])])
        if kind == "continuous":
            return turned
        a, b, _ = coefficients(abs(d[2]))
        x = a * d[0] - b * d[2] * d[1]
        y = a * d[1] + b * d[2] * d[0]
        return np.array([q[0] + c * x - s * y, q[1] + s * x + c * y, *turned])
    return q + d


def difference(body, target, q):
    """The least d with q (+) d = target, of one joint."""
    kind = body["joint"]
    if kind == "floating":
        back = np.append(-q[3:6], q[6])
        p = unit(quaternion_product(back, target[3:]))
        p = -p if p[3] < 0 else p
        s = np.sqrt(p[:3] @ p[:3])
        w = p[:3] * (2 * np.arctan2(s, p[3]) / s if s else 2)
        _, b, c = coefficients(np.sqrt(w @ w))
        W = skew(w)
        V = AXES + b * W + c * W @ W
        return np.append(np.linalg.solve(V, rotation(q[3:]).T @ (target[:3] - q[:3])), w)
    if kind in ("planar", "continuous"):
        c, s = q[-2:]
        c1, s1 = target[-2:]
        w = np.arctan2(c * s1 - s * c1, c * c1 + s * s1)
        if kind == "continuous":
            return np.array([w])
        a, b, _ = coefficients(abs(w))
        c, s = unit([c, s])
        x, y = np.array([[c, s], [-s, c]]) @ (target[:2] - q[:2])
        size = a * a + b * w * b * w
        return np.array([(a * x + b * w * y) / size, (a * y - b * w * x) / size, w])
    return target - q


def integrate(case):
    """Layer 7: the q (+) delta_q of a case."""
    q = np.array(case["q"])
    delta_q = np.array(case["delta_q"])
    return {"q": joint_parts(case["mechanism"], lambda body, i, k: moved(body, q[i], delta_q[k]))}


def way(mechanism, q, target):
    """The delta_q with q (+) delta_q = target: of as many joints as the target has entries of."""
    q = np.array(q)
    target = np.array(target)
    return joint_parts(mechanism, lambda body, i, k: difference(body, target[i], q[i]), len(target))


def joint_parts(mechanism, part, n_q=None):
    """The numbers of all joints, each by `part` from its entries of q and of delta_q."""
    bodies = {body["name"]: body for body in mechanism["bodies"]}
    places = slices(mechanism)[0].items()
    parts = [part(bodies[name], i, k) for name, (i, k) in places if n_q is None or i.stop <= n_q]
    return np.concatenate(parts) if parts else np.zeros(0)
