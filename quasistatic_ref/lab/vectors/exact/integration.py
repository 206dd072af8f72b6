"""The configuration q (+) delta_q of a mechanism, in exact numbers."""

from __future__ import annotations

from collections.abc import Sequence

from flint import fmpq

from quasistatic_ref.lab.vectors.exact.algebra import Vector, add, along, moved, unit
from quasistatic_ref.lab.vectors.exact.mechanism import Mechanism, check_length
from quasistatic_ref.lab.vectors.exact.precision import numbers
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
