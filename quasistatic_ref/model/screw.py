"""How far a twist carries a base, and which twist carries it so far.

pinocchio computes both from differences like 1 - cos a divided by a power of the angle a, and
changes to a series only below some angle: a floating base's translation is then wrong by 5e-13 of
itself at 2e-4 rad, a planar base's by 1e-8 at 1e-9 rad and by 4e-4 at 1e-13 rad; and of a change
of a planar or continuous joint's angle by less than 1e-8 it sometimes makes zero. Steps of a
simulation are as small as that. Here nothing that cancels is divided by a small number.
"""

from __future__ import annotations

import math

import numpy as np

from quasistatic_ref.model.coordinates import Joint
from quasistatic_ref.step.data import Array


def position(joint: Joint, q: Array, delta_q: Array) -> Array:
    """Translation part of a floating or planar base's q (+) delta_q, shape (3,) or (2,) [m]."""
    R, own = _rotation(joint, q), delta_q[joint.v]
    if joint.kind == "planar":
        own = np.array([own[0], own[1], 0.0, 0.0, 0.0, own[2]])
    return np.asarray(q[place(joint)] + R @ translation(own[:3], own[3:])[: len(R)])


def change(joint: Joint, q: Array, q_next: Array, delta_q: Array) -> Array:
    """A joint's entries (k,) of q_next (-) q, of which delta_q holds a rotation vector already.

    Parameters
    ----------
    joint : Joint
        Floating, planar or continuous.
    q, q_next : ndarray, shape (n_q,)
    delta_q : ndarray, shape (n_v,)
        Its entries for the rotation of a floating base are taken as they are.
    """
    if joint.kind == "continuous":
        return np.array([_turn(q[joint.q], q_next[joint.q])])
    R = _rotation(joint, q)
    moved, angular = np.zeros(3), np.zeros(3)
    moved[: len(R)] = (q_next[place(joint)] - q[place(joint)]) @ R
    if joint.kind == "planar":
        angular[2] = _turn(q[joint.q][2:], q_next[joint.q][2:])
        return np.array([*linear_part(moved, angular)[:2], angular[2]])
    angular = delta_q[joint.v][3:]
    return np.concatenate([linear_part(moved, angular), angular])


def place(joint: Joint) -> slice:
    """Where a base's translation is in q: three entries, or two of a planar one."""
    return slice(joint.q.start, joint.q.start + (3 if joint.kind == "floating" else 2))


def translation(linear: Array, angular: Array) -> Array:
    """Translation of exp6 of a twist, in the frame that it starts from, shape (3,) [m].

    V v = v + (1 - cos a) / a^2 w x v + (1 - sin a / a) e x (e x v), with a = |w| and e = w / a.

    Parameters
    ----------
    linear, angular : ndarray, shape (3,)
        v [m] and w [rad].
    """
    angle, axis = _angle_axis(angular)
    v = linear.tolist()
    once = _cross(angular.tolist(), v)
    across = _cross(axis, _cross(axis, v))
    half = _sinc(angle / 2)
    first, second = half * half / 2, 1 - _sinc(angle)
    return np.array([v[i] + first * once[i] + second * across[i] for i in range(3)])


def linear_part(translation: Array, angular: Array) -> Array:
    """The v whose twist (v, w) carries a base by a translation, shape (3,) [m].

    The rotation vector w is `angular`, shape (3,) [rad].

    V^-1 t = t - w x t / 2 + (1 - (a / 2) cot(a / 2)) e x (e x t), for a < 2 pi.
    """
    angle, axis = _angle_axis(angular)
    t = translation.tolist()
    once, across = _cross(angular.tolist(), t), _cross(axis, _cross(axis, t))
    ratio = angle / 2 / math.tan(angle / 2) if angle else 1.0
    return np.array([t[i] - once[i] / 2 + (1 - ratio) * across[i] for i in range(3)])


def _rotation(joint: Joint, q: Array) -> Array:
    """Rotation matrix of a base, shape (3, 3), or (2, 2) of a planar one."""
    if joint.kind == "planar":
        c, s = q[joint.q][2:]
        return np.array([[c, -s], [s, c]])
    x, y, z, w = q[joint.q][3:].tolist()
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )


def _turn(before: Array, after: Array) -> float:
    """Angle from one (cos, sin) to another."""
    (c, s), (c_next, s_next) = before, after
    return float(np.arctan2(c * s_next - s * c_next, c * c_next + s * s_next))


def _angle_axis(angular: Array) -> tuple[float, list[float]]:
    w = angular.tolist()
    angle = math.hypot(*w)
    return angle, [w_i / angle for w_i in w] if angle else [0.0, 0.0, 0.0]


def _cross(a: list[float], b: list[float]) -> list[float]:
    # Of three numbers: NumPy's takes twenty times as long.
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def _sinc(x: float) -> float:
    return math.sin(x) / x if x else 1.0
