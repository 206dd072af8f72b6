"""Rotations and poses."""

import numpy as np

AXES = np.eye(3, dtype=int)
NONE = np.zeros(3, dtype=int)


def unit(v):
    """Direction v/|v|."""
    v = np.array(v)
    return v / np.sqrt(v @ v)


def skew(w):
    """[w x]."""
    return np.array([[0, -w[2], w[1]], [w[2], 0, -w[0]], [-w[1], w[0], 0]])


def rotation(quaternion):
    """Rotation of q/|q|, q = [x, y, z, w]."""
    q = np.array(quaternion)
    V = skew(q[:3])
    return AXES + 2 / (q @ q) * (q[3] * V + V @ V)


def frame(pose):
    """(R, t) of a pose: x is mapped to R x + t."""
    return rotation(pose["quaternion"]), np.array(pose["xyz"])


def turn(axis, c, s):
    """Rotation about an axis by the angle of cosine c and sine s."""
    a = unit(axis)
    return c * AXES + s * skew(a) + (1 - c) * np.outer(a, a)


def quaternion_product(p, q):
    """Product of [x, y, z, w] quaternions."""
    return np.append(
        p[3] * q[:3] + q[3] * p[:3] + np.cross(p[:3], q[:3]), p[3] * q[3] - p[:3] @ q[:3]
    )
