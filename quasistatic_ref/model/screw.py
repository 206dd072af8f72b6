"""q (+) delta_q and q_next (-) q of the joints that turn: screws of bases, turns of wheels.

With a the angle of a turn, b = a / 2, and (C, S) = (cos b, sin b), all else is sums, products,
quotients and square roots in one fixed order, so that a run has the same bits everywhere. Nothing
that cancels is divided by a small number: pinocchio's translations, of differences like 1 - cos a
divided by a power of a, are wrong by 5e-13 of themselves at 2e-4 rad, those of a planar base by
4e-4 at 1e-13 rad. Steps of a simulation are as small as that.
"""

import math
from collections.abc import Sequence
from typing import NamedTuple

from quasistatic_ref.model.angles import angle_of, cos_sin
from quasistatic_ref.model.coordinates import Joint

Vector = Sequence[float]
"""Few numbers: on so few, plain arithmetic takes a tenth of NumPy's time."""

TURNING = ("floating", "planar", "continuous")
"""Kinds of joints whose q holds a quaternion, or (cos, sin)."""


def moved(joint: Joint, q: list[float], delta_q: list[float]) -> list[float]:
    """A turning joint's entries of q (+) delta_q [m, -].

    Parameters
    ----------
    joint : Joint
    q : list of n_q floats
    delta_q : list of n_v floats
    """
    q_joint = q[joint.q]
    increment = delta_q[joint.v]
    if joint.kind == "continuous":
        return _heading(q_joint, increment[0])
    if joint.kind == "planar":
        v = [increment[0], increment[1], 0.0]
        w = [0.0, 0.0, increment[2]]
        t = translation(v, w, half_turn(w))
        x, y, _ = _carried([*q_joint[:2], 0.0], _rotation(joint, q_joint), t)
        return [x, y, *_heading(q_joint[2:], increment[2])]
    v = increment[:3]
    w = increment[3:]
    half = half_turn(w)
    t = translation(v, w, half)
    position = _carried(q_joint[:3], _rotation(joint, q_joint), t)
    return position + _quaternion(q_joint[3:], w, half)


def change(joint: Joint, q: list[float], q_next: list[float]) -> list[float]:
    """A turning joint's entries of q_next (-) q [m, rad].

    Parameters
    ----------
    joint : Joint
    q, q_next : list of n_q floats
    """
    q_joint = q[joint.q]
    q_joint_next = q_next[joint.q]
    if joint.kind == "continuous":
        return [_turn(q_joint, q_joint_next)]
    planar = joint.kind == "planar"
    z = 0.0 if planar else q_joint_next[2] - q_joint[2]
    apart = [q_joint_next[0] - q_joint[0], q_joint_next[1] - q_joint[1], z]
    # The columns of R are the base's own axes in the world.
    axis_x, axis_y, axis_z = zip(*_rotation(joint, q_joint), strict=True)
    displacement = [dot(axis_x, apart), dot(axis_y, apart), dot(axis_z, apart)]
    if planar:
        angle = _turn(q_joint[2:], q_joint_next[2:])
        return [*linear_part(displacement, [0.0, 0.0, angle])[:2], angle]
    w, a, c2 = _rotation_between(q_joint[3:], q_joint_next[3:])
    return [*_combined(displacement, w, a, -0.5, c2), *w]


class HalfTurn(NamedTuple):
    """Half of a turn by an angle a.

    Parameters
    ----------
    angle : float
        a [rad], all of it.
    C, ratio : float
        cos(a / 2) and sin(a / 2) / (a / 2) [-].
    """

    angle: float
    C: float
    ratio: float


def half_turn(w: Vector) -> HalfTurn:
    """Half of the turn by |w|, of 3 floats [rad]."""
    a = length(w)
    C, S = cos_sin(a / 2)
    return HalfTurn(a, C, S / (a / 2) if a else 1.0)


def translation(v: Vector, w: Vector, half: HalfTurn) -> list[float]:
    """Translation of exp6 of a twist, in the frame that it starts from [m].

    V v = v + (1 - cos a) / a^2 w x v + (1 - sin a / a) e x (e x v), with a = |w| and e = w / a.

    Parameters
    ----------
    v, w : sequence of 3 floats
        Linear [m] and angular [rad] part of the twist.
    half : HalfTurn
        Of w.
    """
    a, C, ratio = half
    return _combined(v, w, a, ratio * ratio / 2, 1 - ratio * C)  # sin a = 2 sin(a/2) cos(a/2)


