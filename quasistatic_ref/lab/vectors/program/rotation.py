"""Rotations and poses."""

import numpy as np


def skew(w):
    """[w x]."""
    return np.array([[0, -w[2], w[1]], [w[2], 0, -w[0]], [-w[1], w[0], 0]])


def unit_quaternion(entries):
    """[x, y, z, w] at length one."""
    x, y, z, w = np.array(entries) / np.linalg.norm(entries)
    return np.array([x, y, z, w])


def rotation(quaternion):
    """Rotation of q/|q|."""
    x, y, z, w = unit_quaternion(quaternion)
    V = skew([x, y, z])
    return np.eye(3) + 2 * w * V + 2 * V @ V


def frame(pose):
    """(R, t) of a pose: x is mapped to R x + t."""
    return rotation(pose["quaternion"]), np.array(pose["xyz"])


def turn(axis, c, s):
    """Rotation about an axis by the angle of cosine c and sine s."""
    a = np.array(axis) / np.linalg.norm(axis)
    return c * np.eye(3) + s * skew(a) + (1 - c) * np.outer(a, a)


def quaternion_product(p, q):
    """Product of [x, y, z, w] quaternions."""
    return np.append(
        p[3] * q[:3] + q[3] * p[:3] + np.cross(p[:3], q[:3]), p[3] * q[3] - p[:3] @ q[:3]
    )


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
