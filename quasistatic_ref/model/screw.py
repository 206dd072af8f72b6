"""Sums and differences of joints that turn: screws of bases, turns of wheels.

With a the angle of a turn, b = a / 2, and (C, S) = (cos b, sin b), all else is sums, products,
quotients and square roots in one fixed order, so that a run has the same bits everywhere. Nothing
that cancels is divided by a small number: pinocchio's translations, of differences like 1 - cos a
divided by a power of a, are wrong by 5e-13 of themselves at 2e-4 rad, those of a planar base by
4e-4 at 1e-13 rad. Steps of a simulation are as small as that.

An entry is a number, or an array of one for each of many joints: the operations are the same.
"""

from collections.abc import Sequence

from quasistatic_ref.numbers.angles import Number, angle_of, chosen, cos_sin, root

Vector = Sequence[Number]
"""Few entries: on single numbers plain arithmetic takes a tenth of NumPy's time."""


HalfTurn = tuple[Number, Number, Number]
"""Half of a turn by an angle a: a [rad], all of it; cos(a / 2) and sin(a / 2) / (a / 2) [-]."""


def half_turn(w: Vector) -> HalfTurn:
    """Of a rotation vector w, 3 floats [rad]: |w|, cos(|w| / 2) and sin(|w| / 2) / (|w| / 2)."""
    a = length(w)
    b = a / 2
    C, S = cos_sin(b)
    return a, C, chosen(a == 0, 1.0, S / chosen(a == 0, 1.0, b))


def translation(v: Vector, w: Vector, half: HalfTurn) -> list[Number]:
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
    return combined(v, w, a, ratio * ratio / 2, 1 - ratio * C)  # sin a = 2 sin(a/2) cos(a/2)


def linear_part(t: Vector, w: Vector) -> list[Number]:
    """The v whose twist (v, w) carries a base by a translation t, 3 numbers [m].

    V^-1 t = t - w x t / 2 + (1 - (a / 2) cot(a / 2)) e x (e x t), for a < 2 pi.

    Parameters
    ----------
    t, w : sequence of 3 floats
        Translation [m] and rotation vector [rad].
    """
    a, C, ratio = half_turn(w)
    return combined(t, w, a, -0.5, 1 - C / ratio)


def dot(w: Vector, v: Vector) -> Number:
    """The product w'v of three numbers each [any unit]; ``sum`` rounds as its Python does."""
    p, q, r = w
    x, y, z = v
    return p * x + q * y + r * z


def length(w: Vector) -> Number:
    """Length of a vector of three numbers [its unit]; 0 where its square is."""
    p, q, r = w
    return root(p * p + q * q + r * r)


def combined(v: Vector, w: Vector, a: Number, c1: Number, c2: Number) -> list[Number]:
    """V + c1 w x v + c2 e x (e x v), where w = a e [rad], and e x (e x v) = (e . v) e - v."""
    x, y, z = v
    p, q, r = w
    rest = 1 - c2
    square = a * a
    along = chosen(square == 0, 0.0, c2 * dot(w, v) / chosen(square == 0, 1.0, square))
    return [
        rest * x + c1 * (q * z - r * y) + along * p,
        rest * y + c1 * (r * x - p * z) + along * q,
        rest * z + c1 * (p * y - q * x) + along * r,
    ]


def carried(position: Vector, R: list[list[Number]], t: Vector) -> list[Number]:
    """The position of a base, 3 floats, moved by a translation t along its own axes R [m]."""
    x, y, z = t
    moves = zip(position, R, strict=True)
    return [start + (p * x + q * y + r * z) for start, (p, q, r) in moves]


def turned(q_joint: Vector, w: Vector, half: HalfTurn) -> list[Number]:
    """A quaternion times that of a rotation vector, scaled to length one."""
    _, C, ratio = half
    p, q, r = w
    scale = ratio / 2
    p *= scale
    q *= scale
    r *= scale
    stays = (p == 0) & (q == 0) & (r == 0)
    x, y, z, s = q_joint
    a = s * p + x * C + y * r - z * q
    b = s * q + y * C + z * p - x * r
    c = s * r + z * C + x * q - y * p
    d = s * C - x * p - y * q - z * r
    shorter = (3 - (a * a + b * b + c * c + d * d)) / 2  # of 1 / sqrt, next to 1
    after = zip((a, b, c, d), q_joint, strict=True)
    return [chosen(stays, before, shorter * new) for new, before in after]


def between(q_joint: Vector, q_joint_next: Vector) -> list[Number]:
    """The quaternion by which another follows from one: its inverse times the other."""
    x, y, z, s = q_joint
    p, q, r, k = q_joint_next
    return [
        s * p - x * k - y * r + z * q,
        s * q - y * k - z * p + x * r,
        s * r - z * k - x * q + y * p,
        s * k + x * p + y * q + z * r,
    ]


def rotation_between(q_joint: Vector, q_joint_next: Vector) -> tuple[list[Number], Number, Number]:
    """The rotation vector w between two quaternions, a = |w| <= pi [rad], 1 - (a/2) cot(a/2)."""
    *v, w = between(q_joint, q_joint_next)
    S = length(v)
    C = abs(w)
    b = angle_of(S, C)
    ratio = chosen(S == 0, 1.0, b / chosen(S == 0, 1.0, S))
    scale = chosen(w >= 0, 2 * ratio, -2 * ratio)
    return [scale * part for part in v], 2 * b, chosen(S == 0, 0.0, 1 - ratio * C)


def heading(q_joint: Vector, angle: Number) -> list[Number]:
    """The pair (cos, sin) of a heading turned by an angle, scaled to length one."""
    c, s = q_joint
    C, S = cos_sin(angle / 2)
    cosine = 1 - 2 * (S * S)
    sine = 2 * (S * C)
    x = c * cosine - s * sine
    y = s * cosine + c * sine
    shorter = (3 - (x * x + y * y)) / 2
    return [chosen(angle == 0, c, shorter * x), chosen(angle == 0, s, shorter * y)]


def rows(quaternion: Vector) -> list[list[Number]]:
    """Rows of the rotation matrix of a quaternion [x y z w] of length one."""
    x, y, z, w = quaternion
    return [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]


def along(R: list[list[Number]], v: Vector) -> list[Number]:
    """R'v of the rows of R: a vector of the world along a link's own axes [its unit]."""
    x, y, z = v
    return [p * x + q * y + r * z for p, q, r in zip(*R, strict=True)]


def turn_between(before: Vector, after: Vector) -> Number:
    """Angle from one (cos, sin) to another [rad]."""
    c, s = before
    c_next, s_next = after
    return angle_of(c * s_next - s * c_next, c * c_next + s * s_next)
