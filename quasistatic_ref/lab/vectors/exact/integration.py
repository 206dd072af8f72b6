"""The configuration q (+) delta_q of a mechanism, and the change q_next (-) q, in exact numbers."""

from collections.abc import Sequence

from flint import arb, fmpq

from quasistatic_ref.lab.vectors.exact.algebra import (
    Vector,
    add,
    along,
    cross,
    dot,
    moved,
    scaled,
    squared,
    subtract,
    times,
    transposed,
    unit,
)
from quasistatic_ref.lab.vectors.exact.mechanism import Mechanism, check_length
from quasistatic_ref.lab.vectors.exact.precision import Real, ball, numbers, root, sign
from quasistatic_ref.lab.vectors.exact.rotation import (
    cos_sin,
    exp3,
    exp6,
    quaternion_product,
    rotation,
)


def integrated(mechanism: Mechanism, q: Sequence[float], delta_q: Sequence[float]) -> Vector:
    """Configuration q (+) delta_q, quaternions and (cos, sin) of length one.

    Raises
    ------
    InputError
        If q or delta_q has another length.
    """
    check_length("q", q, mechanism.n_q)
    check_length("delta_q", delta_q, mechanism.n_v)
    after: Vector = [fmpq(0)] * mechanism.n_q
    for body in mechanism.bodies:
        if body.mimic is not None:
            continue
        after[body.q] = _stepped(body.kind, numbers(q[body.q]), numbers(delta_q[body.v]))
    return after


def _stepped(kind: str, q: Vector, step: Vector) -> Vector:
    match kind:
        case "revolute" | "prismatic":
            return add(q, step)
        case "continuous":
            return _turned(unit(q), list(cos_sin(step[0])))
        case "floating":
            t, turn = exp6(step[:3], step[3:])
            return [*moved(rotation(q[3:]), q[:3], t), *quaternion_product(unit(q[3:]), turn)]
        case "planar":
            t, turn = exp3(step[:2], step[2])
            (c, s), (x, y) = unit(q[2:]), t
            return [*along(along(q[:2], [c, s], x), [-s, c], y), *_turned([c, s], turn)]
        case _:
            return []


def _turned(a: Vector, b: Vector) -> Vector:
    return [a[0] * b[0] - a[1] * b[1], a[1] * b[0] + a[0] * b[1]]


def difference(
    mechanism: Mechanism, q: Sequence[float], q_next: Sequence[float], *, actuated: bool
) -> Vector:
    """Entries of delta_q of the actuated, or of the other, joints: q_next = q (+) delta_q.

    Parameters
    ----------
    mechanism : Mechanism
    q, q_next : sequence of float
        Configurations of those joints, in the paper's order.
    actuated : bool
    """
    own = [body for body in mechanism.bodies if body.kind != "fixed" and body.mimic is None]
    first = 0 if actuated else sum(b.q.stop - b.q.start for b in own if b.actuated)
    change: Vector = []
    for body in own:
        if body.actuated == actuated:
            part = slice(body.q.start - first, body.q.stop - first)
            change += _change(body.kind, numbers(q[part]), numbers(q_next[part]))
    return change


def _change(kind: str, q: Vector, q_next: Vector) -> Vector:
    match kind:
        case "continuous":
            return [_turn(q, q_next)]
        case "planar":
            (x, y), (c, s) = subtract(q_next[:2], q[:2]), unit(q[2:])
            angle = _turn(q[2:], q_next[2:])
            return [*_log3([c * x + s * y, c * y - s * x], angle), angle]
        case "floating":
            away = times(transposed(rotation(q[3:])), subtract(q_next[:3], q[:3]))
            back = [*scaled(q[3:6], -1), q[6]]
            return _log6(away, unit(quaternion_product(back, q_next[3:])))
        case _:
            return subtract(q_next, q)


def _turn(a: Vector, b: Vector) -> Real:
    """Angle from one (cos, sin), of any length, to another."""
    sine, cosine = a[0] * b[1] - a[1] * b[0], dot(a, b)
    if sign(sine) == 0 and sign(cosine) > 0:
        return fmpq(0)
    return arb.atan2(ball(sine), ball(cosine))


def _log3(t: Vector, angle: Real) -> Vector:
    """Linear part of the twist in the plane whose motion is the translation t and the angle."""
    if sign(angle) == 0:
        return t
    forward, sideways = ball(angle).sinc(), angle * ball(angle / 2).sinc() ** 2 / 2
    size, (x, y) = forward * forward + sideways * sideways, t
    return [(forward * x + sideways * y) / size, (forward * y - sideways * x) / size]


def _log6(t: Vector, turn: Vector) -> Vector:
    """Twist of the screw whose motion is the translation t and a unit quaternion."""
    sine_square = squared(turn[:3])
    if sign(sine_square) == 0:
        return [*t, fmpq(0), fmpq(0), fmpq(0)]
    if sign(turn[3]) < 0:
        turn = scaled(turn, -1)
    sine = root(sine_square)
    half = arb.atan2(ball(sine), ball(turn[3]))
    w = scaled(turn[:3], 2 * half / sine)
    once = cross(w, t)
    twice = cross(w, once)
    factor = (1 - half * turn[3] / sine) / squared(w)
    linear = [a - b / 2 + factor * c for a, b, c in zip(t, once, twice, strict=True)]
    return [*linear, *w]
