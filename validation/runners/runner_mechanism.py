"""Mechanisms of the reference vectors in plain NumPy: order, kinematics, (+) and (-)."""

import numpy as np

ENTRIES = {  # of q, of delta_q
    "fixed": (0, 0),
    "revolute": (1, 1),
    "prismatic": (1, 1),
    "continuous": (2, 1),
    "floating": (7, 6),
    "planar": (4, 3),
}


def skew(w):
    """[w x]."""
    return np.array([[0, -w[2], w[1]], [w[2], 0, -w[0]], [-w[1], w[0], 0]])


def rotation(quaternion):
    """Rotation of q/|q|, q = [x, y, z, w]."""
    x, y, z, w = np.array(quaternion) / np.linalg.norm(quaternion)
    V = skew([x, y, z])
    return np.eye(3) + 2 * w * V + 2 * V @ V


def turn(axis, c, s):
    """Rotation about an axis by the angle of cosine c and sine s."""
    a = np.array(axis) / np.linalg.norm(axis)
    return c * np.eye(3) + s * skew(a) + (1 - c) * np.outer(a, a)


def joint_pose(body, q):
    """(R, t) of a joint at its entries of q."""
    kind, none = body["joint"], np.zeros(3)
    if kind == "floating":
        return rotation(q[3:]), np.array(q[:3])
    if kind == "planar":
        c, s = np.array(q[2:]) / np.hypot(*q[2:])
        return turn([0, 0, 1], c, s), np.array([*q[:2], 0])
    if kind == "revolute":
        return turn(body["axis"], np.cos(q[0]), np.sin(q[0])), none
    if kind == "continuous":
        c, s = np.array(q) / np.hypot(*q)
        return turn(body["axis"], c, s), none
    if kind == "prismatic":
        return np.eye(3), q[0] * np.array(body["axis"]) / np.linalg.norm(body["axis"])
    return np.eye(3), none


def slices(mechanism):
    """{body: (slice of q, slice of delta_q)}, n_a, n_v: actuated first; none of a mimic."""
    found, i, k, n_a = {}, 0, 0, 0
    for actuated in (True, False):
        for body in mechanism["bodies"]:
            if bool(body.get("actuated")) == actuated and "mimic" not in body:
                size_q, size_v = ENTRIES[body["joint"]]
                found[body["name"]] = slice(i, i + size_q), slice(k, k + size_v)
                i, k = i + size_q, k + size_v
        n_a = k if actuated else n_a
    return found, n_a, k


def kinematics(mechanism, q):
    """{body: (R, t, J)}: J (6 x n_v) of the velocity of its origin and its angular velocity."""
    at, _, n_v = slices(mechanism)
    found = {None: (np.eye(3), np.zeros(3), np.zeros((6, n_v)))}
    for body in mechanism["bodies"]:
        R0, t0, J0 = found[body["parent"]]
        placement = body["placement"]
        Rp, tp = R0 @ rotation(placement["quaternion"]), R0 @ placement["xyz"] + t0
        mimic = body.get("mimic", {"of": body["name"], "multiplier": 1.0, "offset": 0.0})
        entries, columns = at[mimic["of"]]
        pace, position = mimic["multiplier"], q[entries]
        R_q, t_q = joint_pose(body, pace * position + mimic["offset"])
        R, t = Rp @ R_q, Rp @ t_q + tp
        J, k = J0.copy(), columns.start
        J[:3] -= skew(t - t0) @ J0[3:]
        if body["joint"] == "floating":
            J[:3, k : k + 3] = J[3:, k + 3 : k + 6] = R
        elif body["joint"] == "planar":
            J[:3, k : k + 2], J[3:, k + 2] = R[:, :2], R[:, 2]
        elif body["joint"] == "prismatic":
            J[:3, k] += pace * (Rp @ body["axis"] / np.linalg.norm(body["axis"]))
        elif body["joint"] != "fixed":
            J[3:, k] += pace * (Rp @ body["axis"] / np.linalg.norm(body["axis"]))
        found[body["name"]] = R, t, J
    return found


def point_jacobian(at, point):
    """Velocity of a material point, and the angular velocity."""
    _, t, J = at
    return J[:3] - skew(np.array(point) - t) @ J[3:], J[3:]


def coefficients(t):
    """Sin t / t, (1 - cos t) / t^2, (t - sin t) / t^3, by series where they would cancel."""
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


def quaternion_product(p, q):
    """Product of [x y z w] quaternions."""
    return np.append(
        p[3] * q[:3] + q[3] * p[:3] + np.cross(p[:3], q[:3]), p[3] * q[3] - p[:3] @ q[:3]
    )


def moved(body, q, d):
    """Q (+) d of one joint."""
    kind = body["joint"]
    if kind == "floating":
        v, w, R = d[:3], d[3:], rotation(q[3:])
        t = np.linalg.norm(w)
        _, b, c = coefficients(t)
        shift = v + b * np.cross(w, v) + c * np.cross(w, np.cross(w, v))
        half = np.append(coefficients(t / 2)[0] / 2 * w, np.cos(t / 2))
        turned = quaternion_product(q[3:] / np.linalg.norm(q[3:]), half)
        return np.concatenate([q[:3] + R @ shift, turned / np.linalg.norm(turned)])
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
    """The d with q (+) d = target, of one joint."""
    kind = body["joint"]
    if kind == "floating":
        inverse = q[3:] / np.linalg.norm(q[3:]) * [-1, -1, -1, 1]
        p = quaternion_product(inverse, target[3:] / np.linalg.norm(target[3:]))
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