def linear_part(t: Vector, w: Vector) -> list[float]:
    """The v whose twist (v, w) carries a base by a translation t, 3 numbers [m].

    V^-1 t = t - w x t / 2 + (1 - (a / 2) cot(a / 2)) e x (e x t), for a < 2 pi.

    Parameters
    ----------
    t, w : sequence of 3 floats
        Translation [m] and rotation vector [rad].
    """
    a, C, ratio = half_turn(w)
    return _combined(t, w, a, -0.5, 1 - C / ratio)


def dot(w: Vector, v: Vector) -> float:
    """The product w'v of three numbers each [any unit]; ``sum`` rounds as its Python does."""
    p, q, r = w
    x, y, z = v
    return p * x + q * y + r * z


def length(w: Vector) -> float:
    """Length of a vector of three numbers [its unit]; 0 where its square is."""
    return math.sqrt(dot(w, w))


def _combined(v: Vector, w: Vector, a: float, c1: float, c2: float) -> list[float]:
    """V + c1 w x v + c2 e x (e x v), where w = a e, and e x (e x v) = (e . v) e - v."""
    x, y, z = v
    p, q, r = w
    rest = 1 - c2
    along = c2 * dot(w, v) / (a * a) if a * a else 0.0
    return [
        rest * x + c1 * (q * z - r * y) + along * p,
        rest * y + c1 * (r * x - p * z) + along * q,
        rest * z + c1 * (p * y - q * x) + along * r,
    ]


def _carried(position: Vector, R: list[list[float]], t: Vector) -> list[float]:
    """The position of a base, 3 floats, after a translation t in its own axes, those of R [m]."""
    x, y, z = position
    row_x, row_y, row_z = R
    return [x + dot(row_x, t), y + dot(row_y, t), z + dot(row_z, t)]


def _quaternion(q_joint: Vector, w: Vector, half: HalfTurn) -> list[float]:
    """A quaternion times that of a rotation vector, of length one; without a turn as it is."""
    _, C, ratio = half
    p, q, r = w
    scale = ratio / 2
    p *= scale
    q *= scale
    r *= scale
    if p == q == r == 0:
        return [*q_joint]
    x, y, z, s = q_joint
    a = s * p + x * C + y * r - z * q
    b = s * q + y * C + z * p - x * r
    c = s * r + z * C + x * q - y * p
    d = s * C - x * p - y * q - z * r
    shorter = (3 - (a * a + b * b + c * c + d * d)) / 2  # of 1 / sqrt, next to 1
    return [shorter * a, shorter * b, shorter * c, shorter * d]


def _rotation_between(q_joint: Vector, q_joint_next: Vector) -> tuple[list[float], float, float]:
    """What turns one quaternion into another: w, a = |w| <= pi [rad], and 1 - (a/2) cot(a/2)."""
    x, y, z, s = q_joint
    p, q, r, k = q_joint_next
    v = [
        s * p - x * k - y * r + z * q,
        s * q - y * k - z * p + x * r,
        s * r - z * k - x * q + y * p,
    ]
    w = s * k + x * p + y * q + z * r
    S = length(v)
    C = abs(w)
    b = angle_of(S, C)
    ratio = b / S if S else 1.0
    scale = 2 * ratio if w >= 0 else -2 * ratio
    return [scale * part for part in v], 2 * b, 1 - ratio * C if S else 0.0


def _heading(q_joint: Vector, angle: float) -> list[float]:
    """(cos, sin) turned by an angle, of length one; without a turn as it is."""
    if angle == 0:
        return [*q_joint]
    c, s = q_joint
    C, S = cos_sin(angle / 2)
    cosine = 1 - 2 * (S * S)
    sine = 2 * (S * C)
    x = c * cosine - s * sine
    y = s * cosine + c * sine
    shorter = (3 - (x * x + y * y)) / 2
    return [shorter * x, shorter * y]


def _rotation(joint: Joint, q_joint: list[float]) -> list[list[float]]:
    """Rows of the rotation matrix of a base, from its entries of q."""
    if joint.kind == "planar":
        c, s = q_joint[2:]
        return [[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]]
    x, y, z, w = q_joint[3:]
    return [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]


def _turn(before: Vector, after: Vector) -> float:
    """Angle from one (cos, sin) to another."""
    c, s = before
    c_next, s_next = after
    return angle_of(c * s_next - s * c_next, c * c_next + s * s_next)
