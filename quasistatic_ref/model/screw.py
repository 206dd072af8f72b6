"""How far a twist carries a base, and which twist carries it so far.

pinocchio computes both from differences like 1 - cos a divided by a power of the angle a, and
changes to a series only below some angle: a floating base's translation is then wrong by 5e-13 of
itself at 2e-4 rad, a planar base's by 1e-8 at 1e-9 rad and by 4e-4 at 1e-13 rad; and of a change
of a planar or continuous joint's angle by less than 1e-8 it sometimes makes zero. Steps of a
simulation are as small as that. Here nothing that cancels is divided by a small number.
"""

import math
from collections.abc import Sequence

import numpy as np

from quasistatic_ref.model.coordinates import Joint
from quasistatic_ref.step.data import Array

Vector = Sequence[float]
"""Few numbers: on so few, plain arithmetic takes a tenth of NumPy's time."""


def position(joint: Joint, q: list[float], delta_q: list[float]) -> list[float]:
    """Translation part of a floating or planar base's q (+) delta_q, 3 or 2 numbers [m]."""
    own = delta_q[joint.v]
    if joint.kind == "planar":
        own = [own[0], own[1], 0.0, 0.0, 0.0, own[2]]
    x, y, z = translation(own[:3], own[3:])
    rows = zip(q[joint.q], _rotation(joint, q), strict=False)  # the quaternion comes after
    there = [at + (a * x + b * y + c * z) for at, (a, b, c) in rows]
    return there[:2] if joint.kind == "planar" else there


def changes(joints: Sequence[Joint], q: Array, q_next: Array, delta_q: Array) -> Array:
    """q_next (-) q: delta_q, in which :func:`change` replaces the entries of these joints.

    Parameters
    ----------
    joints : sequence of Joint
        Floating, planar or continuous.
    q, q_next : ndarray, shape (n_q,)
    delta_q : ndarray, shape (n_v,), or (n_a,) for the actuated coordinates alone

    Returns
    -------
    ndarray, shape (n_v,) or (n_a,)
    """
    entries, here, there = delta_q.tolist(), q.tolist(), q_next.tolist()
    for joint in joints:
        if joint.v.stop <= len(entries):
            entries[joint.v] = change(joint, here, there, entries)
    return np.array(entries)


def change(joint: Joint, q: list[float], q_next: list[float], delta_q: list[float]) -> list[float]:
    """A joint's entries of q_next (-) q, of which delta_q holds a rotation vector already.

    Parameters
    ----------
    joint : Joint
        Floating, planar or continuous.
    q, q_next : list of n_q floats
    delta_q : list of n_v floats, or those of the actuated coordinates
        Its entries for the rotation of a floating base are taken as they are.
    """
    here, there = q[joint.q], q_next[joint.q]
    if joint.kind == "continuous":
        return [_turn(here, there)]
    planar = joint.kind == "planar"
    z = 0.0 if planar else there[2] - here[2]
    apart = [there[0] - here[0], there[1] - here[1], z]
    columns = zip(*_rotation(joint, q), strict=True)  # of R: the base's own axes in the world
    moved = [dot(axis, apart) for axis in columns]
    if planar:
        angle = _turn(here[2:], there[2:])
        return [*linear_part(moved, [0.0, 0.0, angle])[:2], angle]
    angular = delta_q[joint.v][3:]
    return [*linear_part(moved, angular), *angular]


def translation(v: Vector, w: Vector) -> list[float]:
    """Translation of exp6 of a twist, in the frame that it starts from [m].

    V v = v + (1 - cos a) / a^2 w x v + (1 - sin a / a) e x (e x v), with a = |w| and e = w / a.

    Parameters
    ----------
    v, w : sequence of 3 floats
        Linear [m] and angular [rad] part of the twist.
    """
    a = math.hypot(*w)
    half = _sinc(a / 2)  # (1 - cos a) / a^2 = half^2 / 2, without the difference
    return _combined(v, w, a, half * half / 2, 1 - _sinc(a))


def linear_part(t: Vector, w: Vector) -> list[float]:
    """The v whose twist (v, w) carries a base by a translation t, 3 numbers [m].

    V^-1 t = t - w x t / 2 + (1 - (a / 2) cot(a / 2)) e x (e x t), for a < 2 pi.

    Parameters
    ----------
    t, w : sequence of 3 floats
        Translation [m] and rotation vector [rad].
    """
    a = math.hypot(*w)
    return _combined(t, w, a, -0.5, 1 - a / 2 / math.tan(a / 2) if a else 0.0)


def dot(w: Vector, v: Vector) -> float:
    """The product w'v of three numbers each [any unit]; ``sum`` rounds as its Python does."""
    (p, q, r), (x, y, z) = w, v
    return p * x + q * y + r * z


def _combined(v: Vector, w: Vector, a: float, once: float, twice: float) -> list[float]:
    """Sum of v, once w x v and twice e x (e x v), where w = a e; the last is (e . v) e - v."""
    (x, y, z), (p, q, r), rest = v, w, 1 - twice
    along = twice * (p * x + q * y + r * z) / (a * a) if a * a else 0.0
    return [
        rest * x + once * (q * z - r * y) + along * p,
        rest * y + once * (r * x - p * z) + along * q,
        rest * z + once * (p * y - q * x) + along * r,
    ]


def _rotation(joint: Joint, q: list[float]) -> list[list[float]]:
    """Rows of the rotation matrix of a base."""
    if joint.kind == "planar":
        c, s = q[joint.q][2:]
        return [[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]]
    x, y, z, w = q[joint.q][3:]
    return [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]


def _turn(before: Vector, after: Vector) -> float:
    """Angle from one (cos, sin) to another."""
    (c, s), (c_next, s_next) = before, after
    return math.atan2(c * s_next - s * c_next, c * c_next + s * s_next)


def _sinc(x: float) -> float:
    return math.sin(x) / x if x else 1.0
